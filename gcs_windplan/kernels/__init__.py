"""Numba on arrays: the wind triangle, clearance of legs, best-first search, interpolation."""

"""The flight of a route: the wind along its legs, times, energy, and how an autopilot flies it.

The names are fetched when they are first asked for, so that only those who need numba import it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

"""Places on the ellipsoid and the flat local frame."""

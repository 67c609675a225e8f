"""The ground: height grids and meshes, and the obstacles that stand on it.

The names are fetched when they are first asked for, so that only those who need rasterio, trimesh or numba
import them.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

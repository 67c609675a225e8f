"""The paper: its tables and figures, flown again; its wind fields and its collision test.

The names are fetched when they are first asked for, so that only the reproduction imports matplotlib.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

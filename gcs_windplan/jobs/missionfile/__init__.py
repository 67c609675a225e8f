"""The mission file: what may stand in it, and the request that it makes.

The names are fetched when they are first asked for: a file's errors must not wait for what builds the request.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

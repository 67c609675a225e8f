"""Drone missions that know the wind and the ground: plan, push, review.

The names are fetched when they are first asked for: the command's help must not wait for compilers and file readers.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

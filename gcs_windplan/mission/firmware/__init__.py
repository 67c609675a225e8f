"""Firmwares: one file each holds what it takes, stores, rounds, changes, refuses and ignores, and its defaults.

The names are fetched when they are first asked for: what only lists the firmwares must not wait for their facts.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

"""Missions: items, commands and frames, fences and rally points, and how a planned route becomes a mission.

The names are fetched when they are first asked for: what only lists the firmwares must not wait for the rest.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

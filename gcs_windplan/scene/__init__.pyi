from .airspace import Airspace as Airspace
from .airspace import Prism as Prism
from .clearance import BREACHES as BREACHES
from .clearance import Clearance as Clearance
from .clearance import CollisionTest as CollisionTest
from .scene import Scene as Scene

from .flight import Flight as Flight
from .flight import Leg as Leg
from .flight import Totals as Totals
from .flight import Waypoint as Waypoint
from .flight import clock as clock
from .flight import fly as fly
from .flight import fly_legs as fly_legs

"""The vehicle: airspeed, climb and descent, speed model; and the airframe that carries it: mass, battery, power."""

from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY, air_density
from gcs_windplan.vehicle.airframe import Airframe, Battery
from gcs_windplan.vehicle.power import PowerModel, best_range_airspeed, energy_per_metre, least_power_airspeed
from gcs_windplan.vehicle.power_rotors import Multirotor, RotaryWing
from gcs_windplan.vehicle.power_table import PowerTable
from gcs_windplan.vehicle.power_wings import FixedWing
from gcs_windplan.vehicle.vehicle import Autopilot, SpeedModel, Vehicle, VehicleType

__all__ = [
    "SEA_LEVEL_DENSITY",
    "Airframe",
    "Autopilot",
    "Battery",
    "FixedWing",
    "Multirotor",
    "PowerModel",
    "PowerTable",
    "RotaryWing",
    "SpeedModel",
    "Vehicle",
    "VehicleType",
    "air_density",
    "best_range_airspeed",
    "energy_per_metre",
    "least_power_airspeed",
]

"""The vehicle: airspeed, climb and descent, speed model; the airframe that carries it; its pace under an autopilot."""

from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY, air_density
from gcs_windplan.vehicle.airframe import Airframe, Battery
from gcs_windplan.vehicle.pace import (
    LegTimes,
    MotionProfile,
    as_flown,
    landing_seconds,
    return_seconds,
    takeoff_seconds,
)
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
    "LegTimes",
    "MotionProfile",
    "Multirotor",
    "PowerModel",
    "PowerTable",
    "RotaryWing",
    "SpeedModel",
    "Vehicle",
    "VehicleType",
    "air_density",
    "as_flown",
    "best_range_airspeed",
    "energy_per_metre",
    "landing_seconds",
    "least_power_airspeed",
    "return_seconds",
    "takeoff_seconds",
]

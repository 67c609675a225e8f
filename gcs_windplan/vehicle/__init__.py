"""The vehicle: airspeed, climb and descent, speed model."""

from gcs_windplan.vehicle.vehicle import Autopilot, SpeedModel, Vehicle, VehicleType

__all__ = ["Autopilot", "SpeedModel", "Vehicle", "VehicleType"]

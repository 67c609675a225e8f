"""How fast the stand-in flies, by default as the autopilot's own default parameters have it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from gcs_windplan.vehicle import Autopilot, Vehicle


@dataclass(frozen=True, slots=True)
class Airframe:
    """Speeds [m/s], accelerations [m/s²], heights above home [m] and times [s] of a multicopter.

    `airspeed` is the most that it flies through the air. `cruise` is the ground speed of a leg for which none was
    commanded. `radius` [m] is how far from a waypoint it may cut a corner, as far as its pace goes: it passes
    over every waypoint. `landing` is the speed below `landing_height`; it hovers `return_hover` over home
    before it goes down.
    """

    airspeed: float
    cruise: float
    climb: float
    descent: float
    acceleration: float
    vertical_acceleration: float
    radius: float
    landing: float
    landing_height: float
    return_height: float
    return_hover: float
    spool_up: float
    takeoff_ramp: float
    touch_down: float


#: ArduCopter 4.7: WPNAV_SPEED, _UP, _DN, _ACCEL, _ACCEL_Z, _RADIUS, LAND_SPEED, LAND_ALT_LOW, RTL_ALT. Airspeed:
#: what its simulated airframe reaches at 45° of lean; times measured on it (arming to lift-off, take-off's ramp,
#: hover over home with RTL_LOIT_TIME 5 s, touch-down to disarmed).
ARDUCOPTER = Airframe(
    airspeed=15.0,
    cruise=10.0,
    climb=2.5,
    descent=1.5,
    acceleration=2.5,
    vertical_acceleration=1.0,
    radius=2.0,
    landing=0.5,
    landing_height=10.0,
    return_height=15.0,
    return_hover=6.2,
    spool_up=4.4,
    takeoff_ramp=2.2,
    touch_down=1.95,
)

#: PX4's parameter reference: MPC_XY_CRUISE, MPC_Z_V_AUTO_UP and _DN, MPC_ACC_HOR, MPC_ACC_UP_MAX, NAV_ACC_RAD,
#: MPC_LAND_SPEED, MPC_LAND_ALT2, RTL_RETURN_ALT, COM_SPOOLUP_TIME, COM_DISARM_LAND.
PX4_MULTICOPTER = Airframe(
    airspeed=15.0,
    cruise=5.0,
    climb=3.0,
    descent=1.5,
    acceleration=3.0,
    vertical_acceleration=4.0,
    radius=2.0,
    landing=0.7,
    landing_height=5.0,
    return_height=60.0,
    return_hover=0.0,
    spool_up=1.0,
    takeoff_ramp=1.0,
    touch_down=2.0,
)


def airframe_of(autopilot: Autopilot, vehicle: Vehicle | None = None) -> Airframe:
    """The autopilot's default airframe, with a planned vehicle's airspeed, climb and descent."""
    default = ARDUCOPTER if autopilot == "ardupilot" else PX4_MULTICOPTER
    if vehicle is None:
        return default
    return replace(default, airspeed=vehicle.airspeed, climb=vehicle.climb, descent=vehicle.descent)

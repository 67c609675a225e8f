"""What the stand-in tells of itself: its state as MAVLink's telemetry messages."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.mission import degrees_e7
from gcs_windplan.standin.snapshot import ENDURANCE, Snapshot

_CELLS, _FULL, _EMPTY = 4, 4.2, 3.5  # [V]
_CAPACITY = 5000.0  # [mAh]
_SENSORS = (
    mavlink.MAV_SYS_STATUS_SENSOR_3D_GYRO
    | mavlink.MAV_SYS_STATUS_SENSOR_3D_ACCEL
    | mavlink.MAV_SYS_STATUS_SENSOR_3D_MAG
    | mavlink.MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
    | mavlink.MAV_SYS_STATUS_SENSOR_GPS
    | mavlink.MAV_SYS_STATUS_AHRS
    | mavlink.MAV_SYS_STATUS_SENSOR_BATTERY
    | mavlink.MAV_SYS_STATUS_PREARM_CHECK
)
_ESTIMATE_IS_GOOD = 831  # EKF_STATUS_REPORT: attitude, velocities, absolute positions


def heartbeat(s: Snapshot) -> Message:
    """HEARTBEAT."""
    armed = mavlink.MAV_MODE_FLAG_SAFETY_ARMED if s.armed else 0
    state = mavlink.MAV_STATE_STANDBY if s.landed else mavlink.MAV_STATE_ACTIVE
    return mavlink.MAVLink_heartbeat_message(
        mavlink.MAV_TYPE_QUADROTOR, s.kind, s.mode.flags | armed, s.mode.number,
        mavlink.MAV_STATE_BOOT if s.booting else state, 3,
    )  # fmt: skip


def _bounded(number: float, bits: int) -> int:
    """The nearest whole number that a signed field of so many bits takes."""
    most = (1 << bits - 1) - 1
    return max(-most, min(most, round(number)))


def attitude(s: Snapshot) -> Message:
    """ATTITUDE."""
    yaw = math.remainder(s.heading, 2 * math.pi)
    return mavlink.MAVLink_attitude_message(s.boot_ms, 0.0, s.pitch, yaw, 0.0, 0.0, 0.0)


def global_position(s: Snapshot) -> Message:
    """GLOBAL_POSITION_INT: velocities along north, east and down."""
    east, north, up = (_bounded(100 * v, 16) for v in s.velocity)
    return mavlink.MAVLink_global_position_int_message(
        s.boot_ms, degrees_e7(s.point.latitude_deg), degrees_e7(s.point.longitude_deg), _bounded(1000 * s.altitude, 32),
        _bounded(1000 * (s.altitude - s.home.altitude), 32), north, east, -up, round(100 * s.heading_deg) % 36000,
    )  # fmt: skip


def local_position(s: Snapshot) -> Message:
    """LOCAL_POSITION_NED, from home."""
    (east, north, up), (v_east, v_north, v_up) = s.local, s.velocity
    return mavlink.MAVLink_local_position_ned_message(s.boot_ms, north, east, -up, v_north, v_east, -v_up)


def vfr_hud(s: Snapshot) -> Message:
    """VFR_HUD."""
    throttle = 0 if s.landed else 50
    return mavlink.MAVLink_vfr_hud_message(
        0.0 if s.landed else s.airspeed, s.ground_speed, round(s.heading_deg) % 360, throttle, s.altitude, s.velocity[2]
    )


def gps_raw(s: Snapshot) -> Message:
    """GPS_RAW_INT: a good 3D fix."""
    track = math.degrees(math.atan2(s.velocity[0], s.velocity[1])) % 360
    speed = min(65535, round(100 * s.ground_speed))
    return mavlink.MAVLink_gps_raw_int_message(
        int(s.boot * 1e6), mavlink.GPS_FIX_TYPE_3D_FIX, degrees_e7(s.point.latitude_deg),
        degrees_e7(s.point.longitude_deg), _bounded(1000 * s.altitude, 32), 80, 120, speed,
        round(100 * track) % 36000, 14,
    )  # fmt: skip


def _voltage(s: Snapshot) -> float:
    return _CELLS * (_EMPTY + s.charge * (_FULL - _EMPTY))


def _current(s: Snapshot) -> float:
    return _CAPACITY / 1000 * 3600 / ENDURANCE if s.armed else 0.2


def system_status(s: Snapshot) -> Message:
    """SYS_STATUS with the linear battery."""
    healthy = _SENSORS | mavlink.MAV_SYS_STATUS_GEOFENCE
    volts, amperes, percent = round(1000 * _voltage(s)), round(100 * _current(s)), round(100 * s.charge)
    return mavlink.MAVLink_sys_status_message(
        _SENSORS, _SENSORS, healthy, 200, volts, amperes, percent, 0, 0, 0, 0, 0, 0
    )


def battery(s: Snapshot) -> Message:
    """BATTERY_STATUS with the linear battery."""
    cells = [round(1000 * _voltage(s) / _CELLS)] * _CELLS + [65535] * (10 - _CELLS)
    return mavlink.MAVLink_battery_status_message(
        0, mavlink.MAV_BATTERY_FUNCTION_ALL, mavlink.MAV_BATTERY_TYPE_LIPO, 32767, cells, round(100 * _current(s)),
        round(_CAPACITY * (1 - s.charge)), -1, round(100 * s.charge), round(ENDURANCE * s.charge),
        mavlink.MAV_BATTERY_CHARGE_STATE_OK,
    )  # fmt: skip


def mission_current(s: Snapshot) -> Message:
    """MISSION_CURRENT; ArduPilot does not count home in the total."""
    count = s.items - 1 if s.kind == mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA else s.items
    total = max(count, 0) if s.items else 65535
    mode = 1 if s.mission_state == mavlink.MISSION_STATE_ACTIVE else 2
    return mavlink.MAVLink_mission_current_message(s.seq, total, s.mission_state, mode)


def extended_state(s: Snapshot) -> Message:
    """EXTENDED_SYS_STATE."""
    landed = mavlink.MAV_LANDED_STATE_ON_GROUND if s.landed else mavlink.MAV_LANDED_STATE_IN_AIR
    return mavlink.MAVLink_extended_sys_state_message(mavlink.MAV_VTOL_STATE_UNDEFINED, landed)


def system_time(s: Snapshot) -> Message:
    """SYSTEM_TIME."""
    return mavlink.MAVLink_system_time_message(int(s.unix * 1e6), s.boot_ms)


def home_position(s: Snapshot) -> Message:
    """HOME_POSITION."""
    point = s.home.point
    return mavlink.MAVLink_home_position_message(
        degrees_e7(point.latitude_deg), degrees_e7(point.longitude_deg), _bounded(1000 * s.home.altitude, 32),
        0.0, 0.0, 0.0, [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0, int(s.boot * 1e6),
    )  # fmt: skip


def global_origin(s: Snapshot) -> Message:
    """GPS_GLOBAL_ORIGIN: that of LOCAL_POSITION_NED."""
    point = s.home.point
    return mavlink.MAVLink_gps_global_origin_message(
        degrees_e7(point.latitude_deg), degrees_e7(point.longitude_deg), _bounded(1000 * s.home.altitude, 32)
    )


def navigation(s: Snapshot) -> Message:
    """NAV_CONTROLLER_OUTPUT: bearing and distance to the end of the present leg."""
    bearing, distance = s.target if s.target is not None else (s.heading, 0.0)
    degrees = round(math.degrees(bearing) % 360)
    return mavlink.MAVLink_nav_controller_output_message(
        0.0, math.degrees(s.pitch), degrees, degrees, min(65535, round(distance)), 0.0, 0.0, 0.0
    )


def wind(s: Snapshot) -> Message:
    """ArduPilot's WIND: the direction that it comes from."""
    from_deg = math.degrees(math.atan2(-s.wind[0], -s.wind[1]))
    return mavlink.MAVLink_wind_message(from_deg, math.hypot(*s.wind), 0.0)


def wind_cov(s: Snapshot) -> Message:
    """PX4's WIND_COV: north and east towards where it blows."""
    east, north = s.wind
    return mavlink.MAVLink_wind_cov_message(int(s.boot * 1e6), north, east, 0.0, 0.1, 0.1, s.altitude, 0.5, 0.5)


def estimator(s: Snapshot) -> Message:
    """EKF_STATUS_REPORT: all is well."""
    return mavlink.MAVLink_ekf_status_report_message(_ESTIMATE_IS_GOOD, 0.01, 0.01, 0.01, 0.01, 0.0)


Encoder: TypeAlias = Callable[[Snapshot], Message]

#: How each message is made, by its number.
ENCODERS: dict[int, Encoder] = {
    mavlink.MAVLINK_MSG_ID_HEARTBEAT: heartbeat,
    mavlink.MAVLINK_MSG_ID_ATTITUDE: attitude,
    mavlink.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: global_position,
    mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED: local_position,
    mavlink.MAVLINK_MSG_ID_VFR_HUD: vfr_hud,
    mavlink.MAVLINK_MSG_ID_GPS_RAW_INT: gps_raw,
    mavlink.MAVLINK_MSG_ID_SYS_STATUS: system_status,
    mavlink.MAVLINK_MSG_ID_BATTERY_STATUS: battery,
    mavlink.MAVLINK_MSG_ID_MISSION_CURRENT: mission_current,
    mavlink.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: extended_state,
    mavlink.MAVLINK_MSG_ID_SYSTEM_TIME: system_time,
    mavlink.MAVLINK_MSG_ID_HOME_POSITION: home_position,
    mavlink.MAVLINK_MSG_ID_GPS_GLOBAL_ORIGIN: global_origin,
    mavlink.MAVLINK_MSG_ID_NAV_CONTROLLER_OUTPUT: navigation,
    mavlink.MAVLINK_MSG_ID_WIND: wind,
    mavlink.MAVLINK_MSG_ID_WIND_COV: wind_cov,
    mavlink.MAVLINK_MSG_ID_EKF_STATUS_REPORT: estimator,
}

"""Commands (COMMAND_LONG and COMMAND_INT) and what comes of them.

What a ground station asks when it connects is answered; what the stand-in cannot do is refused as unsupported.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.codec import Message
from gcs_windplan.mission import Frame, Home, plain_frame
from gcs_windplan.standin.modes import MODES, mode_numbered

if TYPE_CHECKING:
    from gcs_windplan.standin.vehicle import StandIn

ACCEPTED, DENIED = mavlink.MAV_RESULT_ACCEPTED, mavlink.MAV_RESULT_DENIED
UNSUPPORTED, FAILED = mavlink.MAV_RESULT_UNSUPPORTED, mavlink.MAV_RESULT_FAILED
_PX4_TAKEOFF = 2.5  # [m] MIS_TAKEOFF_ALT
_NO_PLACE = "that is no place on Earth, or too far away"
_FORCE = 21196  # MAV_CMD_COMPONENT_ARM_DISARM's second parameter, to disarm in flight


@dataclass(frozen=True, slots=True)
class Wish:
    """A command: its parameters 1 to 4, latitude and longitude [deg], and z [m] in a frame."""

    command: int
    params: tuple[float, float, float, float]
    latitude_deg: float
    longitude_deg: float
    z: float
    frame: int


@dataclass(frozen=True, slots=True)
class Outcome:
    """MAV_RESULT, why, and messages to send besides the COMMAND_ACK."""

    result: int
    reason: str = ""
    messages: tuple[Message, ...] = ()


_Answer: TypeAlias = Callable[["StandIn", Wish, float], Outcome]


def read_wish(message: Message) -> Wish:
    """The command of a COMMAND_LONG, or of a COMMAND_INT with its scaled place."""
    params = (message.param1, message.param2, message.param3, message.param4)
    if message.get_type() == "COMMAND_INT":
        return Wish(message.command, params, message.x / 1e7, message.y / 1e7, message.z, message.frame)
    return Wish(message.command, params, message.param5, message.param6, message.param7, Frame.GLOBAL)


def carry_out(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    """Do what a command wants, as far as the stand-in can."""
    answer = _ANSWERS.get(wish.command)
    return Outcome(UNSUPPORTED) if answer is None else answer(vehicle, wish, now)


def _whole(number: float) -> int:
    """A parameter that counts something; -1 for NaN and infinity."""
    return int(number) if math.isfinite(number) else -1


def _granted(fault: str | None) -> Outcome:
    return Outcome(ACCEPTED) if fault is None else Outcome(FAILED, fault)


def _arm(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    if wish.params[0] == 1:
        return _granted(vehicle.arm())
    return _granted(vehicle.flight.disarm(force=wish.params[1] == _FORCE))


def _set_mode(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    _, main, sub, _ = wish.params
    main, sub = max(_whole(main), 0), max(_whole(sub), 0)
    number = main if vehicle.autopilot == "ardupilot" else main << 16 | sub << 24
    mode = mode_numbered(vehicle.autopilot, number)
    return Outcome(DENIED, f"there is no mode {number}") if mode is None else _granted(vehicle.set_mode(mode))


def _start_mission(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    fault = vehicle.do("mission")
    if fault is None and vehicle.autopilot == "px4":
        fault = vehicle.arm()  # ArduCopter begins when it is armed
    return _granted(fault)


def _take_off(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    """ArduCopter's altitude is above home and wants GUIDED, PX4's above sea level, NaN for its default height."""
    home = vehicle.flight.craft.home.altitude
    if vehicle.autopilot == "ardupilot":
        if vehicle.flight.doing != "guided":
            return Outcome(FAILED, "it is not in GUIDED")
        return _granted(vehicle.flight.take_off(home + wish.z if wish.z > 0 else home))
    fault = vehicle.flight.take_off(max(home, wish.z) if math.isfinite(wish.z) else home + _PX4_TAKEOFF)
    if fault is None:
        vehicle.mode = next(mode for mode in MODES["px4"] if mode.name == "Takeoff")
    return _granted(fault)


def _return_home(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return _granted(vehicle.do("return"))


def _land(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return _granted(vehicle.do("land"))


def _stay(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return _granted(vehicle.do("hold"))


def _pause_or_go_on(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return _granted(vehicle.do("hold" if wish.params[0] == 0 else "mission"))


def _reposition(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    """Go to a place; NaN, and 0, 0, mean the present one."""
    craft = vehicle.flight.craft
    east, north, altitude = craft.body.place
    blank = not (math.isfinite(wish.latitude_deg) and math.isfinite(wish.longitude_deg))
    if not blank and not wish.latitude_deg == wish.longitude_deg == 0:
        if not _on_earth(wish):
            return Outcome(DENIED, _NO_PLACE)
        east, north, _ = craft.local(wish.latitude_deg, wish.longitude_deg, 0.0)
    base = craft.home.altitude if plain_frame(wish.frame) == Frame.GLOBAL_RELATIVE_ALT else 0.0
    if math.isfinite(wish.z):
        altitude = base + wish.z
    if craft.landed:
        return Outcome(FAILED, "it stands on the ground")
    vehicle.do("guided")
    return _granted(vehicle.flight.go_to((east, north, altitude)))


def _set_home(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    craft = vehicle.flight.craft
    if wish.params[0] == 1:
        craft.home = Home(craft.point, craft.body.altitude)
    elif _on_earth(wish) and math.isfinite(wish.z) and craft.reaches(wish.latitude_deg, wish.longitude_deg):
        craft.home = Home(GeoPoint(wish.latitude_deg, wish.longitude_deg), wish.z)
    else:
        return Outcome(DENIED, _NO_PLACE)
    return Outcome(ACCEPTED, messages=vehicle.tell(mavlink.MAVLINK_MSG_ID_HOME_POSITION, now))


def _on_earth(wish: Wish) -> bool:
    return abs(wish.latitude_deg) <= 90 and abs(wish.longitude_deg) <= 180


def _change_speed(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    changed = vehicle.flight.change_speed(wish.params[0], wish.params[1])
    return Outcome(ACCEPTED) if changed else Outcome(DENIED, "no positive speed")


def _set_current(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    if wish.params[1] == 1:  # from the beginning, jumps and all
        vehicle.flight.run.forget()
    seq = _whole(wish.params[0])
    if seq != -1 and not vehicle.flight.jump(seq):
        return Outcome(DENIED, f"there is no item {seq}")
    return Outcome(ACCEPTED, messages=vehicle.tell(mavlink.MAVLINK_MSG_ID_MISSION_CURRENT, now))


def _set_interval(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    known = vehicle.streams.set_interval(_whole(wish.params[0]), wish.params[1], now)
    return Outcome(ACCEPTED) if known else Outcome(DENIED, f"message {wish.params[0]:.0f} is not sent")


def _get_interval(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    kind = _whole(wish.params[0])
    if not 0 <= kind <= 65535:
        return Outcome(DENIED, "there is no such message")
    interval = vehicle.streams.interval(kind)
    told = 0 if interval is None else -1 if math.isinf(interval) else round(interval * 1e6)
    return Outcome(ACCEPTED, messages=(mavlink.MAVLink_message_interval_message(kind, told),))


def _request_message(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    kind = _whole(wish.params[0])
    if kind == mavlink.MAVLINK_MSG_ID_MESSAGE_INTERVAL:
        asked = Wish(wish.command, (wish.params[1], 0.0, 0.0, 0.0), 0.0, 0.0, 0.0, 0)
        return _get_interval(vehicle, asked, now)
    messages = vehicle.tell(kind, now)
    return Outcome(ACCEPTED, messages=messages) if messages else Outcome(UNSUPPORTED, f"message {kind} is not known")


def _version(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return Outcome(ACCEPTED, messages=vehicle.tell(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION, now))


def _home(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return Outcome(ACCEPTED, messages=vehicle.tell(mavlink.MAVLINK_MSG_ID_HOME_POSITION, now))


def _banner(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    return Outcome(ACCEPTED, messages=vehicle.banner())


def _reboot(vehicle: StandIn, wish: Wish, now: float) -> Outcome:
    if wish.params[0] != 1:
        return Outcome(UNSUPPORTED)
    if vehicle.flight.craft.armed:
        return Outcome(FAILED, "it is armed")
    vehicle.reboot(now)
    return Outcome(ACCEPTED)


_ANSWERS: dict[int, _Answer] = {
    mavlink.MAV_CMD_COMPONENT_ARM_DISARM: _arm,
    mavlink.MAV_CMD_DO_SET_MODE: _set_mode,
    mavlink.MAV_CMD_MISSION_START: _start_mission,
    mavlink.MAV_CMD_NAV_TAKEOFF: _take_off,
    mavlink.MAV_CMD_NAV_RETURN_TO_LAUNCH: _return_home,
    mavlink.MAV_CMD_NAV_LAND: _land,
    mavlink.MAV_CMD_NAV_LOITER_UNLIM: _stay,
    mavlink.MAV_CMD_DO_PAUSE_CONTINUE: _pause_or_go_on,
    mavlink.MAV_CMD_DO_REPOSITION: _reposition,
    mavlink.MAV_CMD_DO_SET_HOME: _set_home,
    mavlink.MAV_CMD_DO_CHANGE_SPEED: _change_speed,
    mavlink.MAV_CMD_DO_SET_MISSION_CURRENT: _set_current,
    mavlink.MAV_CMD_SET_MESSAGE_INTERVAL: _set_interval,
    mavlink.MAV_CMD_GET_MESSAGE_INTERVAL: _get_interval,
    mavlink.MAV_CMD_REQUEST_MESSAGE: _request_message,
    mavlink.MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES: _version,
    mavlink.MAV_CMD_GET_HOME_POSITION: _home,
    mavlink.MAV_CMD_DO_SEND_BANNER: _banner,
    mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN: _reboot,
}

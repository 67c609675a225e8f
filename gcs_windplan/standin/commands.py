"""Commands (COMMAND_LONG and COMMAND_INT) and what comes of them.

What a ground station asks when it connects is answered; what the stand-in cannot do is refused as unsupported.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.link.codec import Message
from gcs_windplan.mission import Frame, Home, plain_frame
from gcs_windplan.standin.vehicle import SimulatedVehicle

ACCEPTED, DENIED = mavlink.MAV_RESULT_ACCEPTED, mavlink.MAV_RESULT_DENIED
UNSUPPORTED, FAILED = mavlink.MAV_RESULT_UNSUPPORTED, mavlink.MAV_RESULT_FAILED
_NO_PLACE = "that is no place on Earth, or too far away"
_FORCE = 21196  # MAV_CMD_COMPONENT_ARM_DISARM's second parameter, to disarm in flight


@dataclass(frozen=True, slots=True)
class CommandRequest:
    """A command: its parameters 1 to 4, latitude and longitude [deg], and z [m] in a frame."""

    command: int
    params: tuple[float, float, float, float]
    latitude_deg: float
    longitude_deg: float
    z: float
    frame: int


@dataclass(frozen=True, slots=True)
class CommandResult:
    """MAV_RESULT, why, and messages to send besides the COMMAND_ACK."""

    result: int
    reason: str = ""
    messages: tuple[Message, ...] = ()


_Answer: TypeAlias = Callable[[SimulatedVehicle, CommandRequest, float], CommandResult]


def read_request(message: Message) -> CommandRequest:
    """The command of a COMMAND_LONG, or of a COMMAND_INT with its scaled place."""
    params = (message.param1, message.param2, message.param3, message.param4)
    if message.get_type() == "COMMAND_INT":
        return CommandRequest(message.command, params, message.x / 1e7, message.y / 1e7, message.z, message.frame)
    return CommandRequest(message.command, params, message.param5, message.param6, message.param7, Frame.GLOBAL)


def execute(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    """Do what a command wants, as far as the stand-in can."""
    answer = _ANSWERS.get(request.command)
    return CommandResult(UNSUPPORTED) if answer is None else answer(vehicle, request, now)


def _whole(number: float) -> int:
    """A parameter that counts something; -1 for NaN and infinity."""
    return int(number) if math.isfinite(number) else -1


def _granted(fault: str | None) -> CommandResult:
    return CommandResult(ACCEPTED) if fault is None else CommandResult(FAILED, fault)


def _arm(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    if request.params[0] == 1:
        return _granted(vehicle.arm())
    return _granted(vehicle.flight.disarm(force=request.params[1] == _FORCE))


def _set_mode(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    _, main, sub, _ = request.params
    main, sub = max(_whole(main), 0), max(_whole(sub), 0)
    number = main << 16 | sub << 24 if vehicle.firmware.mode_parts else main
    mode = vehicle.firmware.mode_numbered(number)
    return CommandResult(DENIED, f"there is no mode {number}") if mode is None else _granted(vehicle.set_mode(mode))


def _start_mission(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    fault = vehicle.do("mission")
    if fault is None and vehicle.firmware.starts_armed:
        fault = vehicle.arm()  # ArduCopter begins when it is armed
    return _granted(fault)


def _take_off(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    """ArduCopter's altitude is above home and wants GUIDED, PX4's above sea level, NaN for its default height."""
    home = vehicle.flight.state.home.altitude
    climb = vehicle.firmware.guided_takeoff
    if climb is None:
        if vehicle.flight.activity != "guided":
            return CommandResult(FAILED, "it is not in GUIDED")
        return _granted(vehicle.flight.take_off(home + request.z if request.z > 0 else home))
    fault = vehicle.flight.take_off(max(home, request.z) if math.isfinite(request.z) else home + climb)
    if fault is None:
        vehicle.mode = next(mode for mode in vehicle.firmware.modes if mode.name == "Takeoff")
    return _granted(fault)


def _return_home(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return _granted(vehicle.do("return"))


def _land(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return _granted(vehicle.do("land"))


def _stay(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return _granted(vehicle.do("hold"))


def _pause_or_go_on(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return _granted(vehicle.do("hold" if request.params[0] == 0 else "mission"))


def _reposition(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    """Go to a place; NaN, and 0, 0, mean the present one."""
    state = vehicle.flight.state
    east, north, altitude = state.body.place
    blank = not (math.isfinite(request.latitude_deg) and math.isfinite(request.longitude_deg))
    if not blank and not request.latitude_deg == request.longitude_deg == 0:
        if not _on_earth(request):
            return CommandResult(DENIED, _NO_PLACE)
        east, north, _ = state.local(request.latitude_deg, request.longitude_deg, 0.0)
    base = state.home.altitude if plain_frame(request.frame) == Frame.GLOBAL_RELATIVE_ALT else 0.0
    if math.isfinite(request.z):
        altitude = base + request.z
    if state.landed:
        return CommandResult(FAILED, "it stands on the ground")
    vehicle.do("guided")
    return _granted(vehicle.flight.go_to((east, north, altitude)))


def _set_home(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    state = vehicle.flight.state
    if request.params[0] == 1:
        state.home = Home(state.point, state.body.altitude)
    elif _on_earth(request) and math.isfinite(request.z) and state.reaches(request.latitude_deg, request.longitude_deg):
        state.home = Home(GeoPoint(request.latitude_deg, request.longitude_deg), request.z)
    else:
        return CommandResult(DENIED, _NO_PLACE)
    return CommandResult(ACCEPTED, messages=vehicle.encode(mavlink.MAVLINK_MSG_ID_HOME_POSITION, now))


def _on_earth(request: CommandRequest) -> bool:
    return abs(request.latitude_deg) <= 90 and abs(request.longitude_deg) <= 180


def _change_speed(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    changed = vehicle.flight.change_speed(request.params[0], request.params[1])
    return CommandResult(ACCEPTED) if changed else CommandResult(DENIED, "no positive speed")


def _set_current(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    if request.params[1] == 1:  # from the beginning, jumps and all
        vehicle.flight.run.forget()
    seq = _whole(request.params[0])
    if seq != -1 and not vehicle.flight.jump(seq):
        return CommandResult(DENIED, f"there is no item {seq}")
    return CommandResult(ACCEPTED, messages=vehicle.encode(mavlink.MAVLINK_MSG_ID_MISSION_CURRENT, now))


def _set_interval(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    known = vehicle.streams.set_interval(_whole(request.params[0]), request.params[1], now)
    return CommandResult(ACCEPTED) if known else CommandResult(DENIED, f"message {request.params[0]:.0f} is not sent")


def _get_interval(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    kind = _whole(request.params[0])
    if not 0 <= kind <= 65535:
        return CommandResult(DENIED, "there is no such message")
    interval = vehicle.streams.interval(kind)
    told = 0 if interval is None else -1 if math.isinf(interval) else round(interval * 1e6)
    return CommandResult(ACCEPTED, messages=(mavlink.MAVLink_message_interval_message(kind, told),))


def _request_message(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    kind = _whole(request.params[0])
    if kind == mavlink.MAVLINK_MSG_ID_MESSAGE_INTERVAL:
        asked = CommandRequest(request.command, (request.params[1], 0.0, 0.0, 0.0), 0.0, 0.0, 0.0, 0)
        return _get_interval(vehicle, asked, now)
    messages = vehicle.encode(kind, now)
    return (
        CommandResult(ACCEPTED, messages=messages)
        if messages
        else CommandResult(UNSUPPORTED, f"message {kind} is not known")
    )


def _version(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return CommandResult(ACCEPTED, messages=vehicle.encode(mavlink.MAVLINK_MSG_ID_AUTOPILOT_VERSION, now))


def _home(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return CommandResult(ACCEPTED, messages=vehicle.encode(mavlink.MAVLINK_MSG_ID_HOME_POSITION, now))


def _banner(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    return CommandResult(ACCEPTED, messages=vehicle.banner())


def _reboot(vehicle: SimulatedVehicle, request: CommandRequest, now: float) -> CommandResult:
    if request.params[0] != 1:
        return CommandResult(UNSUPPORTED)
    if vehicle.flight.state.armed:
        return CommandResult(FAILED, "it is armed")
    vehicle.reboot(now)
    return CommandResult(ACCEPTED)


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

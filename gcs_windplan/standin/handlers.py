"""What the stand-in makes of messages other than missions: commands, modes, parameters, streams, clocks."""

from __future__ import annotations

from collections.abc import Callable

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.codec import Message
from gcs_windplan.link.peer import sender as sender_of
from gcs_windplan.mission import command_name
from gcs_windplan.standin.commands import execute, read_request
from gcs_windplan.standin.rules import text
from gcs_windplan.standin.telemetry import ENCODERS
from gcs_windplan.standin.vehicle import SimulatedVehicle

_FTP_ACK, _FTP_NAK, _FTP_NOT_FOUND = 128, 129, 10


def _handle_heartbeat(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    return list(vehicle.greet(sender_of(message)))


def _handle_command(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    if message.target_component not in (0, vehicle.component):
        return []
    request, station = read_request(message), sender_of(message)
    outcome = execute(vehicle, request, now)
    result = _result_name(outcome.result) + (f", {outcome.reason}" if outcome.reason else "")
    params = ", ".join(f"{param:g}" for param in request.params)
    vehicle.say(f"command {command_name(request.command)} ({params}) by {station}: {result}")
    ack = mavlink.MAVLink_command_ack_message(request.command, outcome.result, 0, 0, station.system, station.component)
    said = [ack, *outcome.messages]
    if outcome.reason and outcome.result == mavlink.MAV_RESULT_FAILED:
        said.append(text(mavlink.MAV_SEVERITY_CRITICAL, f"Refused: {outcome.reason}"))
    return said


def _handle_mode(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    mode = vehicle.firmware.mode_numbered(message.custom_mode)
    fault = f"there is no mode {message.custom_mode}" if mode is None else vehicle.set_mode(mode)
    name = message.custom_mode if mode is None else mode.name
    vehicle.say(f"mode {name} wanted by {sender_of(message)}: {fault or 'it is so'}")
    result = mavlink.MAV_RESULT_ACCEPTED if fault is None else mavlink.MAV_RESULT_FAILED
    ack = mavlink.MAVLink_command_ack_message(mavlink.MAVLINK_MSG_ID_SET_MODE, result)  # as ArduPilot answers
    return [ack, ENCODERS[mavlink.MAVLINK_MSG_ID_HEARTBEAT](vehicle.snapshot(now))]


def _handle_parameter_list(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    messages = list(vehicle.parameters.all())
    vehicle.say(f"{len(messages)} parameters sent to {sender_of(message)}")
    return messages


def _handle_parameter_read(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    found = vehicle.parameters.read(message.param_id, message.param_index)
    return [] if found is None else [found]


def _handle_parameter_set(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    state = vehicle.flight.state
    found, state.profile = vehicle.parameters.set(
        message.param_id, message.param_value, message.param_type, state.profile
    )
    vehicle.say(f"parameter {message.param_id} {'unknown' if found is None else 'set'} for {sender_of(message)}")
    return [] if found is None else [found]


def _handle_stream_request(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    if vehicle.firmware.stream_groups:
        start = message.start_stop == 1
        vehicle.streams.set_group(message.req_stream_id, message.req_message_rate, start, now)
    return []


def _handle_time_sync(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    if message.tc1 != 0:
        return []
    return [mavlink.MAVLink_timesync_message(int(vehicle.clock * 1e9) or 1, message.ts1)]


def _handle_ping(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    if message.target_system != 0:
        return []
    to = sender_of(message)
    return [mavlink.MAVLink_ping_message(message.time_usec, message.seq, to.system, to.component)]


def _handle_version_request(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    return [vehicle.version()]


def _handle_file_request(vehicle: SimulatedVehicle, message: Message, now: float) -> list[Message]:
    """MAVLink FTP: no file is found here, so that nobody waits for one (mavlink.io, File Transfer Protocol)."""
    seq = (message.payload[0] + message.payload[1] * 256 + 1) % 65536
    session, asked = message.payload[2], message.payload[3]
    if asked in (_FTP_ACK, _FTP_NAK):
        return []
    header = [seq % 256, seq // 256, session, _FTP_NAK, 1, asked, 0, 0, 0, 0, 0, 0]
    payload = [*header, _FTP_NOT_FOUND, *([0] * (len(message.payload) - len(header) - 1))]
    to = sender_of(message)
    return [mavlink.MAVLink_file_transfer_protocol_message(0, to.system, to.component, payload)]


def _result_name(result: int) -> str:
    return str(mavlink.enums["MAV_RESULT"][result].name).removeprefix("MAV_RESULT_").lower()


#: Who answers what.
HANDLERS: dict[str, Callable[[SimulatedVehicle, Message, float], list[Message]]] = {
    "HEARTBEAT": _handle_heartbeat,
    "COMMAND_LONG": _handle_command,
    "COMMAND_INT": _handle_command,
    "SET_MODE": _handle_mode,
    "PARAM_REQUEST_LIST": _handle_parameter_list,
    "PARAM_REQUEST_READ": _handle_parameter_read,
    "PARAM_SET": _handle_parameter_set,
    "REQUEST_DATA_STREAM": _handle_stream_request,
    "TIMESYNC": _handle_time_sync,
    "PING": _handle_ping,
    "FILE_TRANSFER_PROTOCOL": _handle_file_request,
    "AUTOPILOT_VERSION_REQUEST": _handle_version_request,
}

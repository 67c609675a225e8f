"""Parameters that a firmware does not keep as they are sent.

What is kept is written in `mission.kept` as letters; here the value that comes back is worked out from them.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from typing import TypeAlias

from gcs_windplan.mission.commands import Command, Frame, takes_place
from gcs_windplan.mission.items import MissionItem, MissionItems
from gcs_windplan.mission.kept import BYTE, float_text, parameter_letters, same_float, single
from gcs_windplan.mission.lint.finding import Effect, Findings, Firmware, FirmwareFinding, named, numbered
from gcs_windplan.mission.lint.meaning import meaning
from gcs_windplan.mission.supported import PX4_WITHOUT_PLACE

_Keep: TypeAlias = Callable[[float], float]
_STEPS = {"c": 0.01, "h": 0.0, "r": 10.0}  # what rounding may take away, where it is not 1; h takes a part
_SIGNS = "sl"
_CUT = "iwungqtrc"


def parameters(mission: MissionItems, firmware: Firmware) -> Findings:
    """Parameters that are dropped, rounded or changed, and `autocontinue`."""
    for number, item in numbered(mission):
        for position, letter, sent in _parts(item, firmware):
            yield from _fate(number, item, firmware, position, letter, sent)
        if firmware.autopilot == "ardupilot" and not item.autocontinue:  # mission_cmd_to_mavlink_int: always 1
            fact = f"{firmware.name} goes on by itself and drops the order to wait (autocontinue 0)"
            advice = "use NAV_LOITER_UNLIM to wait"
            yield FirmwareFinding("autocontinue-dropped", "dropped", number, fact, "", advice)


def _parts(item: MissionItem, firmware: Firmware) -> list[tuple[int, str, float]]:
    """Number, letter and value of the parameters that are no place."""
    letters = parameter_letters(item.command, firmware.autopilot, firmware.vehicle_type)
    if item.frame == Frame.MISSION and item.command in PX4_WITHOUT_PLACE and firmware.autopilot == "px4":
        letters = letters if item.command == Command.DO_JUMP else "fffffff"  # all seven are kept as they are
    values: tuple[float, ...] = item.params
    if not takes_place(item.command):
        values = (*item.params, item.latitude_deg, item.longitude_deg, item.altitude)
    return [(i, letter, value) for i, (letter, value) in enumerate(zip(letters, values, strict=False), start=1)]


def _fate(number: int, item: MissionItem, firmware: Firmware, position: int, letter: str, sent: float) -> Findings:
    held = held_value(letter, sent)
    if held is None or same_float(sent, held) or (math.isnan(sent) and held == 0):
        return
    if letter in _SIGNS and sent == 0:
        return  # unset: there was nothing to keep
    name = f"parameter {position} of {named(item)}{meaning(item.command, position)}"
    if letter == "-":
        fact, advice = f"{firmware.name} drops {name}", _advice(item, position)
        yield FirmwareFinding("parameter-dropped", "dropped", number, fact, float_text(sent), advice)
        return
    change = f"{float_text(sent)} becomes {float_text(held)}"
    kind: Effect = "rounded" if _is_rounded(letter, sent, held) else "changed"
    fact = f"{firmware.name} keeps {name} {_WORDS[letter]}"
    yield FirmwareFinding(
        f"parameter-{kind}", kind, number, fact, change, "" if kind == "rounded" else "mind the range"
    )


def _advice(item: MissionItem, position: int) -> str:
    if item.command == Command.NAV_WAYPOINT and position == 4:
        return "a CONDITION_YAW behind the waypoint turns a copter"
    return "write 0, or do not count on it"


def held_value(letter: str, sent: float) -> float | None:
    """What comes back of a value that was sent; None where that is not known, or the same thing said otherwise."""
    if letter in "xay":  # a yaw is the same modulo 360°, an altitude is a place's matter
        return None
    if math.isnan(sent) or not math.isfinite(single(sent)):
        return 0.0 if letter == "-" else sent
    return _HELD[letter](sent)


def _is_rounded(letter: str, sent: float, held: float) -> bool:
    if letter == "h":
        return True
    return letter in _CUT and abs(sent - held) < _STEPS.get(letter, 1.0) and (held == 0 or sent * held > 0)


def _bits(lowest: int, highest: int) -> _Keep:
    """A whole number of so many bits; beyond its ends it begins again at the other (measured on ArduCopter 4.7)."""
    return lambda sent: float((int(sent) - lowest) % (highest - lowest + 1) + lowest)


def _half(sent: float) -> float:
    try:
        return float(struct.unpack("<e", struct.pack("<e", sent))[0])
    except OverflowError:
        return math.copysign(math.inf, sent)


def _turns(sent: float) -> float:
    """Whole turns up to 255, one that is not whole in parts of 256."""
    return int(sent * 256) / 256 if 0 < sent < 1 else _bits(0, BYTE)(min(sent, BYTE))


def _radius(sent: float) -> float:
    """Metres up to 255, tens of metres up to 2550, and the way round as a sign."""
    size = abs(sent)
    return math.copysign(float(int(size)) if size <= BYTE else 10.0 * min(BYTE, int(size * 0.1)), sent)


_HELD: dict[str, _Keep] = {
    "f": single,
    "h": _half,
    "i": lambda sent: float(int(sent)),
    "w": _bits(0, 0xFFFF),
    "u": _bits(0, BYTE),
    "n": _bits(-0x8000, 0x7FFF),
    "g": lambda sent: math.copysign(_bits(0, 0xFFFF)(abs(sent)), sent),
    "q": lambda sent: min(float(BYTE), _bits(0, 0xFFFF)(sent)),
    "c": lambda sent: int(single(single(sent) * 100)) / 100,
    "b": lambda sent: float(sent > 0),
    "s": lambda sent: -1.0 if sent < 0 else 1.0,
    "l": lambda sent: -1.0 if sent < 0 else 1.0,
    "t": _turns,
    "r": _radius,
    "-": lambda sent: 0.0,
}
_WORDS: dict[str, str] = {
    "h": "with 3 digits",
    "i": "as a whole number, cut",
    "w": "as a whole number from 0 to 65535, cut",
    "u": "as a whole number from 0 to 255, cut",
    "n": "as a whole number from -32768 to 32767, cut",
    "g": "as a whole number up to 65535, cut",
    "q": "as a whole number from 0 to 255, cut",
    "c": "in hundredths, cut",
    "b": "as 1 or 0 only",
    "s": "as its sign only",
    "l": "as its sign only",
    "t": "as whole turns from 1 to 255, cut",
    "r": "in whole metres to 255, in tens of metres to 2550",
}

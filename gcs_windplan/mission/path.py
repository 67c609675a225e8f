"""What an autopilot makes of a mission's items: the moves that it flies, one after the other.

Jumps are unrolled, holds and commanded speeds go along; how long the moves take is the vehicle's business. The meanings
are ArduCopter's as measured in its simulator, PX4's as documented; a fixed-wing differs where it circles and lands.

    take-off ─▶ leg ─▶ leg ─▶ ... ─▶ landing, or return
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.mission.commands import LANDINGS, TAKEOFFS, Command, Frame, command_name, plain_frame
from gcs_windplan.mission.firmware import Firmware, flying_firmware
from gcs_windplan.mission.items import Home, MissionItem
from gcs_windplan.mission.jumps import stored_items, unrolled
from gcs_windplan.mission.mission_items import MissionItems
from gcs_windplan.wind.field import Ground

Place: TypeAlias = tuple[float, float, float]
MoveKind: TypeAlias = Literal["take-off", "leg", "landing", "return"]

_APART = 0.01  # [m] places nearer than this are one
_FULL_CIRCLE = 2 * math.pi
_PASSED = (Command.NAV_WAYPOINT, Command.NAV_SPLINE_WAYPOINT)
#: Items that a waypoint before them is passed for; for all others it comes to rest (ArduCopter, mode_auto.cpp).
_LEGS = (*_PASSED, Command.NAV_LOITER_TIME, Command.NAV_LOITER_UNLIM)
_ONLY_REACHED = {
    Command.NAV_SPLINE_WAYPOINT: "is counted as a straight leg",
    Command.NAV_LOITER_UNLIM: "loiters indefinitely; the time counts up to it",
    Command.NAV_LOITER_TURNS: "is flown to; its circles are not counted",
    Command.NAV_PAYLOAD_PLACE: "is flown to; its descent is not counted",
}
_LABELS: Final = {Command.NAV_WAYPOINT: "waypoint", Command.NAV_SPLINE_WAYPOINT: "spline"}


@dataclass(frozen=True, slots=True)
class CommandedSpeeds:
    """The speeds commanded so far [m/s]; None: the autopilot's own. `air` is a fixed-wing's."""

    ground: float | None = None
    air: float | None = None
    climb: float | None = None
    descent: float | None = None


@dataclass(frozen=True, slots=True)
class Move:
    """A straight piece of a mission as flown, or a wait in place.

    `item` counts the mission's items from 1, home being 0. `start` and `end` are east, north in the course's frame and
    height AMSL [m]; a return's end is home. It begins at rest where `rests`, and waits at its end for `hold` [s]; it
    circles there on `radius` [m] for as long as `circling` metres take. `follows`: its height above ground
    changes evenly, not that above the sea. `label` is what lies at its end: `take-off`, `waypoint`, `spline`, `loiter`,
    `wait`, `land`, `return`.
    """

    item: int
    kind: MoveKind
    label: str
    start: Place
    end: Place
    told: CommandedSpeeds = CommandedSpeeds()
    hold: float = 0.0
    circling: float = 0.0
    radius: float = 0.0
    rests: bool = True
    follows: bool = False


@dataclass(frozen=True, slots=True)
class Course:
    """The moves of a mission in a local frame, in the order flown; `home` is where it takes off, east, north, AMSL [m].

    `landings` are the items that land and the places that they name; `remarks` say what is not modelled. `endless` is
    the item that has no end; `aloft` where the last item leaves it in the air.
    """

    frame: LocalFrame
    home: Place
    moves: tuple[Move, ...]
    remarks: tuple[str, ...] = ()
    landings: tuple[tuple[int, Place], ...] = ()
    endless: int | None = None
    aloft: bool = False


def course_of(mission: MissionItems, frame: LocalFrame | None = None, ground: Ground | None = None) -> Course:
    """The moves of a mission, in `frame` or, without one, about home.

    Without `ground` waypoints above terrain count as above home, and a landing ends at its item's height. Raises
    `InputError` where the mission names no home, or repeats more than 20 000 items.
    """
    if mission.home is None:
        raise InputError("the mission names no home, from which its heights and its take-off count: give it one")
    firmware = flying_firmware(mission.autopilot, mission.vehicle_type)
    walk = _Walk(mission, firmware, mission.home, frame or LocalFrame(mission.home.point), ground)
    for number, item in unrolled(stored_items(mission), firmware.jumps, walk.remark, walk.jump_forever):
        walk.take(number, item)
        if walk.over:
            break
    aloft = not walk.landed and walk.endless is None
    return Course(
        walk.frame, walk.home_place, tuple(walk.moves), tuple(walk.remarks), tuple(walk.landings), walk.endless, aloft
    )


@dataclass(slots=True)
class _Walk:
    """Where the vehicle is in the mission and what it was told; `passing` says whether the last place may be passed.

    `landed`: it stands on the ground, `down`: after a flight, so that nothing but a take-off goes on.
    """

    mission: MissionItems
    firmware: Firmware
    home: Home
    frame: LocalFrame
    ground: Ground | None
    over: bool = False
    landed: bool = True
    down: bool = False
    passing: bool = False
    endless: int | None = None
    landings: list[tuple[int, Place]] = field(default_factory=list)
    told: CommandedSpeeds = field(default_factory=CommandedSpeeds)
    moves: list[Move] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    home_place: Place = (0.0, 0.0, 0.0)
    place: Place = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        self.home_place = self.place = (*self._plan(self.home.point.latitude_deg, self.home.point.longitude_deg),
                                        self.home.altitude)  # fmt: skip

    @property
    def winged(self) -> bool:
        return self.mission.vehicle_type == "fixed-wing"

    def remark(self, words: str) -> None:
        """Note once what is not modelled."""
        if words not in self.remarks:
            self.remarks.append(words)

    def take(self, number: int, item: MissionItem) -> None:
        """Do what an item means."""
        command = item.command
        if self.down and self._is_flown(item) and command not in (*TAKEOFFS, Command.NAV_DELAY):
            self.remark(f"item {number}, {command_name(command)}, stands behind a landing and is unreachable")
            self.over = True
        elif command in TAKEOFFS:
            self._take_off(number, item)
        elif command in LANDINGS:
            self._land(number, item)
        elif command == Command.NAV_RETURN_TO_LAUNCH:
            self._return(number)
        elif command == Command.NAV_DELAY:
            self._delay(number, item)
        elif command == Command.DO_CHANGE_SPEED:
            self._change_speed(item)
        elif command in _LEGS or command in _ONLY_REACHED or command == Command.NAV_LOITER_TO_ALT:
            self._go(number, item)
        elif command == Command.DO_SET_HOME or not command_name(command).startswith(("DO_", "JUMP_TAG")):
            self.passing &= not self._is_flown(item)
            self.remark(f"item {number}, {command_name(command)}, is ignored")

    def jump_forever(self, number: int, target: int) -> None:
        """A jump back that is always taken; from the ground it leads on to a take-off only."""
        begun = next((item for item in self.mission.items[target - 1 :] if self._is_flown(item)), None)
        if not self.down or (begun is not None and begun.command in TAKEOFFS):
            self.endless = number

    def _move(self, move: Move) -> None:
        self.moves.append(move)
        self.place = move.end

    def _leg(
        self, number: int, label: str, end: Place, *, hold: float = 0.0, passed: bool = False, passing: bool = False,
        circle: tuple[float, float] = (0.0, 0.0), follows: bool = False,
    ) -> None:  # fmt: skip
        """A leg; `passed` says whether the place that it begins at may be passed, `passing` its end."""
        rests = not (passed and self.passing)
        self._move(Move(number, "leg", label, self.place, end, self.told, hold, *circle, rests, follows))
        self.passing = passing and hold == 0

    def _go(self, number: int, item: MissionItem) -> None:
        """A leg to the item's place, and its hold."""
        end, command = self._end(number, item), Command(item.command)
        if self.landed:
            self.remark(f"there is no take-off before item {number}; one straight up is counted")
            self._lift(number, max(end[2], self.place[2]))
        if command in _ONLY_REACHED and not (command == Command.NAV_LOITER_TURNS and self._circle(item)[1] > 0):
            self.remark(f"item {number}, {command_name(command)}, {_ONLY_REACHED[command]}")
        holds = command in (Command.NAV_WAYPOINT, Command.NAV_LOITER_TIME) and item.params[0] > 0
        if command == Command.NAV_LOITER_TO_ALT:
            self._leg(number, "loiter", (end[0], end[1], self.place[2]))
        self._leg(
            number,
            _LABELS.get(command, "loiter"),
            end,
            hold=item.params[0] if holds else 0.0,
            passed=command in _LEGS,
            passing=command in _PASSED,
            circle=self._circle(item),
            follows=self.ground is not None and plain_frame(item.frame) == Frame.GLOBAL_TERRAIN_ALT,
        )
        if command == Command.NAV_LOITER_UNLIM:
            self.over, self.endless = True, number

    def _circle(self, item: MissionItem) -> tuple[float, float]:
        """How far it flies in circles at an item whose number it names [m], and their radius [m]."""
        index = self.firmware.circles.get(item.command)
        if index is None:
            return 0.0, 0.0
        named = abs(item.params[index])
        radius = named if named > 0 else self.firmware.circle_radius
        turns = item.params[0] if item.command == Command.NAV_LOITER_TURNS else 0.0
        return max(turns, 0.0) * _FULL_CIRCLE * radius, radius

    def _lift(self, number: int, altitude: float) -> None:
        east, north, _ = self.place
        self._move(Move(number, "take-off", "take-off", self.place, (east, north, altitude), self.told))
        self.landed = self.down = self.passing = False

    def _take_off(self, number: int, item: MissionItem) -> None:
        """Straight up; PX4 then flies to the place that the item names, ArduCopter does not."""
        end = self._end(number, item)
        if self.landed:
            self._lift(number, max(end[2], self.place[2]))
        else:
            self._leg(number, "take-off", (*self.place[:2], end[2]))
        if self.firmware.takeoff_goes_to_place and math.dist(end[:2], self.place[:2]) > _APART:
            self._leg(number, "waypoint", end)

    def _land(self, number: int, item: MissionItem) -> None:
        """A level leg to the item's place, then down to the ground: its item's height where that is not known.

        A fixed-wing glides there.
        """
        if self.landed:
            return
        end, height = self._end(number, item), self.place[2]
        self.landings.append((number, end))
        if self.winged:
            self._leg(number, "land", end, passed=True)
        elif math.dist(end[:2], self.place[:2]) > _APART:
            self._leg(number, "land", (*end[:2], height))
        below = end[2] if end[2] < height else min(self.home.altitude, height)
        if not self.winged and self.ground is not None:
            under = self._under(end)
            below = below if math.isnan(under) else min(under, height)
        self._move(Move(number, "landing", "land", self.place, (*self.place[:2], below), self.told))
        self.passing = False
        self._touch_down()

    def _return(self, number: int) -> None:
        """Home and down; speeds commanded before do not count on the way."""
        if not self.landed:
            self._move(Move(number, "return", "return", self.place, self.home_place))
        self._touch_down()

    def _touch_down(self) -> None:
        """On the ground a mission ends, or goes on with a take-off."""
        self.landed = self.down = True
        self.over = not self.firmware.lands_and_goes_on

    def _delay(self, number: int, item: MissionItem) -> None:
        if item.params[0] > 0:
            self._leg(number, "wait", self.place, hold=item.params[0])
        else:
            self.passing = False
            self.remark(f"item {number}, NAV_DELAY until a time of day, is counted as a stop")

    def _change_speed(self, item: MissionItem) -> None:
        """Types 0 and 1 set the ground speed, 2 the climb, 3 the descent; nothing unless positive, as measured.

        Of a fixed-wing 0 sets the airspeed (ArduPlane's do_change_speed).
        """
        kind, speed = item.params[:2]
        names = {0: "air" if self.winged else "ground", 1: "ground", 2: "climb", 3: "descent"}
        if kind in names and speed > 0:
            self.told = replace(self.told, **{names[int(kind)]: speed})

    def _end(self, number: int, item: MissionItem) -> Place:
        """Where an item leads; here, where it names no place."""
        east, north, altitude = self.place
        if item.has_place:
            east, north = self._plan(item.latitude_deg, item.longitude_deg)
        if self.firmware.means_present_altitude(item.command, item.frame, item.altitude):
            return east, north, altitude
        frame = plain_frame(item.frame)
        if frame == Frame.GLOBAL:
            return east, north, item.altitude
        if frame == Frame.GLOBAL_TERRAIN_ALT:
            return east, north, item.altitude + self._datum(number, east, north)
        if frame != Frame.GLOBAL_RELATIVE_ALT:
            return east, north, altitude
        return east, north, self.home.altitude + item.altitude

    def _datum(self, number: int, east: float, north: float) -> float:
        """The ground that a height above terrain counts from [m], home's where it is not known."""
        under = self._under((east, north, 0.0))
        if math.isnan(under):
            self.remark(f"item {number} counts from the terrain; its height is taken from home")
            return self.home.altitude
        return under

    def _under(self, place: Place) -> float:
        """The ground's height under a place [m], NaN where it is not known."""
        return math.nan if self.ground is None else float(self.ground(np.array([place]))[0])

    def _is_flown(self, item: MissionItem) -> bool:
        """Whether the vehicle flies an item rather than doing something on its way."""
        return item.command in self.firmware.navigation

    def _plan(self, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
        east, north = self.frame.to_local(latitude_deg, longitude_deg)[0]
        return float(east), float(north)

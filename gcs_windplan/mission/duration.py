"""How long an autopilot takes for a mission: its items walked through as a multicopter flies them.

A plan counts what the wind lets the vehicle do; an autopilot takes longer, since it gains and loses speed at every
stop and corner. The pace is the vehicle's (`gcs_windplan.vehicle.pace`); here are the meanings of the items.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import InputError
from gcs_windplan.geodesy import LocalFrame
from gcs_windplan.mission.commands import Command, Frame, command_name, plain_frame
from gcs_windplan.mission.items import Home, Mission, MissionItem
from gcs_windplan.vehicle import (
    ARDUCOPTER_PACE,
    PX4_PACE,
    Pace,
    as_flown,
    landing_seconds,
    return_seconds,
    takeoff_seconds,
)

Place: TypeAlias = tuple[float, float, float]
#: The mean wind [m/s] (n, 3) along straight legs from places (n, 3) to places (n, 3): east, north of home and height
#: AMSL [m]. For a wind field in home's frame: `lambda starts, ends: field.at((starts + ends) / 2)`.
WindAlong: TypeAlias = Callable[[FloatArray, FloatArray], FloatArray]

_MOST_ITEMS = 20_000  # flown in one mission, its jumps unrolled
_MOST_JUMPS = 255  # AP_Mission.cpp, advance_current_nav_cmd: more in a row lead nowhere
_FOR_EVER = -1
_APART = 0.01  # [m] places nearer than this are one
_LANDINGS = (Command.NAV_LAND, Command.NAV_VTOL_LAND)
_TAKEOFFS = (Command.NAV_TAKEOFF, Command.NAV_VTOL_TAKEOFF)
_PASSED = (Command.NAV_WAYPOINT, Command.NAV_SPLINE_WAYPOINT)
#: Items that a waypoint before them is passed for; for all others it comes to rest (ArduCopter, mode_auto.cpp).
_LEGS = (*_PASSED, Command.NAV_LOITER_TIME, Command.NAV_LOITER_UNLIM)
_ONLY_REACHED = {
    Command.NAV_SPLINE_WAYPOINT: "is counted as a straight leg",
    Command.NAV_LOITER_UNLIM: "holds for ever; the time counts up to it",
    Command.NAV_LOITER_TURNS: "is flown to; its circles are not counted",
    Command.NAV_PAYLOAD_PLACE: "is flown to; its descent is not counted",
}


@dataclass(frozen=True, slots=True)
class FlownLeg:
    """A leg as flown, or a wait in place.

    `item` counts the mission's items from 1, home being 0. `start` and `end` are east, north of home and height AMSL
    [m]. `seconds` contain `hold` [s] at its end and are infinite where the wind is too strong. `commanded` is the level
    ground speed, `peak` the speed along the slope that it comes to [m/s].
    """

    item: int
    start: Place
    end: Place
    commanded: float
    peak: float
    hold: float
    seconds: float


@dataclass(frozen=True, slots=True)
class MissionDuration:
    """How long a mission takes [s], in parts.

    `takeoff` from arming to the height of the take-off item; then `legs`; `ending` from the end of the last leg to
    disarmed, on the way home or down. All take-offs and landings of the mission are in `takeoff` and `ending`.
    `losses` is how much of the legs' time goes into slowing at corners and stops. `remarks` name what is not modelled.
    """

    takeoff: float
    legs: tuple[FlownLeg, ...]
    ending: float
    losses: float
    remarks: tuple[str, ...] = ()

    @property
    def en_route(self) -> float:
        """All legs with their holds [s]."""
        return math.fsum(leg.seconds for leg in self.legs)

    @property
    def total(self) -> float:
        """From arming to disarmed, or to the last item [s]."""
        return self.takeoff + self.en_route + self.ending


def duration_of(mission: Mission, wind: WindAlong | None = None, pace: Pace | None = None) -> MissionDuration:
    """How long the mission's autopilot takes for it, from arming at home on.

    `pace` is by default that of the mission's autopilot with its default parameters, ArduPilot's where it names none.
    Without `wind` the air is still. Waypoints above terrain count as above home. Raises `InputError` where the
    mission names no home, or is a fixed-wing's, or repeats more than 20 000 items.
    """
    if mission.home is None:
        raise InputError("the mission names no home, from which its heights and its take-off count: give it one")
    if mission.vehicle_type == "fixed-wing":
        raise InputError("how long a fixed-wing takes for a mission is not known, only a multicopter's time is")
    if pace is None:
        pace = PX4_PACE if mission.autopilot == "px4" else ARDUCOPTER_PACE
    walk = _Walk(mission.home, pace, wind or _still, px4=mission.autopilot == "px4")
    for number, item in _unrolled(mission.items, walk.remark):
        if walk.over:
            break
        walk.take(number, item)
    walk.fly()
    return MissionDuration(walk.takeoff, tuple(walk.legs), walk.ending, walk.losses, tuple(walk.remarks))


def _still(starts: FloatArray, ends: FloatArray) -> FloatArray:
    return np.zeros_like(starts)


def _unrolled(items: Sequence[MissionItem], remark: Callable[[str], None]) -> Iterator[tuple[int, MissionItem]]:
    """The items as they come, each with its number from 1 on; jumps are made as often as they say."""
    made: dict[int, int] = {}
    index, given, jumps = 0, 0, 0
    while index < len(items) and jumps <= _MOST_JUMPS:
        item = items[index]
        if item.command in (Command.DO_JUMP, Command.DO_JUMP_TAG):
            target, repeats = _target(items, item), item.params[1]
            if repeats == _FOR_EVER and target is not None:
                remark(f"item {index + 1} jumps for ever; the time counts up to its first jump")
                return
            if target is None:
                remark(f"item {index + 1} jumps to nowhere and is passed over")
            elif made.get(index, 0) < repeats:
                made[index] = made.get(index, 0) + 1
                index, jumps = target, jumps + 1
                continue
        else:
            jumps, given = 0, given + 1
            if given > _MOST_ITEMS:
                raise InputError(f"the mission's jumps lead through more than {_MOST_ITEMS} items: repeat them less")
            yield index + 1, item
        index += 1


def _target(items: Sequence[MissionItem], jump: MissionItem) -> int | None:
    """Where a jump leads, None where there is no such item."""
    if jump.command == Command.DO_JUMP:
        return next((i for i in range(len(items)) if i + 1 == jump.params[0]), None)
    tags = (i for i, item in enumerate(items) if item.command == Command.JUMP_TAG and item.params[0] == jump.params[0])
    return next(tags, None)


@dataclass(slots=True)
class _Walk:
    """Where the vehicle is in the mission, what it was told, and the legs that it has not yet been timed for.

    `speeds` are commanded: level, climb and descent [m/s]. `passing` says whether the last place may be passed.
    """

    home: Home
    pace: Pace
    wind: WindAlong
    px4: bool
    over: bool = False
    landed: bool = True
    passing: bool = False
    takeoff: float = 0.0
    ending: float = 0.0
    losses: float = 0.0
    place: Place = (0.0, 0.0, 0.0)
    speeds: list[float] = field(default_factory=list)
    legs: list[FlownLeg] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    _ahead: list[tuple[int, Place, tuple[float, ...], float]] = field(default_factory=list)
    _stops: list[bool] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.place = (0.0, 0.0, self.home.altitude)
        self.speeds = [self.pace.speed, self.pace.climb, self.pace.descent]

    def remark(self, words: str) -> None:
        """Note once what is not modelled."""
        if words not in self.remarks:
            self.remarks.append(words)

    def take(self, number: int, item: MissionItem) -> None:
        """Do what an item means."""
        command = item.command
        if command in _TAKEOFFS:
            self._take_off(number, item)
        elif command in _LANDINGS:
            self._land(number, item)
        elif command == Command.NAV_RETURN_TO_LAUNCH:
            self._return()
        elif command == Command.NAV_DELAY:
            self._delay(number, item)
        elif command == Command.DO_CHANGE_SPEED:
            self._change_speed(item)
        elif command in _LEGS or command in _ONLY_REACHED or command == Command.NAV_LOITER_TO_ALT:
            self._go(number, item)
        elif command == Command.DO_SET_HOME or not command_name(command).startswith(("DO_", "JUMP_TAG")):
            self.passing &= not command_name(command).startswith("NAV_")
            self.remark(f"item {number}, {command_name(command)}, is passed over")

    def fly(self) -> None:
        """Time the legs that were gathered, from rest to rest."""
        if not self._ahead:
            return
        points = np.array([self.place, *(end for _, end, _, _ in self._ahead)])
        told = np.array([told for _, _, told, _ in self._ahead])
        holds = np.array([0.0, *(hold for *_, hold in self._ahead)])
        winds = self.wind(points[:-1], points[1:])
        times = as_flown(
            points,
            told[:, 0],
            holds,
            winds,
            self.pace,
            climbs=told[:, 1],
            descents=told[:, 2],
            stops=[*self._stops, True],
        )
        for i, (number, end, (speed, *_), hold) in enumerate(self._ahead):
            leg = FlownLeg(number, self.place, end, speed, float(times.peaks[i]), hold, float(times.seconds[i]))
            self.legs.append(leg)
            self.place = end
        self.losses += math.fsum(times.losses)
        self._ahead, self._stops, self.passing = [], [], False

    @property
    def _latest(self) -> Place:
        """Where the legs gathered so far lead."""
        return self._ahead[-1][1] if self._ahead else self.place

    def _leg(self, number: int, end: Place, hold: float = 0.0, *, passed: bool = False, passing: bool = False) -> None:
        """Gather a leg; `passed` says whether the place that it begins at may be passed, `passing` its end."""
        self._stops.append(not (passed and self.passing))
        self._ahead.append((number, end, tuple(self.speeds), hold))
        self.passing = passing and hold == 0

    def _go(self, number: int, item: MissionItem) -> None:
        """A leg to the item's place, and its hold."""
        end = self._end(number, item)
        if self.landed:
            self.remark(f"there is no take-off before item {number}; one straight up is counted")
            self._lift(max(end[2], self.place[2]))
        if item.command in _ONLY_REACHED:
            self.remark(f"item {number}, {command_name(item.command)}, {_ONLY_REACHED[Command(item.command)]}")
        holds = item.command in (Command.NAV_WAYPOINT, Command.NAV_LOITER_TIME) and item.params[0] > 0
        if item.command == Command.NAV_LOITER_TO_ALT:
            self._leg(number, (end[0], end[1], self._latest[2]))
        self._leg(
            number,
            end,
            item.params[0] if holds else 0.0,
            passed=item.command in _LEGS,
            passing=item.command in _PASSED,
        )
        self.over = item.command == Command.NAV_LOITER_UNLIM

    def _lift(self, altitude: float) -> None:
        east, north, ground = self.place
        self.takeoff += takeoff_seconds(altitude - ground, self.pace, self.speeds[1])
        self.place, self.landed = (east, north, altitude), False

    def _take_off(self, number: int, item: MissionItem) -> None:
        """Straight up; PX4 then flies to the place that the item names, ArduCopter does not."""
        end = self._end(number, item)
        if self.landed:
            self._lift(max(end[2], self.place[2]))
        else:
            self._leg(number, (*self._latest[:2], end[2]))
        if self.px4 and math.dist(end[:2], self._latest[:2]) > _APART:
            self._leg(number, end)

    def _land(self, number: int, item: MissionItem) -> None:
        """A level leg to the item's place, then down; the ground is taken to be at the item's height, at most here."""
        if self.landed:
            return
        end, height = self._end(number, item), self._latest[2]
        if math.dist(end[:2], self._latest[:2]) > _APART:
            self._leg(number, (*end[:2], height))
        self.fly()
        ground = end[2] if end[2] < height else min(self.home.altitude, height)
        self.ending += landing_seconds(height - ground, self.pace, self.speeds[2])
        self.place, self.landed = (*self.place[:2], ground), True

    def _return(self) -> None:
        """Home and down; speeds commanded before do not count, and the mission ends."""
        self.over = True
        self.fly()
        if self.landed:
            return
        east, north, altitude = self.place
        wind = self.wind(np.array([self.place]), np.array([[0.0, 0.0, altitude]]))[0]
        blowing = (float(wind[0]), float(wind[1]))
        self.ending += return_seconds((-east, -north), altitude - self.home.altitude, self.pace, blowing)

    def _delay(self, number: int, item: MissionItem) -> None:
        if item.params[0] > 0:
            self._leg(number, self._latest, item.params[0])
        else:
            self.passing = False
            self.remark(f"item {number}, NAV_DELAY until a time of day, is counted as a stop")

    def _change_speed(self, item: MissionItem) -> None:
        """Types 0 and 1 set the ground speed, 2 the climb, 3 the descent; nothing unless positive, as measured."""
        kind, speed = item.params[:2]
        if kind in (0, 1, 2, 3) and speed > 0:
            self.speeds[max(int(kind) - 1, 0)] = speed

    def _end(self, number: int, item: MissionItem) -> Place:
        """Where an item leads; here, where it names no place. Measured: ArduPilot's relative 0 keeps the height."""
        east, north, altitude = self._latest
        if item.has_place:
            at = LocalFrame(self.home.point).to_local(item.latitude_deg, item.longitude_deg)[0]
            east, north = float(at[0]), float(at[1])
        frame, is_landing = plain_frame(item.frame), item.command in _LANDINGS
        if frame == Frame.GLOBAL:
            return east, north, item.altitude
        if frame == Frame.GLOBAL_TERRAIN_ALT:
            self.remark(f"item {number} counts from the terrain; its height is taken from home")
        keeps = frame == Frame.GLOBAL_RELATIVE_ALT and item.altitude == 0 and not self.px4 and not is_landing
        if keeps or frame not in (Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL_TERRAIN_ALT):
            return east, north, altitude
        return east, north, self.home.altitude + item.altitude

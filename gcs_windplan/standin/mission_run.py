"""Flying a mission item by item: what each item means in moves, and what is done on the way.

Each leg is flown at the commanded ground speed, which the airspeed and the wind limit, as ArduCopter does it.
"""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta

from gcs_windplan.mission import Command, Frame, Home, command_name, plain_frame
from gcs_windplan.mission.commands import LANDINGS, TAKEOFFS
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.motion import Segment, StraightSegment, Wait
from gcs_windplan.standin.pace import LegPace, Vector, exit_speed
from gcs_windplan.standin.sequence import ItemSequence, Step
from gcs_windplan.standin.storage import infeasible
from gcs_windplan.standin.vehicle_state import REACH, Current, Reached, VehicleState

_FORESIGHT = 6  # legs that are looked at for the speed at the end of one
_APART = 0.01  # [m] places nearer than this are one
_PASSED = (Command.NAV_WAYPOINT, Command.NAV_SPLINE_WAYPOINT)
_LEGS = (*_PASSED, Command.NAV_LOITER_UNLIM, Command.NAV_LOITER_TIME)
_NO_LIFT_NEEDED = (*TAKEOFFS, *LANDINGS, Command.NAV_RETURN_TO_LAUNCH, Command.NAV_DELAY)
_LOOKED_AT = 16  # AP_Mission.cpp, starts_with_takeoff_cmd: items looked at for a take-off


class MissionRun:
    """The course through the mission that the vehicle holds, and where on it the state is.

    `items` gives that mission as it is right now; a new one may arrive in flight. `touched` is called when the state
    stands on the ground after a landing.
    """

    def __init__(
        self, state: VehicleState, items: Callable[[], Sequence[StoredItem]], touched: Callable[[], None]
    ) -> None:
        self.current = 0
        self.complete = False
        self.ground_speed = state.profile.speed
        self._state = state
        self._items = items
        self._touched = touched
        self._first = 1 if state.firmware.transfers.home_item else 0
        self._sequence = ItemSequence(state.firmware)
        self._pending: deque[int] = deque()
        self._waited = 0.0

    @property
    def waits_for_condition(self) -> bool:
        """Whether something is still to be done on the present leg."""
        return bool(self._pending)

    def fault(self) -> str | None:
        """Why the mission would not be flown, or None."""
        items = self._items()
        if len(items) <= self._first:
            return "there is no mission"
        for seq, item in enumerate(items[self._first :], start=self._first):
            if item.has_place and not self._state.is_near(item):
                return f"item {seq} is more than {REACH / 1000:.0f} km away"
        return infeasible(items, self._state.firmware) or self._refused(items)

    def _refused(self, items: Sequence[StoredItem]) -> str | None:
        """Why a firmware that looks for a take-off and for terrain does not begin, or None."""
        firmware = self._state.firmware
        if firmware.takeoff != "required":
            return None
        looked_at = items[self._first : _LOOKED_AT]
        flown = (one for one in looked_at if one.command in firmware.navigation and one.command != Command.NAV_DELAY)
        first = next(flown, None)
        if self._state.landed and (first is None or first.command not in TAKEOFFS):
            return "Missing Takeoff Cmd"
        frames = {plain_frame(item.frame) for item in items if item.has_place}
        if Frame.GLOBAL_TERRAIN_ALT in frames and self._state.world.terrain is None:
            return "Missing terrain data"
        return None

    def forget(self) -> None:
        """Be at the beginning again."""
        self.current, self.complete = 0, False
        self._sequence, self._pending = ItemSequence(self._state.firmware), deque()

    def begin(self) -> list[Segment]:
        """Begin, or go on where it was left; a speed commanded before is forgotten, as measured."""
        if self.complete:
            self.forget()
        self.ground_speed = self._state.profile.speed
        return self._start(self._sequence.step(self._items(), max(self.current, self._first)))

    def proceed(self) -> list[Segment]:
        """The present item is completed: go on with the next."""
        step = self._sequence.step(self._items(), self.current + 1)
        # measured: ArduPilot names the items that are done after a waypoint in the waypoint's place
        named = step.before if self._first and step.before else (self.current,)
        self._state.events.extend(Reached(seq) for seq in named)
        return self._start(step)

    def jump(self, seq: int) -> list[Segment]:
        """Go on with an item of the mission."""
        self.aim(seq)
        return self._start(self._sequence.step(self._items(), self.current))

    def aim(self, seq: int) -> None:
        """Take an item as the one to begin with; from the beginning all jumps count anew."""
        if seq < self._first:
            seq, self._sequence = self._first, ItemSequence(self._state.firmware)
        self.current, self.complete = seq, False

    def next_is_takeoff(self) -> bool:
        """Whether the item after the present one takes off again."""
        items = self._items()
        step = next(self._sequence.ahead(items, self.current + 1), None)
        return step is not None and step.seq is not None and items[step.seq].command in TAKEOFFS

    def wait(self, seconds: float) -> bool:
        """Let time pass on the present leg; whether something was done that changes its pace."""
        self._waited += seconds
        return self._do_pending()

    def repaced(self, leg: StraightSegment) -> StraightSegment:
        """The rest of a leg at the commanded speed as it is now."""
        return self._leg(leg.end, passing=leg.exit_speed > 0)

    def _start(self, step: Step) -> list[Segment]:
        self._pending, self._waited = deque(step.before), 0.0
        if step.seq is None:
            self._do_pending()
            self._pending.clear()
            self.complete = True
            self._state.say("Mission complete")
            return []
        self.current = step.seq
        self._state.events.append(Current(step.seq))
        self._do_pending()
        return self._moves(self._items()[step.seq])

    def _moves(self, item: StoredItem) -> list[Segment]:
        """What an item means, from where the state is."""
        if item.has_place and not self._state.is_near(item):
            self._state.say(f"Item {self.current} is too far away")
            return []
        state, command, first = self._state, item.command, item.params[0] if item.params[0] > 0 else 0.0
        end = state.target(item)
        if command in TAKEOFFS:
            return self._taking_off(item, end)
        if state.landed and command not in _NO_LIFT_NEEDED:  # PX4; ArduPilot refused it before
            lift = state.manoeuvres.take_off(max(end[2], state.body.altitude), state.lift_off)
            return [*lift, state.manoeuvres.leg(end, self.ground_speed), Wait(first)]
        if command in _PASSED:
            return [self._leg(end, passing=first == 0), *([Wait(first)] if first > 0 else [])]
        if command == Command.NAV_LOITER_UNLIM:
            return [self._leg(end), Wait()]
        if command == Command.NAV_LOITER_TIME:
            return [self._leg(end), Wait(first)]
        if command == Command.NAV_LOITER_TURNS:
            return state.manoeuvres.circle(end, first, item.params[2], self.ground_speed)
        if command == Command.NAV_DELAY:
            return [Wait(self._delay(item))]
        return self._ending(item, end)

    def _ending(self, item: StoredItem, end: Vector) -> list[Segment]:
        """Landings, the way home, and what is not flown."""
        state, make = self._state, self._state.manoeuvres
        level = (end[0], end[1], state.body.altitude)
        if item.command == Command.NAV_LOITER_TO_ALT:
            return [self._leg(level), *make.change_height(level, end[2])]
        if item.command in LANDINGS:
            return [] if state.landed else [self._leg(level), *make.land(level, self._touched)]
        if item.command == Command.NAV_RETURN_TO_LAUNCH:
            return [] if state.landed else make.return_to(state.home_place, self._touched)
        state.say(f"{command_name(item.command)} is not flown")
        return []

    def _taking_off(self, item: StoredItem, end: Vector) -> list[Segment]:
        """Straight up; PX4 then flies to the place that the item names."""
        state = self._state
        if not state.landed:
            return state.manoeuvres.change_height(state.body.place, end[2])
        moves = state.manoeuvres.take_off(end[2], state.lift_off)
        if state.firmware.takeoff_goes_to_place and math.dist(end[:2], state.body.place[:2]) > _APART:
            start = (state.body.east, state.body.north, end[2])
            moves.append(state.manoeuvres.leg(end, self.ground_speed, start=start))
        return moves

    def _leg(self, end: Vector, *, passing: bool = False) -> StraightSegment:
        """A leg at the commanded speed that ends at rest, or passes its end as fast as what follows lets it."""
        make = self._state.manoeuvres
        if not passing or self._state.body.place == end:
            return make.leg(end, self.ground_speed)
        vectors, paces = self._onward(end)
        return make.leg(end, self.ground_speed, exit_speed(vectors, paces, make.profile))

    def _onward(self, end: Vector) -> tuple[list[Vector], list[LegPace]]:
        """The leg to `end` and those after it, until the first that ends at rest."""
        place = self._state.body.place
        vectors, paces = [_difference(place, end)], [self._state.manoeuvres.pace(place, end, self.ground_speed)]
        items = self._items()
        for step in self._sequence.ahead(items, self.current + 1):
            item = items[step.seq or 0]
            if item.command not in _LEGS or not item.has_place:
                break
            place, end = end, self._state.target(item)
            if math.dist(place, end) < _APART:
                break
            vectors.append(_difference(place, end))
            paces.append(self._state.manoeuvres.pace(place, end, self.ground_speed))
            if item.command not in _PASSED or item.params[0] > 0 or len(vectors) == _FORESIGHT:
                break
        return vectors, paces

    def _do_pending(self) -> bool:
        """Do what is to be done on this leg, up to the first condition that does not hold yet."""
        items, repaced = self._items(), False
        while self._pending and self._pending[0] < len(items):
            item = items[self._pending[0]]
            if not self._holds(item):
                return repaced
            self._pending.popleft()
            repaced |= self._do(item)
        return repaced

    def _holds(self, item: StoredItem) -> bool:
        """Whether a condition holds; other items are none."""
        if item.command == Command.CONDITION_DELAY:
            if self._waited < item.params[0]:
                return False
            self._waited = 0.0
        if item.command == Command.CONDITION_DISTANCE:
            items = self._items()
            end = self._state.target(items[min(self.current, len(items) - 1)])
            return math.dist(end[:2], self._state.body.place[:2]) <= item.params[0]
        return True

    def _do(self, item: StoredItem) -> bool:
        """Do what takes no time; whether it changes the pace."""
        state = self._state
        if item.command == Command.DO_CHANGE_SPEED:
            return self.change_speed(item.params[0], item.params[1])
        if item.command == Command.DO_SET_HOME and state.is_near(item):
            east, north, altitude = state.body.place if item.params[0] == 1 else state.target(item)
            state.home = Home(state.geographic(east, north), altitude)
        return False

    def change_speed(self, kind: float, speed: float) -> bool:
        """DO_CHANGE_SPEED as measured: 0 and 1 set the ground speed, 2 climb, 3 descent; nothing unless positive."""
        if not 0 < speed < math.inf or kind not in (0, 1, 2, 3):
            return False
        if kind in (0, 1):
            self.ground_speed = speed
        else:
            rate = "climb" if kind == 2 else "descent"
            self._state.profile = replace(self._state.profile, **{rate: speed})
        return True

    def _delay(self, item: StoredItem) -> float:
        """NAV_DELAY's seconds, or those until the next time of day that it names."""
        if item.params[0] > 0:
            return item.params[0]
        now = (self._state.world.departure or datetime.now(UTC)) + timedelta(seconds=self._state.body.clock)
        since_midnight = (now.hour * 60 + now.minute) * 60 + now.second
        times = itertools.product(*map(_times, item.params[1:], (24, 60, 60)))
        waits = (((h * 60 + m) * 60 + s - since_midnight) % 86_400 for h, m, s in times)
        return float(min(waits, default=0))


def _times(wished: float, count: int) -> Sequence[int]:
    """The hours, minutes or seconds that are meant: -1 is any of them."""
    return range(count) if wished == -1 else [int(wished)] if 0 <= wished < count else []


def _difference(start: Vector, end: Vector) -> Vector:
    return end[0] - start[0], end[1] - start[1], end[2] - start[2]

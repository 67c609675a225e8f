"""The stand-in's flight as the clock moves on: kinematics, with no dynamics and no estimation behind it."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence

from gcs_windplan.mission import Home
from gcs_windplan.mission.firmware import Activity, Firmware
from gcs_windplan.standin.items import StoredItem
from gcs_windplan.standin.mission_run import MissionRun
from gcs_windplan.standin.motion import Segment, StraightSegment, Wait
from gcs_windplan.standin.pace import Vector
from gcs_windplan.standin.vehicle_state import REACH, Reached, VehicleState
from gcs_windplan.standin.world import World
from gcs_windplan.vehicle import MotionProfile

_MOST_IDLE = 1000  # a mission that goes round without flying must not hold up the clock
_LOOK = 0.5  # [s] so often a condition on a leg is looked at


class SimulatedFlight:
    """Moves a vehicle on. What can be refused returns the reason, or None.

    `items` gives the vehicle's mission as it is held right now.
    """

    def __init__(
        self, firmware: Firmware, profile: MotionProfile, world: World, items: Callable[[], Sequence[StoredItem]]
    ) -> None:
        self.state = VehicleState(firmware, profile, world)
        self.run = MissionRun(self.state, items, self._touched)
        self.activity: Activity = "hold"
        self._items = items
        self._moves: deque[Segment] = deque()
        self._under_way = False

    @property
    def flies_mission(self) -> bool:
        """Whether the mission is being flown."""
        return self.activity == "mission" and self._under_way

    @property
    def current(self) -> int:
        """The item that is flown, or would be flown next."""
        return self.run.current

    @property
    def home_item(self) -> StoredItem:
        """Home as ArduPilot's item 0."""
        return self.state.home_item

    @property
    def leg_end(self) -> Vector | None:
        """Where the present leg ends: east, north, altitude AMSL [m]."""
        move = self._moves[0] if self._moves else None
        return move.end if isinstance(move, StraightSegment) else None

    def arm(self) -> str | None:
        """Start the motors. Where the mission is to be flown it begins at once."""
        if self.state.armed:
            return None
        fault = self.run.fault() if self.activity == "mission" else None
        if fault is not None:
            return fault
        body = self.state.body
        self.state.armed = True
        self.state.home = Home(self.state.point, body.altitude)
        body.clock = 0.0
        if self.activity == "mission":
            self._begin_mission()
        return None

    def disarm(self, *, force: bool = False) -> str | None:
        """Stop the motors: on the ground, or by force."""
        state = self.state
        if not state.landed:
            if not force:
                return "it is flying"
            state.say("Disarmed in the air: it fell")
            state.body.altitude = state.ground(state.body.east, state.body.north)
            state.landed = True
        state.body.stand()
        state.armed = self._under_way = False
        self._moves.clear()
        self.run.forget()
        return None

    def fly_mission(self) -> str | None:
        """Fly the mission, from where it was left or from its beginning; once armed, if it is not."""
        if self.flies_mission and not self.run.complete:
            return None
        fault = self.run.fault()
        if fault is not None:
            return fault
        self.activity = "mission"
        if self.state.armed:
            self._begin_mission()
        return None

    def take_off(self, altitude: float) -> str | None:
        """Up to an altitude [m] AMSL, and stay there."""
        if not self.state.armed:
            return "it is not armed"
        if not self.state.landed:
            return "it is flying already"
        self._do("guided", [*self.state.manoeuvres.take_off(altitude, self.state.lift_off), Wait()])
        return None

    def go_to(self, end: Vector) -> str | None:
        """Straight to a place (east, north, altitude), and stay there."""
        if self.state.landed:
            return "it stands on the ground"
        if math.hypot(*end[:2]) > REACH or not math.isfinite(end[2]):
            return "that is too far away"
        self._do("guided", [self.state.manoeuvres.leg(end, self.run.ground_speed), Wait()])
        return None

    def fly_there(self, item: StoredItem) -> bool:
        """Fly to an item's place, or its altitude, at once; only where guidance is waited for."""
        if self.activity != "guided":
            return False
        return self.go_to(self.state.target(item)) is None

    def stay(self, activity: Activity = "hold") -> None:
        """Stay where it is, waiting for guidance or not."""
        self._do(activity, [] if self.state.landed else self.state.manoeuvres.stop())

    def return_home(self) -> None:
        """Fly home and land."""
        state = self.state
        self._do("return", [] if state.landed else state.manoeuvres.return_to(state.home_place, self._touched))

    def land(self) -> None:
        """Land where it is."""
        state = self.state
        self._do("land", [] if state.landed else state.manoeuvres.land(state.body.place, self._touched))

    def jump(self, seq: int) -> bool:
        """Go on with an item, now or when the mission is flown next; False where there is none."""
        if not 0 <= seq < len(self._items()):
            return False
        if self.flies_mission:
            self._moves = deque(self.run.jump(seq))
        else:
            self.run.aim(seq)
        return True

    def change_speed(self, kind: float, speed: float) -> bool:
        """Command a ground speed (0, 1), climb (2) or descent (3) [m/s]; whether it was one."""
        changed = self.run.change_speed(kind, speed)
        if changed:
            self._repace()
        return changed

    def mission_changed(self) -> None:
        """Another mission is held: begin it from its beginning, unless one is being flown."""
        if not self.flies_mission:
            self.run.forget()

    def settle(self, world: World) -> None:
        """Stand somewhere else."""
        self.state.settle(world)
        self._moves.clear()

    def advance(self, seconds: float) -> None:
        """Let time pass."""
        idle = 0  # items in a row that took no time
        while seconds > 0:
            if self._moves:
                used = self._move(seconds)
                seconds, idle = seconds - used, 0 if used > 0 else idle
            elif self.flies_mission and not self.run.complete and idle < _MOST_IDLE:
                self._moves = deque(self.run.proceed())
                idle += 1
            else:
                self.state.body.stand()
                self.state.body.clock += seconds
                return

    def _move(self, seconds: float) -> float:
        """Go on with the present move, and how long that took."""
        move = self._moves[0]
        waits = self.flies_mission and self.run.waits_for_condition
        time = min(seconds, _LOOK) if waits else seconds
        used = time - move.advance(self.state.body, time)
        if move.done and self._moves and self._moves[0] is move:
            self._moves.popleft()
        if waits and self.run.wait(used):
            self._repace()
        return used

    def _repace(self) -> None:
        """Fly the rest of the leg at the commanded speed as it is now."""
        if self.flies_mission and self._moves and isinstance(self._moves[0], StraightSegment):
            self._moves[0] = self.run.repaced(self._moves[0])

    def _begin_mission(self) -> None:
        self._under_way = True
        self._moves = deque(self.run.begin())

    def _do(self, activity: Activity, moves: list[Segment]) -> None:
        self.activity, self._under_way = activity, False
        self._moves = deque(moves)

    def _touched(self) -> None:
        """The state stands on the ground: the motors stop, unless the mission takes off again."""
        self.state.landed = True
        self.state.say("Landed")
        if self.flies_mission:
            if self.run.next_is_takeoff():
                return
            self.state.events.append(Reached(self.run.current))
        self.disarm()

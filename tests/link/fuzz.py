"""Random uploads over bad links to scripted autopilots, in simulated time: is "accepted" ever a lie?

    python -m tests.link.fuzz --runs 2000

Each run draws a profile, a mission, fence or rally points, a link (loss up to 40 %, duplication, reordering,
corruption, garbage, delay), and now and then a second ground station that uploads something else, a vehicle that
reboots, one that is full, and one that quietly stores something else than it was sent.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import random
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.link.peer import Ident, Peer
from gcs_windplan.link.session import OWN, Session
from gcs_windplan.link.verified import TransferPart, push_items
from gcs_windplan.link.wire import MISSION_TYPES
from gcs_windplan.mission import Command, Frame, MissionItem, takes_place
from gcs_windplan.mission.firmware import MissionType

from .autopilots import Autopilot, OtherStation, Refused, Stored
from .bench import PROFILES, expected, same
from .simulation import Faults, SimulatedTransport, World

_PLACES = (Command.NAV_WAYPOINT, Command.NAV_TAKEOFF, Command.NAV_LAND, Command.NAV_LOITER_TIME)
_OTHERS = (Command.NAV_RETURN_TO_LAUNCH, Command.DO_CHANGE_SPEED, Command.NAV_DELAY)


@dataclass(frozen=True, slots=True)
class Run:
    """How one upload ended, and whether what it claims is true."""

    seed: int
    profile: str
    kind: MissionType
    items: int
    part: TransferPart
    falsely: bool
    overwritten: bool
    bounded: bool

    @property
    def verdict(self) -> str:
        return self.part.outcome.verdict


def run(seed: int, verify: bool = True) -> Run:
    """One upload; everything about it follows from the seed."""
    rng = random.Random(seed)
    profile = rng.choice(list(PROFILES))
    kind: MissionType = rng.choices(("mission", "fence", "rally"), (8, 1, 1))[0]
    world = World(seed, Faults())
    vehicle = PROFILES[profile](world)
    session = Session(SimulatedTransport(world), clock=world.clock)
    vehicle.keep(MISSION_TYPES[kind], _before(rng, profile, kind))
    items = random_items(rng, profile, kind)
    world.faults = random_faults(rng)
    _trouble(rng, world, vehicle, kind)
    autopilot = "ardupilot" if profile == "ardupilot" else "px4"
    start = world.now
    part = push_items(session, Peer(Ident(1, 1), autopilot, "multicopter"), kind, items, verify=verify)
    bounded = world.now - start < 300 + 12 * len(items)
    held_it, holds_it = _truth(vehicle, kind, items, start)
    accepted = part.outcome.verdict == "accepted"
    # somebody may overwrite the mission after it was read back; before, it must have been there whole
    return Run(seed, profile, kind, len(items), part, accepted and not held_it, accepted and not holds_it, bounded)


def _truth(vehicle: Autopilot, kind: MissionType, items: tuple[MissionItem, ...], start: float) -> tuple[bool, bool]:
    """Whether the vehicle held exactly the items at a time since the start, and whether it does now."""
    number = MISSION_TYPES[kind]
    try:
        wanted = expected(type(vehicle), items, number)
    except Refused:
        return False, False
    snapshots = [list(held) for when, which, held in vehicle.history if which == number and when >= start]
    return any(same(held, wanted) for held in snapshots), same(vehicle.listed(number), wanted)


def random_faults(rng: random.Random) -> Faults:
    return Faults(
        loss=rng.choice((0.0, rng.uniform(0, 0.4))),
        duplication=rng.choice((0.0, rng.random(), 1.0)),
        corruption=rng.choice((0.0, rng.uniform(0, 0.2))),
        garbage=rng.choice((0.0, rng.uniform(0, 0.3))),
        delay=rng.uniform(0.001, 0.15),
        jitter=rng.choice((0.0, rng.uniform(0, 0.3))),
        late=rng.choice((0.0, rng.uniform(0, 0.3))),
        lateness=rng.uniform(0, 4),
    )


def random_items(rng: random.Random, profile: str, kind: MissionType) -> tuple[MissionItem, ...]:
    """A mission (with home for ArduPilot), fence or rally points as they travel; seldom with something refused."""
    count = rng.choice((1, 2, rng.randint(3, 15)))
    if kind == "fence":
        return tuple(
            MissionItem(0, Command.NAV_FENCE_CIRCLE_INCLUSION, (rng.uniform(5, 900), 0, 0, 0), *_place(rng))
            for _ in range(count)
        )
    if kind == "rally":
        return tuple(
            MissionItem(3, Command.NAV_RALLY_POINT, (0, 0, 0, 0), *_place(rng), rng.uniform(5, 300))
            for _ in range(count)
        )
    home = [MissionItem(0, Command.NAV_WAYPOINT, (0, 0, 0, 0), *_place(rng), 500.0)] if profile == "ardupilot" else []
    return (*home, *(_mission_item(rng, profile) for _ in range(count)))


def _place(rng: random.Random) -> tuple[float, float]:
    return rng.uniform(-80, 80), rng.uniform(-179, 179)


def _mission_item(rng: random.Random, profile: str) -> MissionItem:
    command = rng.choice((*_PLACES, *_PLACES, *_OTHERS))
    bad = rng.random() < 0.01
    if not takes_place(command):
        first, throttle = float(rng.randint(0, 3)), -1.0 if command == Command.DO_CHANGE_SPEED else 0.0
        frame = Frame.GLOBAL if profile == "ardupilot" else Frame.MISSION
        params = (math.nan if bad else first, rng.choice((0.0, float(rng.randint(0, 20)))), throttle, 0.0)
        return MissionItem(frame, command, params if command != Command.NAV_RETURN_TO_LAUNCH else (0, 0, 0, 0))
    hold = float(rng.randint(0, 60))
    yaw = rng.choice((0.0, math.nan if profile == "px4" else 0.0, rng.uniform(0, 359)))
    if profile == "px4" and command != Command.NAV_WAYPOINT:
        hold = 0.0
    frame = 7 if bad else rng.choice((Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT))
    latitude, longitude = _place(rng)
    if bad:  # a frame without degrees, in which only whole numbers travel
        latitude, longitude = float(round(latitude)), float(round(longitude))
    return MissionItem(frame, command, (hold, 0.0, 0.0, yaw), latitude, longitude, rng.uniform(-50, 4000))


def _before(rng: random.Random, profile: str, kind: MissionType) -> list[Stored]:
    """What the vehicle holds before."""
    count = rng.choice((0, 3, 20))
    return [Stored(16, 3, (0.0,) * 4, 100 + seq, 200 + seq, 10.0) for seq in range(count)]


def _trouble(rng: random.Random, world: World, vehicle: Autopilot, kind: MissionType) -> None:
    """What else may go wrong."""
    if rng.random() < 0.2:
        ident = (254, 190) if rng.random() < 0.8 else tuple(OWN)
        others = [Stored(16, 3, (0.0,) * 4, rng.randint(1, 10**8), 7, 30.0) for _ in range(rng.randint(1, 12))]
        other = OtherStation(world, others, ident)
        world.at(world.now + rng.uniform(-0.5, 6), other.start)
    if rng.random() < 0.15:
        off = rng.choice((0.1, rng.uniform(0, 10)))
        world.at(world.now + rng.uniform(0, 6), lambda: vehicle.reboot(off))
    if rng.random() < 0.03:
        vehicle.capacity = rng.randint(0, 5)
    if rng.random() < 0.1:
        _make_fickle(rng, vehicle, MISSION_TYPES[kind])


def _make_fickle(rng: random.Random, vehicle: Autopilot, kind: int) -> None:
    """The vehicle will change a number of an item just before it accepts."""
    change = rng.choice(({"x": 3}, {"y": -7}, {"z": 77.25}, {"command": 17}, None))

    def spoil(message: object) -> list[object]:
        held = vehicle.held[kind]
        is_ack = isinstance(message, mavlink.MAVLink_mission_ack_message) and message.type == 0
        if is_ack and len(held) > 1:
            place = rng.randrange(1, len(held))
            if change is None:
                del held[place]
            else:
                held[place] = dataclasses.replace(held[place], **change)
            # a snapshot of the right mission may stand in the book, but it was never acknowledged
            vehicle.history[:] = [entry for entry in vehicle.history if entry[1] != kind]
            vehicle.note(kind)
        return [message]

    vehicle.mouth.append(spoil)


def table(runs: Iterable[Run]) -> str:
    """Runs, accepted, rejected, unknown and falsely accepted, by profile and in all."""
    everything = list(runs)
    lines = [f"{'profile':<12}{'runs':>7}{'accepted':>10}{'rejected':>10}{'unknown':>9}{'falsely accepted':>18}"]
    for name in (*PROFILES, "all"):
        group = [each for each in everything if name in (each.profile, "all")]
        verdicts = Counter(each.verdict for each in group)
        falsely = sum(each.falsely for each in group)
        counts = (len(group), verdicts["accepted"], verdicts["rejected"], verdicts["unknown"], falsely)
        lines.append("{:<12}{:>7}{:>10}{:>10}{:>9}{:>18}".format(name, *counts))
    reasons = Counter(f"{each.verdict}: {each.part.outcome.reason}" for each in everything)
    lines += ["", *(f"{count:>7}  {reason}" for reason, count in reasons.most_common())]
    seconds = [each.part.seconds for each in everything]
    overwritten = sum(each.overwritten for each in everything)
    lines += ["", f"{overwritten:>7}  accepted, read back, and then overwritten by the other station"]
    lines += [f"longest run {max(seconds):.0f} simulated seconds, all of them {sum(seconds) / 3600:.1f} hours"]
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0, help="of the first run; each next one has the next")
    options = parser.parse_args()
    start = time.perf_counter()
    runs = [run(seed) for seed in range(options.seed, options.seed + options.runs)]
    print(table(runs))
    print(f"in {time.perf_counter() - start:.1f} s")
    for bad in (each for each in runs if each.falsely or not each.bounded):
        print(f"seed {bad.seed}: {bad.part.outcome}, {bad.part.seconds:.1f} s")


if __name__ == "__main__":
    main()

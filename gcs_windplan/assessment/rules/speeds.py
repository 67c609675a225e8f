"""Rules of what the vehicle can do: make headway, hold the speed commanded, climb as steeply as asked."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment.assessment import AssessedLeg
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.flown import commands_of
from gcs_windplan.assessment.known import known_wind
from gcs_windplan.assessment.motion import density_at, motion_in
from gcs_windplan.assessment.rules.places import Found, on_leg, runs
from gcs_windplan.assessment.rules.wind import severity_in
from gcs_windplan.vehicle import SEA_LEVEL_DENSITY, FixedWing

_SLACK = 0.02  # [m/s] what rounding of commanded speeds may have added
_WORTH_SAYING = 0.05  # of the largest airspeed, by which a commanded speed misses it: 5 % of a leg's time at most
_OVER_STALL = 1.2  # the usual margin, that of V2 in CS-23
_ROUNDING = 1e-6
_PASSED = 2.0  # [m] a shorter leg ends within the waypoint's radius (ArduCopter's default of WPNAV_RADIUS)


def flyable(mission: AssessedMission) -> Iterator[Found]:
    """Legs on which the wind stops the vehicle."""
    flown, case = mission.flown, mission.case
    first = flown.samples.first
    for leg, move in zip(mission.legs, mission.track.leg_moves, strict=True):
        if not flown.stopped[move]:
            continue
        part = slice(int(first[move]), int(first[move + 1]))
        blowing = np.hypot(*flown.wind.filled[part, :2].T)
        stopped = np.flatnonzero(flown.motion.stopped[part])
        worst = int(stopped[np.argmax(blowing[stopped])]) if len(stopped) else int(np.argmax(blowing))
        yield on_leg(
            mission, leg, "flyable", "danger", at=flown.samples.places[part][worst], value=float(blowing[worst]),
            limit=case.fastest, unit="m/s",
        )  # fmt: skip


def flyable_in_members(mission: AssessedMission) -> Iterator[Found]:
    """Legs on which the wind stops the vehicle in members of an ensemble, though not in their mean."""
    stopped, members = _stopped_in_members(mission), len(mission.case.scene.members)
    for first, last in runs([bool(count) for count in stopped]):
        worst = first + int(np.argmax(stopped[first : last + 1]))
        leg, count = mission.legs[worst], int(stopped[worst])
        yield on_leg(
            mission, leg, "flyable", severity_in(count, members, mission.case.robust), value=float(count),
            limit=(1 - mission.case.robust) * members, unit="members", members=members, airspeed=mission.case.fastest,
            first_leg=first + 1, last_leg=last + 1,
        )  # fmt: skip


def _stopped_in_members(mission: AssessedMission) -> FloatArray:
    """In how many members each leg cannot be flown (legs,); 0 for one that the mean wind stops already."""
    flown, case, samples = mission.flown, mission.case, mission.flown.samples
    command = commands_of(flown.track, samples.move, samples.direction, flown.peaks, case)
    counts = np.zeros(len(mission.track.moves))
    for field in case.scene.members:
        winds = known_wind(field, samples.places, flown.passed).filled
        counts += samples.sums(motion_in(winds, command, case).stopped.astype(np.float64)) > 0
    return np.asarray(np.where(flown.stopped > 0, 0.0, counts)[mission.track.leg_moves])


def stall(mission: AssessedMission) -> Iterator[Found]:
    """Legs of a fixed-wing near its stall, or below; one finding for all in a row, where it is nearest."""
    case, flown = mission.case, mission.flown
    power = None if case.airframe is None else case.airframe.power
    if case.hovers or not isinstance(power, FixedWing) or power.stall_airspeed <= 0:
        return
    samples = flown.samples
    stalls = power.stall_airspeed * np.sqrt(SEA_LEVEL_DENSITY / density_at(samples.places[:, 2]))
    shares, first_of = flown.motion.air / stalls, samples.first
    nearest = [int(first_of[m] + np.argmin(shares[first_of[m] : first_of[m + 1]])) for m in mission.track.leg_moves]
    for first, last in runs([bool(shares[i] < _OVER_STALL - _ROUNDING) for i in nearest]):
        worst = first + int(np.argmin(shares[nearest[first : last + 1]]))
        leg, at = mission.legs[worst], nearest[worst]
        air, least = float(flown.motion.air[at]), float(stalls[at])
        yield on_leg(
            mission, leg, "stall", "danger" if air < least else "warning", at=samples.places[at], value=air,
            limit=_OVER_STALL * least, unit="m/s", stall=least, first_leg=first + 1, last_leg=last + 1,
        )  # fmt: skip


def airspeed(mission: AssessedMission) -> Iterator[Found]:
    """Legs whose commanded speed takes more airspeed than there is: one finding for all, where it is worst."""
    case, flown = mission.case, mission.flown
    first = flown.samples.first
    short: list[tuple[float, AssessedLeg, FloatArray]] = []
    for leg, move in zip(mission.legs, mission.track.leg_moves, strict=True):
        if flown.stopped[move] or leg.distance < _PASSED:
            continue
        part = slice(int(first[move]), int(first[move + 1]))
        needed = _needed(mission, int(move), part)
        worst = int(np.argmax(needed))
        if needed[worst] > case.fastest * (1 + _WORTH_SAYING):
            short.append((float(needed[worst]), leg, flown.samples.places[part][worst]))
    if not short:
        return
    most, leg, place = max(short, key=lambda one: one[0])
    yield on_leg(
        mission, leg, "airspeed", "warning", at=place, value=most, limit=case.fastest, unit="m/s", others=len(short) - 1
    )


def gradient(mission: AssessedMission) -> Iterator[Found]:
    """Legs that climb or descend faster than the vehicle can."""
    case, flown = mission.case, mission.flown
    for leg, move in zip(mission.legs, mission.track.leg_moves, strict=True):
        limit = case.limits.climb if leg.climb > 0 else case.limits.descent
        moving = float(flown.moving[move])
        if limit is None or flown.stopped[move] or moving <= 0 or leg.distance <= 0:
            continue
        rate = abs(leg.climb) / moving
        if rate <= limit + _SLACK:
            continue
        yield on_leg(
            mission, leg, "gradient", "warning" if case.hovers else "danger", value=rate, limit=limit, unit="m/s",
            climb=leg.climb, distance=leg.distance, distance_needed=abs(leg.climb) / limit * leg.ground_speed,
            hovers=case.hovers,
        )  # fmt: skip


def _needed(mission: AssessedMission, move: int, part: slice) -> FloatArray:
    """The airspeed that the commanded speed takes at a move's samples [m/s]."""
    case, motion = mission.case, mission.flown.motion
    if not case.hovers:
        return np.asarray(motion.needed[part])
    told = mission.track.moves[move].told
    wanted = case.pace.speed if told.ground is None else told.ground
    direction = mission.flown.samples.direction[part]
    level = np.hypot(direction[:, 0], direction[:, 1])
    rising = np.abs(direction[:, 2])
    up = case.pace.climb if told.climb is None else told.climb
    down = case.pace.descent if told.descent is None else told.descent
    rate = np.where(direction[:, 2] > 0, up, down)
    with np.errstate(divide="ignore"):
        ground = np.minimum(wanted, np.where(rising > 1e-9, rate / rising, np.inf) * level)
    return np.asarray(np.hypot(ground - motion.along[part], motion.across[part]))

"""The ways home from every stop, and to the nearest rally point: what they take in the wind, and what they clear."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.assessment.assessment import Stop
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.known import known_wind
from gcs_windplan.assessment.motion import MotionCommand, energy, motion_in, waiting_watts, watts
from gcs_windplan.assessment.track import return_altitude
from gcs_windplan.mission import Frame, RallyPoint
from gcs_windplan.vehicle.pace import landing_seconds, ramp_seconds

_SAMPLES = 12  # of the wind on each way
_NO_WAY = 1.0  # [m] shorter than this it is there already


@dataclass(frozen=True, slots=True, eq=False)
class WaysBack:
    """The straight ways back from n stops, each (n,): up, level over, down.

    `altitudes` AMSL at which they are flown level, `clearance` the smallest height above ground there [m], NaN over
    unknown ground; `seconds` are infinite where the wind is too strong. `energies` [J] at a height that clears the
    ground, None where the airframe is not known.
    """

    altitudes: FloatArray
    clearance: FloatArray
    seconds: FloatArray
    energies: FloatArray | None


def ways_home(stops: Sequence[Stop], home: Sequence[float], case: Case) -> WaysBack:
    """The ways from stops to home (east, north, AMSL), at the height that the autopilot returns at."""
    altitudes = np.array([return_altitude(stop.altitude, home[2], case) for stop in stops])
    targets = np.tile(np.asarray(home, dtype=np.float64), (len(stops), 1))
    return _ways(stops, targets, altitudes, case)


def ways_to_rally(stops: Sequence[Stop], home: Sequence[float], case: Case) -> WaysBack | None:
    """The ways from stops to the rally point nearest to each, None without any."""
    rally = case.mission.rally
    if not rally:
        return None
    places = np.array([_rally_place(point, home[2], case) for point in rally])
    here = np.array([(stop.east, stop.north) for stop in stops])
    nearest = np.argmin(np.hypot(*(here[:, None] - places[None, :, :2]).transpose(2, 0, 1)), axis=1)
    heights = places[nearest, 2]
    altitudes = np.maximum([stop.altitude for stop in stops], heights)
    targets = places[nearest]
    ground = case.scene.terrain.heights_at(targets)
    targets[:, 2] = np.where(np.isfinite(ground), ground, home[2])
    return _ways(stops, targets, altitudes, case)


def with_energies(stops: Sequence[Stop], home: WaysBack, rally: WaysBack | None) -> tuple[Stop, ...]:
    """The stops with what their ways back take."""
    found = []
    for i, stop in enumerate(stops):
        back = None if home.energies is None else float(home.energies[i])
        aside = None if rally is None or rally.energies is None else float(rally.energies[i])
        found.append(replace(stop, return_energy=back, diversion_energy=aside))
    return tuple(found)


def _rally_place(rally: RallyPoint, home: float, case: Case) -> tuple[float, float, float]:
    east, north = case.scene.frame.to_local(rally.point.latitude_deg, rally.point.longitude_deg)[0]
    ground = float(case.scene.terrain.heights_at(np.array([[east, north]]))[0])
    datum = {Frame.GLOBAL: 0.0, Frame.GLOBAL_TERRAIN_ALT: home if math.isnan(ground) else ground}
    return float(east), float(north), datum.get(Frame(rally.frame), home) + rally.altitude


def _ways(stops: Sequence[Stop], targets: FloatArray, altitudes: FloatArray, case: Case) -> WaysBack:
    """The ways from stops to targets (n, 3) on the ground, level at altitudes (n,)."""
    here = np.array([(stop.east, stop.north, stop.altitude) for stop in stops])
    starts, ends = (np.column_stack([place[:, :2], altitudes]) for place in (here, targets))
    clearance = case.scene.terrain.leg_heights(np.ascontiguousarray(starts), np.ascontiguousarray(ends))[:, 0]
    safe = altitudes + np.maximum(-np.nan_to_num(clearance), 0.0)
    starts[:, 2] = ends[:, 2] = safe
    level = _flown_level(starts, ends, np.array([stop.seconds for stop in stops]), case)
    up = np.maximum(safe - here[:, 2], 0.0) / case.pace.climb
    down = np.maximum(safe - targets[:, 2], 0.0)
    landing = np.array([landing_seconds(height, case.pace) for height in down]) if case.hovers else 0 * down
    hover = case.pace.return_hover if case.hovers else 0.0
    seconds = np.where(level.stopped, np.inf, up + level.seconds + hover + landing)
    if level.watts is None:
        return WaysBack(altitudes, clearance, seconds, None)
    upright = _flown_upright(level, safe, np.where(landing > 0, -down / np.maximum(landing, 1e-9), 0.0), case)
    parts = energy(upright, np.column_stack([up, 0 * up + hover, landing]))
    energies = energy(level.watts, level.seconds) + parts.sum(axis=1)
    return WaysBack(altitudes, clearance, seconds, np.where(level.stopped, np.inf, energies))


@dataclass(frozen=True, slots=True, eq=False)
class _Level:
    """The level parts of n ways: `seconds`, `watts` in the mean, whether wind stops them, and winds at their ends."""

    seconds: FloatArray
    watts: FloatArray | None
    stopped: BoolArray
    first: FloatArray
    last: FloatArray


def _flown_level(starts: FloatArray, ends: FloatArray, begins: FloatArray, case: Case) -> _Level:
    """Level flight from places to places (n, 3), begun at `begins` (n,) [s since departure]."""
    vectors = ends - starts
    lengths = np.hypot(vectors[:, 0], vectors[:, 1])
    speed = case.pace.speed if case.hovers else case.cruise
    share = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    when = begins[:, None] + share * lengths[:, None] / speed
    places = (starts[:, None] + share[None, :, None] * vectors[:, None]).reshape(-1, 3)
    winds = known_wind(case.scene.wind, places, when.ravel()).filled
    direction = np.repeat(vectors / np.maximum(lengths, 1e-9)[:, None], _SAMPLES, axis=0)
    count = len(places)
    command = MotionCommand(direction, np.full(count, speed), np.zeros(count), np.full(count, case.cruise))
    motion = motion_in(winds, command, case)
    stopped = motion.stopped.reshape(-1, _SAMPLES).any(axis=1) & (lengths > _NO_WAY)
    parts = (lengths[:, None] / _SAMPLES) / np.maximum(motion.speed, 0.01).reshape(-1, _SAMPLES)
    ramp = ramp_seconds(speed, case.pace.acceleration, case.pace.jerk, case.pace.rise) if case.hovers else 0.0
    power = watts(motion, places[:, 2], case)
    weights = parts / np.maximum(parts.sum(axis=1), 1e-9)[:, None]
    mean = None if power is None else energy(power.reshape(-1, _SAMPLES), weights).sum(axis=1)
    seconds = parts.sum(axis=1) + np.where(lengths > _NO_WAY, ramp, 0.0)
    return _Level(seconds, mean, stopped, winds[::_SAMPLES], winds[_SAMPLES - 1 :: _SAMPLES])


def _flown_upright(level: _Level, altitudes: FloatArray, sinking: FloatArray, case: Case) -> FloatArray:
    """The power for climbing at the begin, waiting at the end, and descending there at -`sinking` [m/s] (n, 3) [W]."""
    rising = np.full(len(altitudes), case.pace.climb)
    powers = [
        waiting_watts(winds, altitudes, climb, case)
        for winds, climb in ((level.first, rising), (level.last, 0 * rising), (level.last, sinking))
    ]
    return np.column_stack([power for power in powers if power is not None])

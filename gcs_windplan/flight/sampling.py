"""The wind along legs: integrals by Simpson's rule, in panels that resolve the field and are halved where it changes
fast.

At a jump in the wind (the edge of a jet, a front) the panels around it are halved until they are a thousandth of their
first length, so that a leg's time depends smoothly on where it crosses the jump. Without that, shaping would get stuck
there: each vertex would sit in a dent of the quadrature's own making.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.flight.wind_limits import NO_LIMITS, WindLimits
from gcs_windplan.kernels.panels import Panels, halves_of, knots_of, panels_of, parted, places_along, samples_of
from gcs_windplan.kernels.triangle import PAPER, TRIANGLE, Performance, integrate_legs
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind.each import at_each
from gcs_windplan.wind.field import WindField

_Result = TypeVar("_Result")

_MOST_PANELS: Final = 512  # of a leg, before any is halved
_HALVINGS: Final = 10
_MOST_ROUNDS: Final = 12  # of putting the clock in again: each gains a factor of 10 and more
_SAME_TIME: Final = 1e-3  # [s]
_SHORT: Final = 0.03  # of the time between two of the wind's: on legs so short the clock runs evenly
_HOURS: Final = 12  # parts of a longer leg on each of which it does
_TURNS: Final = 6  # of finding out how, and a change that needs no further one
_SAME_FACE: Final = 1e-3
_CALM: Final = 0.01  # of the airspeed: a change of wind over half a panel that needs no halving


@dataclass(frozen=True, slots=True, eq=False)
class LegIntegrals:
    """What wind does along n legs, each (n,): seconds, ∫angle ds [rad m], mean wind along and across [m/s].

    `seconds` is infinite where a leg cannot be flown. Across is positive from left to right.
    """

    seconds: FloatArray
    angle: FloatArray
    along: FloatArray
    across: FloatArray


def performance_of(vehicle: Vehicle) -> Performance:
    """The vehicle as the kernels take it."""
    model = PAPER if vehicle.speed_model == "paper" else TRIANGLE
    airspeed, climb, descent = float(vehicle.airspeed), float(vehicle.climb), float(vehicle.descent)
    return Performance(model, airspeed, climb, descent, float(vehicle.hovers))


def integrate(
    wind: WindField,
    vehicle: Vehicle,
    starts: FloatArray,
    ends: FloatArray,
    when: FloatArray | None = None,
    *,
    airspeeds: FloatArray | None = None,
) -> LegIntegrals:
    """Integrate along straight legs (n, 3), each flown at the vehicle's airspeed or at its own of `airspeeds` (n,).

    `when` (n, 2) is at what time each leg begins and ends [s since departure]; on a leg that is long beside the wind's
    changes the clock runs in between as the wind lets the vehicle go. Without it the wind is taken as at the departure.
    A leg that lasts beyond the last time of a changing wind cannot be flown.
    """
    return integrate_each((wind,), vehicle, starts, ends, when, airspeeds=airspeeds)[0]


def integrate_each(
    winds: Sequence[WindField],
    vehicle: Vehicle,
    starts: FloatArray,
    ends: FloatArray,
    when: FloatArray | None = None,
    *,
    finer: float = 1.0,
    airspeeds: FloatArray | None = None,
    limits: WindLimits = NO_LIMITS,
) -> list[LegIntegrals]:
    """The same in each of several winds, the members of an ensemble, with samples `finer` times as close.

    Where a wind is beyond the `limits` a leg cannot be flown in it.
    """
    legs = sample_legs(winds, vehicle, starts, ends, when, finer=finer, limits=limits)
    speeds = np.full(len(starts), float(vehicle.airspeed)) if airspeeds is None else airspeeds
    tables = [
        integrate_legs(legs.performance, speeds, legs.vectors, legs.first, legs.weights, blows) for blows in legs.winds
    ]
    return [LegIntegrals(legs.in_time(table[:, 0]), table[:, 1], table[:, 2], table[:, 3]) for table in tables]


@dataclass(frozen=True, slots=True, eq=False)
class SampledLegs:
    """The wind along n legs, in one or several members.

    `vectors` (n, 3) [m]; leg i owns the samples first[i] .. first[i + 1] - 1, which lie at `shares` of it, with
    `weights` that sum to 1 and `winds` in each member: (k, 3), or (k, 4) with their shares of the limits if there are
    any. `begins` (n,) is when the legs begin and `last` when the forecast ends [s since departure].
    """

    performance: Performance
    vectors: FloatArray
    first: IntArray
    weights: FloatArray
    shares: FloatArray
    winds: list[FloatArray]
    begins: FloatArray | None
    last: float

    def in_time(self, seconds: FloatArray) -> FloatArray:
        """The legs' seconds (n,) or (n, k), infinite where a leg lasts beyond the forecast."""
        if self.begins is None:
            return seconds
        begins = self.begins if seconds.ndim == 1 else self.begins[:, None]
        return np.where(begins + seconds <= self.last, seconds, np.inf)


def sample_legs(
    winds: Sequence[WindField],
    vehicle: Vehicle,
    starts: FloatArray,
    ends: FloatArray,
    when: FloatArray | None = None,
    *,
    finer: float = 1.0,
    limits: WindLimits = NO_LIMITS,
) -> SampledLegs:
    """The winds along straight legs (n, 3), looked at `finer` times as closely as their resolution asks for."""
    starts = np.ascontiguousarray(starts, dtype=np.float64)
    vectors = np.ascontiguousarray(ends - starts, dtype=np.float64)
    lengths = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    apart = 2 * min(limits.resolution_beside(wind, k) for k, wind in enumerate(winds)) / finer
    panels = np.clip(np.ceil(lengths / apart), 1, _MOST_PANELS).astype(np.int64)  # two samples each
    last = min((float(wind.times[-1]) for wind in winds if len(wind.times) > 1), default=np.inf)
    known = np.minimum(when, last) if when is not None else None  # what lasts longer is refused later
    performance = performance_of(vehicle)
    face: FloatArray | None = (
        None  # of the legs' clocks: the share of a leg's time that has gone at equal ways along it
    )

    def wind_at(leg: IntArray, share: FloatArray) -> FloatArray:
        points = places_along(starts, vectors, leg, share)
        if known is None:
            return _with_shares(at_each(winds, points), limits, points, 0.0)
        gone = share if face is None else _gone(face[leg], share)
        moments = known[leg, 0] + gone * (known[leg, 1] - known[leg, 0])
        return _with_shares(at_each(winds, points, moments), limits, points, moments)

    if known is not None and len(vectors):
        short = _SHORT * min(
            (float(np.diff(wind.times).min()) for wind in winds if len(wind.times) > 1), default=np.inf
        )
        for _ in range(_TURNS):
            before, face = (
                face,
                _clock_faces(performance, vectors, known, short, len(winds), wind_at),
            )  # each by the one before
            if face is None or (before is not None and np.abs(face - before).max() < _SAME_FACE):
                break

    panels_found = _halved(panels, wind_at, _CALM * vehicle.airspeed)
    first, weights, shares, blows = samples_of(len(vectors), len(winds), *panels_found)
    begins = None if when is None else when[:, 0]
    return SampledLegs(performance, vectors, first, weights, shares, list(blows), begins, last)


def _with_shares(winds: FloatArray, limits: WindLimits, points: FloatArray, seconds: float | FloatArray) -> FloatArray:
    """The winds (n, 3 m) of m members at points (n, 3) with each one's share of its limits (n, 4 m), if any."""
    if not limits:
        return winds
    shares = limits.shares_of_each(winds, points, seconds)
    return np.concatenate([winds.reshape(*shares.shape, 3), shares[..., None]], axis=2).reshape(len(points), -1)


def _clock_faces(
    performance: Performance,
    vectors: FloatArray,
    when: FloatArray,
    short: float,
    members: int,
    wind_at: Callable[[IntArray, FloatArray], FloatArray],
) -> FloatArray | None:
    """The share of each leg's time that has gone at equal ways along it (n, 13); None where all legs are short.

    On legs that last less than `short` [s], and where one cannot be flown, the clock runs evenly.
    """
    slow = np.flatnonzero(when[:, 1] - when[:, 0] > short)
    if not len(slow):
        return None
    even = np.linspace(0.0, 1.0, _HOURS + 1)
    face = np.tile(even, (len(vectors), 1))
    leg = np.repeat(slow, _HOURS)
    middles = np.tile((even[:-1] + even[1:]) / 2, len(slow))
    blows = wind_at(leg, middles)
    blows = blows.reshape(len(leg), members, -1)[:, :, :3]
    blows = np.ascontiguousarray(blows.mean(axis=1))  # of members their mean; limits stop no clock
    alone = np.arange(len(leg) + 1, dtype=np.int64)
    airspeeds = np.full(len(leg), performance.airspeed)
    paces = integrate_legs(performance, airspeeds, vectors[leg], alone, np.ones(len(leg)), blows)[:, 0]
    paces = paces.reshape(-1, _HOURS)
    known = np.isfinite(paces).all(axis=1) & (paces.sum(axis=1) > 0)
    gone = np.cumsum(paces[known], axis=1)
    face[slow[known], 1:] = gone / gone[:, -1:]
    return face


def _gone(face: FloatArray, share: FloatArray) -> FloatArray:
    """The share of the time that has gone at shares of the way (k,), by the clock faces of their legs (k, 13)."""
    place = share * _HOURS
    hour = np.minimum(place.astype(np.int64), _HOURS - 1)
    row = np.arange(len(share))
    before = face[row, hour]
    gone: FloatArray = before + (place - hour) * (face[row, hour + 1] - before)
    return gone


def clocked(
    measure: Callable[[FloatArray | None], tuple[_Result, FloatArray]], guess: FloatArray, changing: bool
) -> tuple[_Result, FloatArray]:
    """What a polyline's legs come to, and the times (n,) at its points [s], the first one as in the `guess` (n,).

    `measure` takes when each leg begins and ends (n - 1, 2) and gives a result and each leg's seconds. In changing wind
    these depend on when a leg is flown, and that on the legs before: what is found is put in again until no arrival
    moves by a millisecond.
    """
    times = guess
    for _ in range(_MOST_ROUNDS if changing else 1):
        result, seconds = measure(np.column_stack([times[:-1], times[1:]]) if changing else None)
        before, times = times, times[0] + np.append(0.0, np.cumsum(seconds))
        if not np.isfinite(times[-1]) or np.abs(times - before).max() < _SAME_TIME:
            break
    return result, times


def still_air_times(points: FloatArray, vehicle: Vehicle, begin: float) -> FloatArray:
    """When a polyline's points (n, 3) would be passed in still air (n,) [s]: something to begin with."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return begin + np.append(0.0, np.cumsum(lengths / vehicle.airspeed))


def _halved(panels: IntArray, wind_at: Callable[[IntArray, FloatArray], FloatArray], calm: float) -> Panels:
    """Equal `panels` (n,) of each leg, those halved in which the wind changes by more than `calm` [m/s]."""
    rough = panels_of(panels, wind_at(*knots_of(panels)))
    done: list[Panels] = []
    for _ in range(_HALVINGS):
        kept, rough, leg, middles = parted(*rough, calm)
        done.append(kept)
        if not len(leg):
            break
        rough = halves_of(*rough, wind_at(leg, middles))
    else:
        done.append(rough)
    if len(done) == 1:
        return done[0]
    leg, begins, widths, winds = (np.concatenate(parts) for parts in zip(*done, strict=True))
    return leg, begins, widths, winds

"""Which part of a wind file is wanted: the grid about an area, the levels that u and v share, the times."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.geodesy import LocalFrame
from gcs_windplan.wind.cf import LEVEL_KINDS, AxisKind
from gcs_windplan.wind.gridded import misses

#: west, south, east, north in the local frame [m]
Box: TypeAlias = tuple[float, float, float, float]

STEADY_FOR = 3 * 3600.0  # [s] how far from its one time a file is used where a departure is told: our choice
_LATTICE = 17  # points a side of the area whose latitudes and longitudes have to be read


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a variable: its dimension, its values in degrees, seconds since 1970, metres or pascals."""

    dimension: str
    values: FloatArray


Axes: TypeAlias = dict[AxisKind, Axis]
Wanted: TypeAlias = dict[AxisKind, FloatArray]


@dataclass(frozen=True, slots=True)
class Times:
    """The times to read (n,) [s since 1970, UTC], what counts as 0 among them, when they hold [s]."""

    values: FloatArray
    zero: float
    window: tuple[float, float] | None
    note: str


def positions(values: FloatArray, wanted: FloatArray, what: str) -> IntArray:
    """Where the `wanted` values (n,) stand on an axis of any order (n,). `WindError` if one does not."""
    order = np.argsort(values)
    found = order[np.clip(np.searchsorted(values[order], wanted - 1e-6), 0, len(values) - 1)]
    if np.abs(values[found] - wanted).max() > 1e-5:
        raise WindError(f"u and v do not share their {what}s: bring staggered grids onto one first")
    return found.astype(np.int64)


def continuous(longitudes: FloatArray, frame: LocalFrame) -> FloatArray:
    """Longitudes [deg] within 180 degrees of the frame's origin."""
    origin = frame.origin.longitude_deg
    turned: FloatArray = origin + (longitudes - origin + 180.0) % 360.0 - 180.0
    return turned


def west_to_east(longitudes: FloatArray, frame: LocalFrame) -> FloatArray:
    """An axis of longitudes as they stand in the file, ordered from west to east about the frame's origin.

    An axis that lies across the meridian opposite to the origin falls in two: the part nearer to the origin
    is kept.
    """
    turned = continuous(longitudes, frame)
    order = np.argsort(turned)
    steps = np.abs((np.diff(longitudes) + 180.0) % 360.0 - 180.0)
    gaps = np.flatnonzero(np.diff(turned[order]) > 1.5 * steps.max(initial=0.0) + 1e-9)
    parts = np.split(order, gaps + 1)
    nearest = min(parts, key=lambda part: np.abs(turned[part] - frame.origin.longitude_deg).min())
    ordered: FloatArray = longitudes[nearest]
    return ordered


def horizontal(axes: Axes, frame: LocalFrame, area: Box | None, extend: bool) -> Wanted:
    """The latitudes, ascending, and the longitudes, from west to east, that the area needs and a cell more.

    Raises `WindError` if the file lies wholly outside of the area, unless `extend`.
    """
    latitudes = np.sort(axes["latitude"].values)
    longitudes = west_to_east(axes["longitude"].values, frame)
    if area is None:
        return {"latitude": latitudes, "longitude": longitudes}
    turned = continuous(longitudes, frame)
    south, north, west, east = _bounds(area, frame)
    nearest = np.array([[np.clip(latitudes[0], south, north), np.clip(turned[0], west, east)]])
    gap = misses(nearest, latitudes, turned)[0]
    if gap > 0 and not extend:
        raise WindError(
            f"the wind ends {gap / 1000:.0f} km short of the area: it covers latitudes {latitudes[0]:.3f} to "
            f"{latitudes[-1]:.3f} and longitudes {turned[0]:.3f} to {turned[-1]:.3f}; take another file, or "
            "say `extend: nearest` to take the wind at its edge"
        )
    return {
        "latitude": latitudes[_about(latitudes, south, north)],
        "longitude": longitudes[_about(turned, west, east)],
    }


def level_kind(u: Axes, v: Axes) -> AxisKind | None:
    """What the levels of u and v count, None where they have none. Raises `WindError` if they disagree."""
    kinds = [next((kind for kind in LEVEL_KINDS if kind in axes), None) for axes in (u, v)]
    if kinds[0] != kinds[1]:
        raise WindError(f"u has levels of {kinds[0] or 'no'} kind and v of {kinds[1] or 'no'} kind")
    return kinds[0]


def common_levels(kind: AxisKind, u: FloatArray, v: FloatArray) -> FloatArray:
    """The levels that u and v share, from the lowest up. Raises `WindError` if there are none."""
    shared = np.intersect1d(np.round(u, 6), np.round(v, 6))
    if not len(shared):
        raise WindError(f"u and v share no level: u has {_listed(kind, u)}, v has {_listed(kind, v)}")
    return shared[::-1] if kind == "pressure" else shared


def say_levels(kind: AxisKind | None, levels: FloatArray, u: Axes, v: Axes) -> str:
    """What was made of the levels, for people."""
    if kind is None:
        return "one height, the same at every height"
    if len(levels) == 1:
        return f"at {say(kind, levels[0])}, the same at every height"
    counts = len(u[kind].values), len(v[kind].values)
    odd = "" if counts == (len(levels),) * 2 else f" that both have (u {counts[0]}, v {counts[1]})"
    lowest, highest = say(kind, levels[0]), say(kind, levels[-1])
    return f"{len(levels)} levels{odd} from {lowest}, taken below it too, to {highest}"


def choose_times(times: FloatArray, departure: datetime | None) -> Times:
    """The times that a flight after `departure` needs. Raises `WindError` if they do not reach it."""
    times = np.sort(times)
    if not len(times):
        return Times(np.zeros(1), 0.0, None, "no time given")
    start = None if departure is None else departure.timestamp()
    if len(times) == 1:
        return _steady(times, start)
    if start is None:
        raise WindError(f"it holds {len(times)} times, {say_time(times[0])} to {say_time(times[-1])}: give `departure`")
    outside = max(times[0] - start, start - times[-1])
    if outside > 0:
        raise WindError(
            f"the departure {say_time(start)} lies {outside / 3600:.1f} h outside of its times, "
            f"{say_time(times[0])} to {say_time(times[-1])}"
        )
    kept = times[np.searchsorted(times, start, side="right") - 1 :]
    window = (float(kept[0] - start), float(kept[-1] - start))
    return Times(kept, start, window, f"{say_time(kept[0])} to {say_time(kept[-1])}")


def say(kind: AxisKind, value: float) -> str:
    """A place on an axis as people write it."""
    if kind == "time":
        return say_time(value)
    if kind == "pressure":
        return f"{value / 100:g} hPa"
    if kind in LEVEL_KINDS:
        return f"{value:g} m above {'ground' if kind == 'height' else 'mean sea level'}"
    return f"{kind} {value:g}"


def say_time(seconds: float) -> str:
    """A time [s since 1970] as people write it."""
    return f"{datetime.fromtimestamp(float(seconds), UTC):%Y-%m-%d %H:%M} UTC"


def _steady(times: FloatArray, start: float | None) -> Times:
    note = f"steady as at {say_time(times[0])}"
    if start is None:
        return Times(times, float(times[0]), (-math.inf, math.inf), note)
    apart = float(times[0]) - start
    if abs(apart) > STEADY_FOR:
        raise WindError(
            f"its only time, {say_time(times[0])}, is {abs(apart) / 3600:.1f} h from the departure "
            f"{say_time(start)}; at most {STEADY_FOR / 3600:g} h are accepted, or no departure at all"
        )
    return Times(times, start, (apart - STEADY_FOR, apart + STEADY_FOR), note)


def _bounds(area: Box, frame: LocalFrame) -> tuple[float, float, float, float]:
    """South, north, west and east of the area [deg], longitudes continuous from the origin."""
    x, y = np.meshgrid(np.linspace(area[0], area[2], _LATTICE), np.linspace(area[1], area[3], _LATTICE))
    latitude, longitude = frame.to_geographic(np.stack([x.ravel(), y.ravel()], axis=-1))
    longitude = continuous(longitude, frame)
    return float(latitude.min()), float(latitude.max()), float(longitude.min()), float(longitude.max())


def _about(axis: FloatArray, low: float, high: float) -> slice:
    """The nodes of an ascending axis that enclose an interval, and one more on either side."""
    first = min(max(int(np.searchsorted(axis, low, side="right")) - 2, 0), len(axis) - 1)
    last = min(max(int(np.searchsorted(axis, high, side="left")) + 2, first + 1), len(axis))
    return slice(first, last)


def _listed(kind: AxisKind, levels: FloatArray) -> str:
    return ", ".join(say(kind, level) for level in levels)

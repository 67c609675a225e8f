"""Wind on a latitude-longitude grid: what forecast and reanalysis files hold."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.geodesy import LocalFrame
from gcs_windplan.kernels.interpolation import interpolate_columns
from gcs_windplan.wind.chart import Chart, to_grid
from gcs_windplan.wind.field import Ground
from gcs_windplan.wind.profile import heights_above

METRES_PER_DEGREE = 111_195.0  # [m] of a meridian on the mean earth radius, 6371 km (IUGG 1980)
_EDGE = 1.0  # [m] a point may lie this far outside of the grid and still be taken as on its edge
_TOP = 0.01  # [m] the same above the highest level


@dataclass(frozen=True, slots=True)
class GriddedWind:
    """Wind at the nodes of a rectilinear latitude-longitude grid, at levels and times.

    `latitudes` (ny,) and `longitudes` (nx,) [deg] ascend; `times` (nt,) [s since departure] too. `u` and `v`
    (nt, nl, ny, nx) [m/s] blow towards true east and north; `at` turns them into the local grid. `heights`
    [m] is (nl,) or (nt, nl, ny, nx), ascending along the levels: above the ground if `ground` is given,
    otherwise above mean sea level. One level alone holds at every height.

    Between levels, nodes and times the wind is linear. Below the lowest level the lowest level's wind is
    taken, which is rather too strong than too weak. Above the highest level it is not known: NaN. Everything else
    outside raises `WindError`: outside of the area unless `extend` (then the nearest edge's wind is taken), and
    outside of `window` [s since departure], which is from the first to the last time, and always for a single time,
    if not given. `ground_resolution` [m] is the ground's own, where known: wind at levels above the ground changes
    with it.
    """

    name: str
    frame: LocalFrame
    latitudes: FloatArray
    longitudes: FloatArray
    heights: FloatArray
    times: FloatArray
    u: FloatArray
    v: FloatArray
    ground: Ground | None = None
    window: tuple[float, float] | None = None
    extend: bool = False
    ground_resolution: float = math.inf
    _chart: Chart = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for axis in ("latitudes", "longitudes", "times"):
            self._set(axis, _ascending(axis, getattr(self, axis)))
        middle = (self.longitudes[0] + self.longitudes[-1]) / 2
        turns = round((self.frame.origin.longitude_deg - middle) / 360)
        self._set("longitudes", self.longitudes + 360.0 * turns)
        shape = (len(self.times), self.heights.shape[1 if self.heights.ndim == 4 else 0], *self._horizontal)
        for part in ("u", "v", "heights"):
            self._set(part, _filled(part, getattr(self, part), shape))
        if not np.all(np.diff(self.heights, axis=1) > 0):
            raise WindError(f"the levels of {self.name} do not ascend in every column")
        if self.window is None:
            single = len(self.times) == 1
            self._set("window", (-math.inf, math.inf) if single else (self.times[0], self.times[-1]))
        self._set("_chart", Chart(self.frame))

    @property
    def resolution(self) -> float:
        """Half of the smallest spacing of the grid [m], or the ground's own where the levels follow it."""
        south_north = np.diff(self.latitudes) * METRES_PER_DEGREE
        widest = np.cos(np.radians(np.abs(self.latitudes).max()))
        west_east = np.diff(self.longitudes) * METRES_PER_DEGREE * widest
        across = float(min(np.min(south_north, initial=math.inf), np.min(west_east, initial=math.inf)) / 2)
        return across if self.ground is None else min(across, self.ground_resolution)

    def at(self, points: FloatArray, seconds: float = 0.0) -> FloatArray:
        """The wind (n, 3) [m/s] at points (n, 3), `seconds` after departure; the upward component is 0.

        NaN above the highest level. Raises `WindError` outside of the area or time.
        """
        self._check_time(seconds)
        if not np.isfinite(points).all():
            raise WindError("the wind is asked for at a place that is not finite")
        places = self._chart.at(points)
        if not self.extend:
            self._check_area(places)
        z = points[:, 2] if self.ground is None else heights_above(self.ground, points)
        result = interpolate_columns(
            self.u, self.v, self.heights, self.times, self.latitudes, self.longitudes,
            places, np.ascontiguousarray(z, dtype=np.float64), np.full(len(points), float(seconds)),
        )  # fmt: skip
        unknown = result[:, 2] > _TOP  # above the highest level
        result[:, 2] = 0.0
        result[unknown] = np.nan
        return to_grid(result, places[:, 2])

    @property
    def _horizontal(self) -> tuple[int, int]:
        return len(self.latitudes), len(self.longitudes)

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)

    def _check_time(self, seconds: float) -> None:
        first, last = self.window or (-math.inf, math.inf)
        if first <= seconds <= last:
            return
        early = seconds < first
        gap, side = (first - seconds, "before its first") if early else (seconds - last, "after its last")
        raise WindError(
            f"the wind is asked for {seconds / 3600:.2f} h after departure, {gap / 3600:.2f} h {side} usable "
            f"time ({self.name}): choose another departure, or a file that reaches further"
        )

    def _check_area(self, places: FloatArray) -> None:
        missing = misses(places, self.latitudes, self.longitudes)
        if not len(missing) or missing.max() <= _EDGE:
            return
        worst = int(np.argmax(missing))
        latitude, longitude = places[worst, :2]
        raise WindError(
            f"the wind ends {missing[worst] / 1000:.1f} km short of {latitude:.5f}, {longitude:.5f}: it "
            f"covers latitudes {self.latitudes[0]:.3f} to {self.latitudes[-1]:.3f} and longitudes "
            f"{self.longitudes[0]:.3f} to {self.longitudes[-1]:.3f} ({self.name}); take a larger file, or "
            "say `extend: nearest` to take the wind at its edge"
        )


def misses(places: FloatArray, latitudes: FloatArray, longitudes: FloatArray) -> FloatArray:
    """How far places (n, 2 or more) [deg] lie outside of a grid with ascending axes [m], shape (n,)."""
    south_north = _beyond(places[:, 0], latitudes)
    west_east = _beyond(places[:, 1], longitudes) * np.cos(np.radians(places[:, 0]))
    distance: FloatArray = np.hypot(south_north, west_east) * METRES_PER_DEGREE
    return distance


def _beyond(values: FloatArray, axis: FloatArray) -> FloatArray:
    outside: FloatArray = values - np.clip(values, axis[0], axis[-1])
    return outside


def _ascending(name: str, values: FloatArray) -> FloatArray:
    axis = np.ascontiguousarray(values, dtype=np.float64)
    if axis.ndim != 1 or not len(axis) or not np.isfinite(axis).all() or not np.all(np.diff(axis) > 0):
        raise WindError(f"the wind's {name} have to be finite and ascend, each value once")
    return axis


def _filled(name: str, values: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    """A finite, contiguous array of `shape`; one value a level is repeated in every column."""
    array = np.asarray(values, dtype=np.float64)
    if array.shape == shape[1:2]:
        array = np.broadcast_to(array[np.newaxis, :, np.newaxis, np.newaxis], shape)
    if array.shape != shape:
        raise WindError(f"the wind's {name} have the shape {array.shape}, not {shape} (time, level, lat, lon)")
    if not np.isfinite(array).all():
        raise WindError(f"the wind's {name} are not finite everywhere")
    return np.ascontiguousarray(array)

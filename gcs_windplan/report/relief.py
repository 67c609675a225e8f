"""The ground as a picture: hill shade, a calm tint by height and contour lines."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from PIL import Image

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.assessment import Assessment, GroundMap
from gcs_windplan.geo.frame import LocalFrame

_LIGHTS: Final = ((315.0, 0.55), (270.0, 0.2), (0.0, 0.15), (225.0, 0.1))  # azimuth [deg] and weight
_LIGHT_HEIGHT: Final = np.radians(45.0)
_TINTS: Final = np.array(
    [[0.80, 0.86, 0.77], [0.89, 0.90, 0.79], [0.93, 0.88, 0.76], [0.88, 0.81, 0.71], [0.94, 0.92, 0.90]]
)  # low to high, pale: the route lies on it
_STEPS: Final = (1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000)  # [m] between contour lines
_LINES: Final = 14  # contour lines from the lowest to the highest place, about
_HEAVY: Final = 5  # each fifth line is heavier
_SMOOTHED: Final = 3  # neighbours over which a picture of the ground is averaged, twice


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """Heights [m] on a regular grid: (rows, columns), row 0 in the south, NaN where not known; its edges [m]."""

    west: float
    south: float
    east: float
    north: float
    heights: FloatArray

    @property
    def relief(self) -> float:
        """From the lowest to the highest place [m]."""
        known = self.heights[np.isfinite(self.heights)]
        return float(np.ptp(known)) if len(known) else 0.0

    @property
    def size(self) -> float:
        """The longer side [m]."""
        return max(self.east - self.west, self.north - self.south)

    def resampled(self, longest: int, smooth: bool = False) -> Ground:
        """The same with `longest` values along the longer side; `smooth`: to look at, not to measure."""
        width, depth = self.east - self.west, self.north - self.south
        cell = max(width, depth) / (longest - 1)
        shape = (max(2, round(width / cell) + 1), max(2, round(depth / cell) + 1))
        known = np.isfinite(self.heights)
        filled = _smoothed(_filled(self.heights)) if smooth else _filled(self.heights)
        values = np.asarray(Image.fromarray(filled.astype(np.float32)).resize(shape, Image.Resampling.BICUBIC))
        there = np.asarray(Image.fromarray(known.astype(np.uint8)).resize(shape, Image.Resampling.NEAREST))
        heights = np.where(there > 0, values.astype(np.float64), np.nan)
        return Ground(self.west, self.south, self.east, self.north, heights)


def ground_of(assessments: Sequence[Assessment]) -> Ground:
    """The ground around all missions in the first one's frame."""
    first = assessments[0]
    grid = first.ground
    if len(assessments) == 1:
        return _trimmed(Ground(grid.east[0], grid.north[0], grid.east[-1], grid.north[-1], grid.heights), first)
    corners = [np.array([[grid.east[0], grid.north[0]], [grid.east[-1], grid.north[-1]]])]
    corners += [_corners(other, first.frame) for other in assessments[1:]]
    west, south = np.min([c.min(axis=0) for c in corners], axis=0)
    east, north = np.max([c.max(axis=0) for c in corners], axis=0)
    cell = min(_cell(one.ground) for one in assessments)
    columns, rows = (int(np.clip(round(size / cell) + 1, 2, 1200)) for size in (east - west, north - south))
    x, y = np.meshgrid(np.linspace(west, east, columns), np.linspace(south, north, rows))
    places = np.column_stack([x.ravel(), y.ravel()])
    heights = _sample(grid, places)
    for other in assessments[1:]:
        unknown = np.flatnonzero(~np.isfinite(heights))
        heights[unknown] = _sample(other.ground, moved(places[unknown], first.frame, other.frame))
    return Ground(west, south, east, north, heights.reshape(x.shape))


def _trimmed(ground: Ground, assessment: Assessment) -> Ground:
    """The ground without edges where nothing is known and nobody flies."""
    known = np.isfinite(ground.heights)
    columns: BoolArray = np.any(known, axis=0)
    rows: BoolArray = np.any(known, axis=1)
    axes = []
    for there, low, high, flown in (
        (columns, ground.west, ground.east, assessment.profile.east),
        (rows, ground.south, ground.north, assessment.profile.north),
    ):
        places = np.linspace(low, high, len(there))
        wanted = there | ((places >= np.min(flown, initial=np.inf)) & (places <= np.max(flown, initial=-np.inf)))
        kept = np.flatnonzero(wanted)
        first, last = (int(kept[0]), int(kept[-1])) if len(kept) > 1 else (0, len(there) - 1)
        axes.append((slice(first, last + 1), float(places[first]), float(places[last])))
    (across, west, east), (up, south, north) = axes
    return Ground(west, south, east, north, ground.heights[up, across])


def moved(places: FloatArray, frame: LocalFrame, into: LocalFrame) -> FloatArray:
    """Places (n, 2) [m] of one frame in another one."""
    if frame == into or len(places) == 0:
        return places
    return into.to_local(*frame.to_geographic(places))


def _corners(assessment: Assessment, into: LocalFrame) -> FloatArray:
    """The corners of an assessment's ground in another frame, (4, 2) [m]."""
    x, y = np.meshgrid(assessment.ground.east[[0, -1]], assessment.ground.north[[0, -1]])
    return moved(np.column_stack([x.ravel(), y.ravel()]), assessment.frame, into)


def _cell(ground: GroundMap) -> float:
    return float(min(ground.east[1] - ground.east[0], ground.north[1] - ground.north[0]))


def _sample(ground: GroundMap, places: FloatArray) -> FloatArray:
    """Bilinear heights at places (n, 2) [m], NaN outside."""
    rows, columns = ground.heights.shape
    x = (places[:, 0] - ground.east[0]) / (ground.east[-1] - ground.east[0]) * (columns - 1)
    y = (places[:, 1] - ground.north[0]) / (ground.north[-1] - ground.north[0]) * (rows - 1)
    inside = (x >= 0) & (x <= columns - 1) & (y >= 0) & (y <= rows - 1)
    i = np.clip(np.nan_to_num(x).astype(int), 0, columns - 2)
    j = np.clip(np.nan_to_num(y).astype(int), 0, rows - 2)
    u, v = x - i, y - j
    h = ground.heights
    south = h[j, i] * (1 - u) + h[j, i + 1] * u
    north = h[j + 1, i] * (1 - u) + h[j + 1, i + 1] * u
    return np.where(inside, south * (1 - v) + north * v, np.nan)


def _filled(heights: FloatArray) -> FloatArray:
    """Heights with each unknown one taken from a known neighbour in its row or else its column; 0 if none is known."""
    filled = heights
    for _ in range(2):
        filled = _filled_rows(filled).T
    return np.nan_to_num(filled)


def _filled_rows(heights: FloatArray) -> FloatArray:
    known = np.isfinite(heights)
    places = np.arange(heights.shape[1])
    before = np.maximum.accumulate(np.where(known, places, -1), axis=1)
    after = np.minimum.accumulate(np.where(known, places, len(places))[:, ::-1], axis=1)[:, ::-1]
    nearer = (before >= 0) & ((after == len(places)) | (places - before <= after - places))
    taken = np.clip(np.where(nearer, before, after), 0, len(places) - 1)
    return np.take_along_axis(heights, taken, axis=1)


def _smoothed(heights: FloatArray) -> FloatArray:
    """Heights without the edges of the terrain's own triangles, of which hill shade would make a pattern."""
    for _ in range(2):
        heights = _averaged(_averaged(heights, _SMOOTHED).T, _SMOOTHED).T
    return heights


def _averaged(heights: FloatArray, width: int) -> FloatArray:
    """The mean of `width` neighbours along each row; the ends are repeated."""
    before = width // 2
    padded = np.pad(heights, ((0, 0), (before + 1, width - before - 1)), mode="edge")
    sums = np.cumsum(padded, axis=1)
    mean: FloatArray = (sums[:, width:] - sums[:, :-width]) / width
    return mean


def contour_step(relief: float) -> int:
    """The height between two contour lines [m]."""
    return next((step for step in _STEPS if step * _LINES >= relief), _STEPS[-1])


def shade(ground: Ground, contours: float | None = None) -> FloatArray:
    """Colours (rows, columns, 4) from 0 to 1, row 0 in the south; clear where the ground is not known.

    Contour lines lie `contours` [m] apart, by default as it suits; none at 0.
    """
    known = np.isfinite(ground.heights)
    filled = _filled(ground.heights)
    cell = (ground.east - ground.west) / (filled.shape[1] - 1)
    relief = ground.relief
    steepness = 1.0 if relief == 0 else min(6.0, max(1.0, 0.12 * ground.size / relief))
    slopes = np.asarray(np.gradient(filled, cell)) * steepness  # northwards, eastwards
    light = _lit(slopes[1], slopes[0])
    share = (filled - filled.min()) / max(relief, 1e-9)
    stops = np.linspace(0, 1, len(_TINTS))
    tint = np.stack([np.interp(share, stops, _TINTS[:, i]) for i in range(3)], axis=-1)
    colours = tint * (0.52 + 0.55 * light[..., None])
    step = contour_step(relief) if contours is None else contours
    if step > 0 and relief > 0:
        colours *= 1 - _contours(filled, step)[..., None]
    return np.dstack([np.clip(colours, 0, 1), known.astype(np.float64)])


def _lit(slope_east: FloatArray, slope_north: FloatArray) -> FloatArray:
    """How bright the slopes are, 0 to 1, level ground 0.87; light from the north-west and a little from beside."""
    steep = np.sqrt(1 + slope_east**2 + slope_north**2)
    bright = np.zeros_like(steep)
    for azimuth, weight in _LIGHTS:
        east, north = np.sin(np.radians(azimuth)), np.cos(np.radians(azimuth))
        towards = np.sin(_LIGHT_HEIGHT) - np.cos(_LIGHT_HEIGHT) * (slope_east * east + slope_north * north)
        bright += weight * np.clip(towards / steep, 0, 1)
    lit: FloatArray = np.clip(bright * 0.87 / np.sin(_LIGHT_HEIGHT), 0, 1)
    return lit


def _contours(heights: FloatArray, step: float) -> FloatArray:
    """How dark the contour lines are, 0 to 1: about a pixel wide however steep, none where it is nearly flat."""
    slope_north, slope_east = np.gradient(heights)
    steep = np.maximum(np.hypot(slope_east, slope_north), 1e-9)  # [m a pixel]
    number = np.round(heights / step)
    away = np.abs(heights - number * step) / steep  # [pixel]
    dark = np.where(number % _HEAVY == 0, 0.34, 0.17) * np.clip(1.1 - away, 0, 1)
    fading: FloatArray = dark * np.clip(steep / (step * 0.01), 0, 1)
    return fading


def picture(ground: Ground) -> str:
    """The shaded relief as a data address (WebP), north up."""
    pixels = np.round(shade(ground)[::-1] * 255).astype(np.uint8)
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="WEBP", quality=82, method=4)
    return "data:image/webp;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")

"""Signs and words on a drawing: what is taken, and where the next one fits."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from matplotlib.patheffects import Normal, Stroke
from matplotlib.transforms import ScaledTranslation

from gcs_windplan.arrays import FloatArray
from gcs_windplan.assessment import Severity

Offset = tuple[float, float]
_POINTS = 72.0  # in an inch
_LINE = 2.5  # [point] half of a line's width
_APART = 4.0  # [point] between two places of a line that words keep away from

_SIGN: Final = 8.0  # [point] half a finding's sign
_SIGNS: Final = {"danger": ("8", "#b8490a", "white", 0.0), "warning": ("^", "#ffc94d", "#2b1d00", -2.5)}
_TIE: Final = {"arrowstyle": "-", "lw": 0.9, "color": "#1c2430", "shrinkA": 0, "shrinkB": 0}


@dataclass(frozen=True, slots=True)
class MapSign:
    """A finding's sign: its number and severity, and where it is on the drawing, in the axes' own units."""

    text: str
    severity: Severity
    x: float
    y: float


class LabelPlacer:
    """The boxes that are taken on a drawing [point], and lines that are better kept free; its axes have limits."""

    def __init__(self, axes: Any) -> None:
        self.axes = axes
        self._taken: list[tuple[FloatArray, Offset]] = []
        self._lines: list[FloatArray] = []

    def keep_free(self, line: FloatArray) -> None:
        """A line (n, 2) that words stand on only where they find no other room."""
        places = self._points(line)
        steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
        for start, end, length in zip(places[:-1], places[1:], steps, strict=True):
            share = np.linspace(0, 1, 2 + int(min(length, 1e5) / _APART))[:, None]
            self._lines.append(start + share * (end - start))

    def beside(
        self, x: float, y: float, half: Offset, offsets: Iterable[Offset], on_lines: bool = False
    ) -> Offset | None:
        """The first offset [point] from a place at which a box of a half width and height is free, which it takes.

        None where nothing is free: then nothing is taken. `on_lines`: as well on a line as elsewhere.
        """
        here = self._points(np.array([[x, y]]))[0]
        edge = self.axes.bbox.get_points() * _POINTS / self.axes.figure.dpi
        free = [offset for offset in offsets if self._is_free(here + offset, half, edge)]
        for offset in free:
            if on_lines or not self._on_line(here + offset, half):
                self._taken.append((here + offset, half))
                return offset
        if free:
            self._taken.append((here + free[0], half))
            return free[0]
        return None

    def _points(self, places: FloatArray) -> FloatArray:
        scaled: FloatArray = self.axes.transData.transform(places) * _POINTS / self.axes.figure.dpi
        return scaled

    def _is_free(self, centre: FloatArray, half: Offset, edge: FloatArray) -> bool:
        if np.any(centre - half < edge[0]) or np.any(centre + half > edge[1]):
            return False
        return not any(np.all(np.abs(centre - place) < np.add(half, size)) for place, size in self._taken)

    def _on_line(self, centre: FloatArray, half: Offset) -> bool:
        reach = np.add(half, _LINE)
        return any(bool(np.any(np.all(np.abs(line - centre) < reach, axis=1))) for line in self._lines)


def rings(radius: float, count: int, first: float = 0.0) -> tuple[Offset, ...]:
    """Offsets on rings about a place, eight on the first and as densely on the others, from a first bearing [deg]."""
    turns = [(n, np.radians(first - 360 * i / (8 * n))) for n in range(1, count + 1) for i in range(8 * n)]
    return tuple((float(n * radius * np.cos(turn)), float(n * radius * np.sin(turn))) for n, turn in turns)


_BESIDE_SIGN: Final = ((0.0, 0.0), *rings(2.1 * _SIGN, 4))
_BESIDE_STOP: Final = rings(9.0, 1, first=45.0)
_BESIDE_SITE: Final = rings(11.0, 2, first=-45.0)


def draw_sign(placer: LabelPlacer, sign: MapSign) -> None:
    """A finding's sign with its number, where it belongs or tied to it from beside."""
    axes, place = placer.axes, (sign.x, sign.y)
    marker, fill, ink, centre = _SIGNS[sign.severity]
    dx, dy = placer.beside(*place, (_SIGN, _SIGN), _BESIDE_SIGN, on_lines=True) or (0.0, 0.0)
    if dx or dy:
        axes.annotate("", place, xytext=(dx, dy), textcoords="offset points", arrowprops=_TIE, zorder=13)
    there = axes.transData + ScaledTranslation(dx / _POINTS, dy / _POINTS, axes.figure.dpi_scale_trans)
    axes.plot(*place, marker, ms=2 * _SIGN, mfc=fill, mec="black", mew=0.9, zorder=14, transform=there)
    axes.annotate(
        sign.text, place, xytext=(dx, dy + centre), textcoords="offset points", ha="center", va="center",
        fontsize=7.5 if len(sign.text) < 3 else 6, fontweight="bold", color=ink, zorder=15,
    )  # fmt: skip


def draw_number(placer: LabelPlacer, x: float, y: float, text: str) -> None:
    """A stop's number beside it, if there is room."""
    offset = placer.beside(x, y, (2.5 * len(text) + 1, 4.0), _BESIDE_STOP)
    if offset is not None:
        _draw_word(placer.axes, (x, y), offset, text, 7.5)


def draw_name(placer: LabelPlacer, x: float, y: float, text: str, size: float = 10.0) -> None:
    """A site's name beside its mark [point]."""
    half = 0.29 * size * len(text), 0.45 * size
    offsets = [(dx + np.sign(round(dx)) * half[0], dy) for dx, dy in _BESIDE_SITE]
    _draw_word(placer.axes, (x, y), placer.beside(x, y, half, offsets) or offsets[0], text, size)


def _draw_word(axes: Any, place: Offset, offset: Offset, text: str, size: float) -> None:
    """A word on the map with a white halo, centred at an offset [point] from a place."""
    axes.annotate(
        text, place, xytext=offset, textcoords="offset points", fontsize=size, zorder=13, ha="center", va="center",
        path_effects=[Stroke(linewidth=2.4, foreground="white"), Normal()],
    )  # fmt: skip

"""Forecast files become winds: one or several files of any format, one field a member.

paths ─ catalogues ─ pairs of sheets ─ part of the grid ─ read, turned to true north, heights ─▶ Forecast
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cached_property
from pathlib import Path

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import Problem, WindError
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.kernels.interpolation import LOG, POWER, Columns, Law
from gcs_windplan.wind import pairing
from gcs_windplan.wind.field import Ground
from gcs_windplan.wind.files.anyfile import open_catalogue
from gcs_windplan.wind.gridded import GriddedWind, mean_of
from gcs_windplan.wind.model_levels import heights_of_levels
from gcs_windplan.wind.pairing import Members, Pair, Span, Winds, say_time
from gcs_windplan.wind.placement import Box, Part, axes_directions, part_of
from gcs_windplan.wind.sheets import SURFACE, Level, Quantity, Sheet

ROUGHNESS = 0.1  # [m] where neither file nor mission tells: Davenport's class "roughly open" (WMO-No. 8, annex 5.C)
_FASTEST = 200.0  # [m/s] no wind on earth blows faster: 113 m/s at the ground (WMO), some 130 in the jet stream
_HIGHEST_CARRIED = 300.0  # [m above ground] no law of the surface layer reaches farther


@dataclass(frozen=True, slots=True)
class Wanted:
    """What a reader of forecasts is asked for.

    `area` (west, south, east, north in the local frame [m]) is where wind will be asked for: what lies more than a cell
    outside of it is not read. `departure`, with its time zone, and `lasting` [s] choose the times. `ground` is the
    terrain under the route. `extend` takes the wind at the edge for places outside of the grid.

    `exponent` or `roughness` [m], one of them, is the law below the lowest level; without either it is a log law with
    the file's own roughness, or 0.1 m. `carried`: the law also carries the wind above levels that are all above the
    ground. `known_height` [m above ground] is that of a level whose height the file does not tell.
    """

    frame: LocalFrame
    ground: Ground | None = None
    departure: datetime | None = None
    lasting: float = 24 * 3600.0
    area: Box | None = None
    extend: bool = False
    members: Members = None
    exponent: float | None = None
    roughness: float | None = None
    carried: bool = False
    known_height: float | None = None
    ground_resolution: float = math.inf


@dataclass(frozen=True, eq=False)
class Forecast:
    """Winds of one or more members on one grid; `fields` in the order of `members`.

    A forecast without an ensemble has one field, its member is None. `gusts` (times, rows, columns) [m/s] is one field
    a member, as `Columns` with the gust in place of u, or empty where the files have none. `notes` tell what was made
    of the files.

    >>> import gcs_windplan as gw
    >>> forecast = gw.read_forecast(
    ...     "missions/wind/front_synthetic.nc", (36.55, -84.25), terrain="sample:jacksboro", members=[0, 1],
    ...     departure="2026-05-01T08:00Z", lasting=3600.0, radius=2000.0,
    ... )
    >>> len(forecast.fields)
    2
    """

    name: str
    members: tuple[int | None, ...]
    fields: tuple[GriddedWind, ...]
    runs: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()
    gusts: tuple[GriddedWind, ...] = field(default=(), repr=False)

    @cached_property
    def mean(self) -> GriddedWind:
        """The mean of all members: winds and heights averaged."""
        if len(self.fields) == 1:
            return self.fields[0]
        return replace(mean_of(self.fields), name=f"{self.name}, mean of {len(self.fields)} members")


def read_forecast(paths: Sequence[Path | str], wanted: Wanted) -> Forecast:
    """The winds in one or several forecast files.

    Raises `WindError` for files that cannot be read or have no wind, heights that are not known, places and times that
    they do not cover, values that are missing in the part that is read. The message begins with the file.
    """
    departure = wanted.departure
    if departure is not None and departure.tzinfo is None:
        raise WindError(f"the departure {departure:%Y-%m-%d %H:%M} has no time zone: write it in UTC, ending in Z")
    files = [Path(path) for path in paths]
    title = files[0].name if len(files) == 1 else f"{files[0].name} and {len(files) - 1} more"
    with ExitStack() as stack:
        catalogues = [stack.enter_context(open_catalogue(path)) for path in files]
        try:
            span = Span(None if departure is None else departure.timestamp(), wanted.lasting)
            winds = pairing.choose(catalogues, wanted.members, span, wanted.known_height)
            titles = list(dict.fromkeys(c.title for c in catalogues if c.title))
            source = f"{title} ({titles[0][:80]})" if titles else title
            return Assembly(winds, wanted, part_of(winds.grid, wanted.frame, wanted.area, wanted.extend)).made(source)
        except WindError as error:
            if str(error).startswith(tuple(map(str, files))):
                raise
            raise error.told_as([Problem(f"{', '.join(map(str, files))}: {error}")]) from error


@dataclass(frozen=True, eq=False)
class Assembly:
    """Chosen winds, on their way to arrays."""

    winds: Winds
    wanted: Wanted
    part: Part

    def made(self, source: str) -> Forecast:
        """The forecast, named after its source."""
        winds, wanted = self.winds, self.wanted
        law, said = self.law()
        name = ", ".join([f"{source}: {self._levels()}", said, *winds.notes, *(["extended"] if wanted.extend else [])])
        zero, window = self._clock()
        fields = tuple(
            GriddedWind(
                name if member is None else f"{name}, member {member}", self.part.placement, self._columns(member), law,
                zero, window, wanted.ground, wanted.extend, wanted.ground_resolution,
            )
            for member in winds.members
        )  # fmt: skip
        gusts = [self._gusts(member, one) for member, one in zip(winds.members, fields, strict=True)]
        known = tuple(gust for gust in gusts if gust is not None)
        return Forecast(name, winds.members, fields, winds.runs, winds.notes, known if len(known) == len(gusts) else ())

    def _clock(self) -> tuple[float, tuple[float, float]]:
        """When the departure is and for when the wind is good [s since 1970]."""
        times, departure = self.winds.times, self.wanted.departure
        first, last = times[0] or 0.0, times[-1] or 0.0
        zero = first if departure is None else departure.timestamp()
        if len(times) > 1:
            return zero, (first, last)
        if times[0] is None or departure is None:
            return zero, (-math.inf, math.inf)
        return zero, (first - pairing.STEADY_FOR, first + pairing.STEADY_FOR)

    def _columns(self, member: int | None) -> Columns:
        """The arrays of one member."""
        winds, placement = self.winds, self.part.placement
        terrain = self.surface("terrain", -math.inf)
        heights = self.heights(member, terrain)
        upwards = sorted(heights, key=lambda level: float(np.mean(heights[level])))
        levels = [*winds.above, *upwards]
        values = np.stack(
            [
                np.stack([self.wind(winds.pairs[time, member, level]) for level in levels], axis=2)
                for time in winds.times
            ]
        )
        beyond = (
            np.stack([heights[level] for level in upwards], axis=-1) if upwards else np.empty((*values.shape[:3], 0))
        )
        self._check_complete(values, beyond, terrain, levels)
        above = [level.value if level.kind == "height" else self.wanted.known_height for level in winds.above]
        return Columns(
            winds=np.ascontiguousarray(values),
            above=np.array(above, dtype=np.float64),
            heights=np.ascontiguousarray(beyond),
            terrain=terrain,
            roughness=self._roughness(),
            times=np.array([0.0 if time is None else time for time in winds.times]),
            rows=placement.rows,
            columns=placement.columns,
        )

    def wind(self, pair: Pair) -> FloatArray:
        """u and v (rows, columns, 2) towards true east and north [m/s]."""
        first, second = self.read(pair.first), self.read(pair.second)
        if pair.polar:
            angle = np.radians(second)
            first, second = -first * np.sin(angle), -first * np.cos(angle)
        elif pair.first.along_grid and not self.winds.grid.regular:
            cos, sin = self._turn
            first, second = first * cos - second * sin, first * sin + second * cos
        return np.stack([first, second], axis=-1)

    @cached_property
    def _turn(self) -> tuple[FloatArray, FloatArray]:
        """Cosine and sine of the angle from true east to the grid's x axis."""
        angle = axes_directions(self.winds.grid, self.part)
        return np.cos(angle), np.sin(angle)

    def read(self, sheet: Sheet) -> FloatArray:
        """The part of a sheet that is wanted (rows, columns)."""
        return sheet.read(self.part.rows, self.part.columns)

    def heights(self, member: int | None, terrain: FloatArray) -> dict[Level, FloatArray]:
        """Heights above sea level [m] of the levels beyond, where they are known at all times.

        (times, rows, columns), or (1, 1, 1) where they are the same everywhere. Raises `WindError` where the levels
        are the only ones and none is known.
        """
        winds = self.winds
        if not winds.beyond:
            return {}
        if winds.beyond[0].kind == "altitude":
            return {level: np.full((1, 1, 1), level.value) for level in winds.beyond}
        by_time = [self._told(time, member) for time in winds.times]
        if winds.beyond[0].kind == "model" and not by_time[0]:
            by_time = [self._worked_out(time, member, terrain) for time in winds.times]
        known = [level for level in winds.beyond if all(level in found for found in by_time)]
        if not known and not winds.above:
            kind = "pressures" if winds.beyond[0].kind == "pressure" else "model levels"
            raise WindError(
                f"its levels are {kind} and it has no geopotential (z or gh) on them, so that their heights are"
                " unknown: download it along with u and v"
            )
        return {level: np.stack([found[level] for found in by_time]) for level in known}

    def _told(self, time: float | None, member: int | None) -> dict[Level, FloatArray]:
        """The heights that the files hold."""
        sheets = {level: self._other("height", time, member, level) for level in self.winds.beyond}
        return {level: self.read(sheet) for level, sheet in sheets.items() if sheet is not None}

    def _worked_out(self, time: float | None, member: int | None, terrain: FloatArray) -> dict[Level, FloatArray]:
        """The heights of model levels from temperature and pressure; none where the files lack what that takes."""
        pressure = self._other("pressure", time, member, SURFACE)
        warm = self._by_number("temperature", time, member)
        half_levels = next((s.half_levels for s in self.winds.others if s.half_levels is not None), None)
        if pressure is None or half_levels is None or not warm or not np.isfinite(terrain).all():
            return {}
        found = heights_of_levels(
            half_levels, self.read(pressure), terrain, warm, self._by_number("humidity", time, member)
        )
        return {level: found[int(level.value)] for level in self.winds.beyond if int(level.value) in found}

    def _by_number(self, quantity: Quantity, time: float | None, member: int | None) -> dict[int, FloatArray]:
        """A quantity on all model levels by their numbers."""
        levels = [level for name, level in self._index if name == quantity and level.kind == "model"]
        sheets = {int(level.value): self._other(quantity, time, member, level) for level in levels}
        return {number: self.read(sheet) for number, sheet in sheets.items() if sheet is not None}

    def _other(self, quantity: Quantity, time: float | None, member: int | None, level: Level) -> Sheet | None:
        """A sheet beside the winds: of their time and, where there are any, their member and run."""
        fits = [
            sheet
            for sheet in self._index.get((quantity, level), [])
            if sheet.time in (time, None) and sheet.member in (member, None)
        ]
        run = self._runs.get((time, member))
        return max(fits, key=lambda s: (s.member == member, s.time == time, s.run == run, s.run or 0.0), default=None)

    @cached_property
    def _index(self) -> dict[tuple[Quantity, Level], list[Sheet]]:
        index: dict[tuple[Quantity, Level], list[Sheet]] = {}
        for sheet in self.winds.others:
            index.setdefault((sheet.quantity, sheet.level), []).append(sheet)
        return index

    @cached_property
    def _runs(self) -> dict[tuple[float | None, int | None], float | None]:
        return {(time, member): pair.first.run for (time, member, _), pair in self.winds.pairs.items()}

    def surface(self, quantity: Quantity, otherwise: float) -> FloatArray:
        """A field of the ground (rows, columns), or one number everywhere."""
        found = [sheet for sheet in self.winds.others if sheet.quantity == quantity]
        if not found:
            return np.full((len(self.part.rows), len(self.part.columns)), otherwise)
        values = self.read(found[0])
        return np.ascontiguousarray(np.where(np.isfinite(values), values, otherwise))

    def _roughness(self) -> FloatArray:
        wanted = self.wanted.roughness
        field = self.surface("roughness", ROUGHNESS if wanted is None else wanted)
        return np.full_like(field, wanted) if wanted is not None else np.maximum(field, 1e-5)

    def law(self) -> tuple[Law, str]:
        """The law below the lowest level, and what is said of it."""
        wanted = self.wanted
        carry = _HIGHEST_CARRIED if wanted.carried and not self.winds.beyond else 0.0
        beyond = f", and above up to {carry:g} m" if carry else ""
        if wanted.exponent is not None:
            return Law(POWER, wanted.exponent, carry), f"below by a power law ({wanted.exponent:g}){beyond}"
        own = any(sheet.quantity == "roughness" for sheet in self.winds.others) and wanted.roughness is None
        rough = "the file's roughness" if own else f"roughness {wanted.roughness or ROUGHNESS:g} m"
        return Law(LOG, 0.0, carry), f"below by a log law ({rough}){beyond}"

    def _levels(self) -> str:
        """What the levels are, for people."""
        winds = self.winds
        pair = next(iter(winds.pairs.values()))
        names = f"{pair.first.name or pair.first.quantity}, {pair.second.name or pair.second.quantity}"
        levels = [str(level) for level in (*winds.above, *winds.beyond)]
        if len(levels) == 1:
            return f"{names} at {levels[0]}"
        return f"{names}, {len(levels)} levels from {levels[0]} to {levels[-1]}"

    def _gusts(self, member: int | None, like: GriddedWind) -> GriddedWind | None:
        """The gusts of a member as a field whose first part is the gust, None where not every time has one."""
        levels = [level for quantity, level in self._index if quantity == "gust"]
        level = min(levels, key=lambda one: one.kind != "height", default=SURFACE)
        sheets = [self._other("gust", time, member, level) for time in self.winds.times]
        read = [self.read(sheet) for sheet in sheets if sheet is not None]
        if len(read) < len(sheets) or not np.isfinite(read).all():
            return None
        values = np.stack([np.stack([gust, np.zeros_like(gust)], axis=-1) for gust in read])[:, :, :, None, :]
        columns = like.columns._replace(
            winds=np.ascontiguousarray(values),
            above=np.array([10.0]),
            heights=np.empty((*values.shape[:3], 0)),
        )
        return replace(like, columns=columns, law=Law(POWER, 0.0, math.inf))  # the same at every height

    def _check_complete(self, values: FloatArray, beyond: FloatArray, terrain: FloatArray, levels: list[Level]) -> None:
        """Raise `WindError` that tells the first place where a value is missing; under the forecast's ground it may be.

        What is missing there becomes 0: no wind is ever taken from it.
        """
        na = len(self.winds.above)
        hidden = np.zeros(values.shape[:4], dtype=bool)
        hidden[:, :, :, na:] = beyond <= terrain[None, :, :, None]
        values[hidden & ~np.isfinite(values).all(axis=4)] = 0.0
        missing = np.argwhere(~np.isfinite(values).all(axis=4))
        if len(missing):
            time, row, column, level = missing[0]
            moment = self.winds.times[time]
            when = "" if moment is None else f"{say_time(moment)}, "
            raise WindError(
                f"the wind is missing at {len(missing)} of {values[..., 0].size} nodes, first at {when}{levels[level]},"
                f" {self._place(row, column)}: fill it or cut it off"
            )
        fastest = float(np.abs(values).max(initial=0.0))
        if fastest > _FASTEST:
            raise WindError(
                f"it has a wind of {fastest:g} m/s, which is none: a missing value that the file does not mark? Mark it"
                " (_FillValue), fill it or cut it off"
            )
        if not np.isfinite(beyond).all():
            raise WindError("the heights of its levels are missing at some nodes: fill them or cut them off")

    def _place(self, row: int, column: int) -> str:
        """A node of the part, for people."""
        grid, i, j = self.winds.grid, self.part.rows[row], self.part.columns[column]
        latitude, longitude = (
            (grid.latitudes[i], grid.longitudes[j]) if grid.regular else (grid.latitudes[i, j], grid.longitudes[i, j])
        )
        return f"latitude {latitude:g}, longitude {longitude:g}"

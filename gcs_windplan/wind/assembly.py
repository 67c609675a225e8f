"""Selected winds of forecast files become arrays: one `GriddedWind` a member."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.kernels.interpolation import LOG, POWER, Columns, Law
from gcs_windplan.wind.field_index import SURFACE, Field2D, Level, Quantity
from gcs_windplan.wind.forecast import Forecast, ForecastQuery
from gcs_windplan.wind.gridded import GriddedWind
from gcs_windplan.wind.model_levels import heights_of_levels
from gcs_windplan.wind.pairing import STEADY_FOR, Selection, WindPair, format_time
from gcs_windplan.wind.placement import Subset, axes_directions

ROUGHNESS = 0.1  # [m] where neither file nor mission tells: Davenport's class "roughly open" (WMO-No. 8, annex 5.C)
_FASTEST = 200.0  # [m/s] no wind on earth blows faster: 113 m/s at the ground (WMO), some 130 in the jet stream
_HIGHEST_CARRIED = 300.0  # [m above ground] no law of the surface layer reaches farther


@dataclass(frozen=True, eq=False)
class Assembly:
    """Selected winds, on their way to arrays."""

    selection: Selection
    query: ForecastQuery
    subset: Subset

    def build(self, source: str) -> Forecast:
        """The forecast, named after its source."""
        selection, query = self.selection, self.query
        law, law_text = self._law()
        name = f"{source}: " * bool(source) + ", ".join(
            [self._levels(), law_text, *selection.notes, *(["extended"] if query.extend else [])]
        )
        heights = self._heights(selection.members[0])
        upwards = sorted(heights, key=lambda level: float(np.mean(heights[level])))
        departure, window = self._clock()
        fields = tuple(
            GriddedWind(
                name if member is None else f"{name}, member {member}", self.subset.placement,
                self._columns(member, upwards), law, departure, window, query.ground, query.extend,
                query.ground_resolution,
            )
            for member in selection.members
        )  # fmt: skip
        gusts = [self._gusts(member, one) for member, one in zip(selection.members, fields, strict=True)]
        known = tuple(gust for gust in gusts if gust is not None)
        return Forecast(
            name, selection.members, fields, (*selection.above_ground, *upwards), selection.runs, selection.notes,
            known if len(known) == len(gusts) else (),
        )  # fmt: skip

    def _clock(self) -> tuple[float, tuple[float, float]]:
        """When the departure is and for when the wind is good [s since 1970]."""
        times, departure = self.selection.times, self.query.departure
        first, last = times[0] or 0.0, times[-1] or 0.0
        start = first if departure is None else departure.timestamp()
        if len(times) > 1:
            return start, (first, last)
        if times[0] is None or departure is None:
            return start, (-math.inf, math.inf)
        return start, (first - STEADY_FOR, first + STEADY_FOR)

    def _columns(self, member: int | None, upwards: list[Level]) -> Columns:
        """The arrays of one member; `upwards` are the levels above sea level."""
        selection, placement = self.selection, self.subset.placement
        levels = [*selection.above_ground, *upwards]
        values = np.stack(
            [
                np.stack([self._wind(selection.pairs[time, member, level]) for level in levels], axis=2)
                for time in selection.times
            ]
        )
        heights, known = np.empty((*values.shape[:3], 0)), self._heights(member)
        if upwards:
            heights = np.stack([known[level] for level in upwards], axis=-1)
        self._check_complete(values, heights, levels)
        above = [level.value if level.kind == "height" else self.query.known_height for level in selection.above_ground]
        return Columns(
            winds=np.ascontiguousarray(values),
            above=np.array(above, dtype=np.float64),
            heights=np.ascontiguousarray(heights),
            terrain=self._terrain,
            roughness=self._roughness(),
            times=np.array([0.0 if time is None else time for time in selection.times]),
            rows=placement.rows,
            columns=placement.columns,
        )

    def _wind(self, pair: WindPair) -> FloatArray:
        """u and v (rows, columns, 2) towards true east and north [m/s]."""
        return pair.read(self.subset.rows, self.subset.columns, self._axes_angle if pair.along_grid else 0.0)

    @cached_property
    def _axes_angle(self) -> FloatArray:
        """The angle from true east to the grid's x axis (rows, columns) [rad]."""
        return axes_directions(self.selection.grid, self.subset.rows, self.subset.columns)

    @cached_property
    def _terrain(self) -> FloatArray:
        """The forecast's own ground above mean sea level (rows, columns) [m], -inf where unknown."""
        return self._surface("terrain", -math.inf)

    def _read(self, field2d: Field2D) -> FloatArray:
        """The part of a field that the query needs (rows, columns)."""
        return field2d.read(self.subset.rows, self.subset.columns)

    def _heights(self, member: int | None) -> dict[Level, FloatArray]:
        """Heights above sea level [m] of the levels that count from there, where they are known at all times.

        (times, rows, columns), or (1, 1, 1) where they are the same everywhere. Raises `WindError` where the levels
        are the only ones and none is known.
        """
        selection = self.selection
        if not selection.above_sea:
            return {}
        if selection.above_sea[0].kind == "altitude":
            return {level: np.full((1, 1, 1), level.value) for level in selection.above_sea}
        by_time = [self._stored_heights(time, member) for time in selection.times]
        if selection.above_sea[0].kind == "model" and not by_time[0]:
            by_time = [self._hydrostatic_heights(time, member) for time in selection.times]
        known = [level for level in selection.above_sea if all(level in found for found in by_time)]
        if not known and not selection.above_ground:
            kind = "pressures" if selection.above_sea[0].kind == "pressure" else "model levels"
            raise WindError(
                f"its levels are {kind} and it has no geopotential (z or gh) on them, so that their heights are"
                " unknown: download it along with u and v"
            )
        return {level: np.stack([found[level] for found in by_time]) for level in known}

    def _stored_heights(self, time: float | None, member: int | None) -> dict[Level, FloatArray]:
        """The heights that the files hold."""
        found = {level: self._companion("height", time, member, level) for level in self.selection.above_sea}
        return {level: self._read(field2d) for level, field2d in found.items() if field2d is not None}

    def _hydrostatic_heights(self, time: float | None, member: int | None) -> dict[Level, FloatArray]:
        """The heights of model levels from temperature and pressure; none where the files lack what that takes."""
        pressure = self._companion("pressure", time, member, SURFACE)
        temperatures = self._on_model_levels("temperature", time, member)
        half_levels = next((s.half_levels for s in self.selection.others if s.half_levels is not None), None)
        if pressure is None or half_levels is None or not temperatures or not np.isfinite(self._terrain).all():
            return {}
        found = heights_of_levels(
            half_levels,
            self._read(pressure),
            self._terrain,
            temperatures,
            self._on_model_levels("humidity", time, member),
        )
        return {level: found[int(level.value)] for level in self.selection.above_sea if int(level.value) in found}

    def _on_model_levels(self, quantity: Quantity, time: float | None, member: int | None) -> dict[int, FloatArray]:
        """A quantity on all model levels by their numbers."""
        levels = [level for name, level in self._index if name == quantity and level.kind == "model"]
        found = {int(level.value): self._companion(quantity, time, member, level) for level in levels}
        return {number: self._read(field2d) for number, field2d in found.items() if field2d is not None}

    def _companion(self, quantity: Quantity, time: float | None, member: int | None, level: Level) -> Field2D | None:
        """A field beside the winds: of their time and, where there are any, their member and run."""
        fits = [
            field2d
            for field2d in self._index.get((quantity, level), [])
            if field2d.time in (time, None) and field2d.member in (member, None)
        ]
        run = self._runs.get((time, member))
        return max(fits, key=lambda s: (s.member == member, s.time == time, s.run == run, s.run or 0.0), default=None)

    @cached_property
    def _index(self) -> dict[tuple[Quantity, Level], list[Field2D]]:
        index: dict[tuple[Quantity, Level], list[Field2D]] = {}
        for field2d in self.selection.others:
            index.setdefault((field2d.quantity, field2d.level), []).append(field2d)
        return index

    @cached_property
    def _runs(self) -> dict[tuple[float | None, int | None], float | None]:
        return {(time, member): pair.first.run for (time, member, _), pair in self.selection.pairs.items()}

    def _surface(self, quantity: Quantity, otherwise: float) -> FloatArray:
        """A field of the ground (rows, columns), or one number everywhere."""
        found = [field2d for field2d in self.selection.others if field2d.quantity == quantity]
        if not found:
            return np.full((len(self.subset.rows), len(self.subset.columns)), otherwise)
        values = self._read(found[0])
        return np.ascontiguousarray(np.where(np.isfinite(values), values, otherwise))

    def _roughness(self) -> FloatArray:
        asked = self.query.roughness
        if asked is not None:
            return np.full((len(self.subset.rows), len(self.subset.columns)), asked)
        return np.maximum(self._surface("roughness", ROUGHNESS), 1e-5)

    def _law(self) -> tuple[Law, str]:
        """The law below the lowest level, and what is said of it."""
        query = self.query
        carried_to = _HIGHEST_CARRIED if query.carried and not self.selection.above_sea else 0.0
        beyond = f", and above up to {carried_to:g} m" if carried_to else ""
        if query.exponent is not None:
            return Law(POWER, query.exponent, carried_to), f"below by a power law ({query.exponent:g}){beyond}"
        own = any(field2d.quantity == "roughness" for field2d in self.selection.others) and query.roughness is None
        rough = "the file's roughness" if own else f"roughness {query.roughness or ROUGHNESS:g} m"
        return Law(LOG, 0.0, carried_to), f"below by a log law ({rough}){beyond}"

    def _levels(self) -> str:
        """What the levels are, for people."""
        selection = self.selection
        pair = next(iter(selection.pairs.values()))
        names = f"{pair.first.name or pair.first.quantity}, {pair.second.name or pair.second.quantity}"
        levels = [str(level) for level in (*selection.above_ground, *selection.above_sea)]
        if len(levels) == 1:
            return f"{names} at {levels[0]}"
        return f"{names}, {len(levels)} levels from {levels[0]} to {levels[-1]}"

    def _gusts(self, member: int | None, like: GriddedWind) -> GriddedWind | None:
        """The gusts of a member as a field whose first part is the gust, None where not every time has one."""
        levels = [level for quantity, level in self._index if quantity == "gust"]
        level = min(levels, key=lambda one: one.kind != "height", default=SURFACE)
        found = [self._companion("gust", time, member, level) for time in self.selection.times]
        read = [self._read(field2d) for field2d in found if field2d is not None]
        if len(read) < len(found) or not np.isfinite(read).all():
            return None
        gusts = np.stack(read)
        return like.at_all_heights(np.stack([gusts, np.zeros_like(gusts)], axis=-1))

    def _check_complete(self, values: FloatArray, heights: FloatArray, levels: list[Level]) -> None:
        """Raise `WindError` that tells the first place where a value is missing; under the forecast's ground it may be.

        What is missing there becomes 0: no wind is ever taken from it.
        """
        na = len(self.selection.above_ground)
        hidden = np.zeros(values.shape[:4], dtype=bool)
        hidden[:, :, :, na:] = heights <= self._terrain[None, :, :, None]
        values[hidden & ~np.isfinite(values).all(axis=4)] = 0.0
        missing = np.argwhere(~np.isfinite(values).all(axis=4))
        if len(missing):
            time, row, column, level = missing[0]
            moment = self.selection.times[time]
            when = "" if moment is None else f"{format_time(moment)}, "
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
        if not np.isfinite(heights).all():
            raise WindError("the heights of its levels are missing at some nodes: fill them or cut them off")

    def _place(self, row: int, column: int) -> str:
        """A node of the part, for people."""
        grid, i, j = self.selection.grid, self.subset.rows[row], self.subset.columns[column]
        latitude, longitude = (
            (grid.latitudes[i], grid.longitudes[j]) if grid.regular else (grid.latitudes[i, j], grid.longitudes[i, j])
        )
        return f"latitude {latitude:g}, longitude {longitude:g}"

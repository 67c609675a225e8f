"""Which coordinates belong to a variable of a NetCDF file, and when and at which levels its values hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import SURFACE, Level, LevelKind
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.cf_axes import LEVELS, Role, role
from gcs_windplan.wind.files.cf_names import Meaning
from gcs_windplan.wind.files.cf_time import Coordinate, moments, spans, written
from gcs_windplan.wind.files.hybrid import Halves, model_levels
from gcs_windplan.wind.files.netcdf_file import NetcdfFile
from gcs_windplan.wind.files.units import LENGTH, PRESSURE, unit_factor

_STATIC = ("terrain", "roughness")
_ON_THE_SURFACE = (*_STATIC, "pressure")


@dataclass(frozen=True, slots=True, eq=False)
class Levels:
    """The levels of a variable along a dimension; without one there is one level."""

    dimension: str | None
    levels: tuple[Level, ...]
    half_levels: Halves | None = None


class Axes:
    """The coordinates of a file."""

    def __init__(self, file: NetcdfFile) -> None:
        self.file = file
        found = {v.name: role(v) for v in file.variables.values() if file.is_numeric(v)}
        self._roles: dict[str, Role] = {name: counted for name, counted in found.items() if counted is not None}
        self._coordinates: dict[tuple[str, str], Variable | None] = {}
        self._decoded: dict[str, Coordinate] = {}
        self._counted: Variable | None = None

    def role(self, variable: Variable) -> Role | None:
        """What a coordinate counts."""
        return self._roles.get(variable.name)

    def all(self, *roles: Role) -> list[Variable]:
        """Every coordinate of the file that counts one of these."""
        return [self.file.variables[name] for name, counted in self._roles.items() if counted in roles]

    def auxiliary(self, variable: Variable, *roles: Role) -> list[Variable]:
        """Coordinates along some of a variable's dimensions: those of their names, then those it names, then others."""
        first = [*variable.dimensions, *_named_coordinates(variable)]
        names = dict.fromkeys([name for name in first if self._roles.get(name) in roles])
        names |= dict.fromkeys(v.name for v in self.all(*roles))
        own = set(variable.dimensions)
        found = [self.file.variables[name] for name in names if name != variable.name]
        return [v for v in found if v.dimensions and own.issuperset(v.dimensions)]

    def coordinate_along(self, variable: Variable, dimension: str) -> Variable | None:
        """The coordinate along one dimension, None where nothing tells what it counts."""
        key = (variable.name, dimension)
        if key not in self._coordinates:
            beside = self.auxiliary(variable, *set(self._roles.values()))
            self._coordinates[key] = next((v for v in beside if v.dimensions == (dimension,)), None)
        return self._coordinates[key]

    def single_value(self, variable: Variable, *roles: Role) -> Variable | None:
        """A coordinate of one value: one that the variable names, otherwise the file's only one."""
        single = [v for v in self.all(*roles) if v.shape in ((), (1,))]
        named = [v for v in single if v.name in _named_coordinates(variable)]
        return named[0] if named else single[0] if len(single) == 1 else None

    def times(self, variable: Variable, meaning: Meaning) -> tuple[Coordinate | None, Coordinate | None]:
        """When a variable's values hold and when the model began [s since 1970]; None where the file does not tell.

        Raises `WindError` for times that cannot be read, or runs and leads that do not fit together.
        """
        along, run = self._auxiliary_times(variable)
        period = next(iter(self.auxiliary(variable, "period")), None)
        if along is not None and (period is None or set(period.dimensions) <= set(along.dimensions)):
            return along, self._runs_from_periods(along, period) if run is None and period is not None else run
        if period is not None or (run is not None and run.dimensions):
            bases = (
                run if run is not None and run.dimensions else None,
                along,
                run,
                self._single_time(variable, "time"),
            )
            base = next((one for one in bases if one is not None), None)
            lead = self._lead_time(variable) if period is None else self._decoded_periods(period)
            if base is None or lead is None:
                what = "leads but not when the forecast began" if base is None else "when forecasts began but no leads"
                raise WindError(f"it tells {what}, so that nobody knows when it holds: add a time")
            return _sum(base, lead), base
        if meaning.quantity in _STATIC:
            return None, None
        valid = self._single_time(variable, "time")
        if valid is None and run is not None and (lead := self._lead_time(variable)) is not None:
            return _sum(run, lead), run
        return valid, run

    def _auxiliary_times(self, variable: Variable) -> tuple[Coordinate | None, Coordinate | None]:
        """Valid times along the variable's dimensions; runs along them, or one for all."""
        times = self.auxiliary(variable, "time")
        valid = max(times, key=lambda v: (len(v.dimensions), v.name.startswith("valid")), default=None)
        along = self._text_times(variable) if valid is None else self._decoded_times(valid)
        runs = self.auxiliary(variable, "run")
        run = self._decoded_times(runs[0]) if runs else self._single_time(variable, "run")
        if run is None and valid is not None and len(valid.dimensions) > 1:
            shorter = [v for v in times if set(v.dimensions) < set(valid.dimensions)]
            run = self._decoded_times(shorter[0]) if shorter else None
        return along, run

    def _runs_from_periods(self, along: Coordinate, period: Variable) -> Coordinate | None:
        """When the model began, by times and leads; None where the leads are in no known unit."""
        try:
            return _sum(along, self._decoded_periods(period), -1.0)
        except WindError:
            return None

    def _decoded_times(self, variable: Variable) -> Coordinate:
        if variable.name not in self._decoded:
            values = moments(variable, self._all_values(variable))
            self._decoded[variable.name] = Coordinate(variable.dimensions, values)
        return self._decoded[variable.name]

    def _decoded_periods(self, variable: Variable) -> Coordinate:
        return Coordinate(variable.dimensions, spans(variable, self._all_values(variable)))

    def _single_time(self, variable: Variable, kind: Role) -> Coordinate | None:
        found = self.single_value(variable, kind)
        return None if found is None else _scalar(self._decoded_times(found))

    def _lead_time(self, variable: Variable) -> Coordinate | None:
        found = self.single_value(variable, "period")
        return None if found is None else _scalar(self._decoded_periods(found))

    def _text_times(self, variable: Variable) -> Coordinate | None:
        """WRF's times, which are text."""
        times = self.file.variables.get("Times")
        if times is None or len(times.dimensions) != 2 or times.dimensions[0] not in variable.dimensions:
            return None
        return Coordinate(times.dimensions[:1], written(self.file.letters(times)))

    def _all_values(self, variable: Variable) -> FloatArray:
        values = self.file.values(variable)
        if not np.isfinite(values).all():
            raise WindError(f"its coordinate {variable.name} has missing values: fill it")
        return values

    def levels(self, variable: Variable, meaning: Meaning) -> Levels:
        """The levels of a variable. Raises `WindError` for several level axes, and units that are not known."""
        axes = [(d, self.coordinate_along(variable, d)) for d in variable.dimensions]
        vertical = [(d, axis) for d, axis in axes if axis is not None and self.role(axis) in LEVELS]
        long = [(d, axis) for d, axis in vertical if self.file.dimensions[d] > 1]
        if len(long) > 1 or (long and meaning.quantity in _ON_THE_SURFACE):
            raise WindError(f"it has levels along {' and '.join(d for d, _ in long)}: too many for what it is")
        if meaning.quantity in _ON_THE_SURFACE:
            return Levels(None, (SURFACE,))
        if long or vertical:
            return self._along((long or vertical)[0][1], variable)
        return Levels(None, (self._level(variable, meaning),))

    def _along(self, axis: Variable, variable: Variable) -> Levels:
        kind = _level_kind(self.role(axis))
        if kind == "model":
            found = model_levels(self.file, axis, variable)
            self._check_counted(axis, found.counted)
            numbers = tuple(Level(kind, float(number)) for number in found.numbers)
            return Levels(axis.dimensions[0], numbers, found.half_levels)
        return Levels(axis.dimensions[0], tuple(_rounded(kind, value) for value in self._in_si(axis, kind)))

    def _check_counted(self, axis: Variable, counted: bool) -> None:
        """Raise `WindError` if levels that are only counted could be taken for others."""
        first = self._counted = self._counted or (axis if counted else None)
        if counted and first is not None and not np.array_equal(self.file.values(axis), self.file.values(first)):
            raise WindError(
                f"its model levels {axis.name} are others than {first.name}, and neither has numbers: bring all to one"
                " axis, or number them from 1 at the top"
            )

    def _in_si(self, axis: Variable, kind: LevelKind) -> FloatArray:
        unit = unit_factor(axis.name, axis.raw_text("units"), PRESSURE if kind == "pressure" else LENGTH)
        return self._all_values(axis).ravel() * unit

    def _level(self, variable: Variable, meaning: Meaning) -> Level:
        """The one level of a variable without an axis for it.

        What the name states with a unit goes before a coordinate of one value, which tools like to give to all
        variables; so does a height that the name only hints at, but a pressure goes before that: `u850` is at 850 hPa.
        """
        if meaning.level is not None:
            return meaning.level
        named = [self.file.variables[name] for name in _named_coordinates(variable) if name in self.file.variables]
        single = [v for v in named if self.role(v) in LEVELS and v.shape in ((), (1,)) and "bounds" not in v.attributes]
        if len(single) == 1:
            kind = _level_kind(self.role(single[0]))
            if kind == "model":
                return Level(kind, float(self._all_values(single[0]).ravel()[0]))
            if kind == "pressure" or meaning.guess is None:
                return _rounded(kind, float(self._in_si(single[0], kind)[0]))
        if meaning.guess is not None:
            return meaning.guess
        at_surface = variable.text("GRIB_typeOfLevel") == "surface" or "surface" in _named_coordinates(variable)
        return SURFACE if at_surface else Level("unknown")


def _named_coordinates(variable: Variable) -> list[str]:
    return variable.raw_text("coordinates").split()


def _level_kind(found: Role | None) -> LevelKind:
    kinds: dict[Role | None, LevelKind] = {"height": "height", "altitude": "altitude", "pressure": "pressure"}
    return kinds.get(found, "model")


def _rounded(kind: LevelKind, value: float) -> Level:
    """A level to seven digits, as many as single precision has: u and v may keep theirs in different ones."""
    return Level(kind, float(f"{value:.7g}"))


def _scalar(coordinate: Coordinate) -> Coordinate:
    return Coordinate((), coordinate.values.reshape(()))


def _sum(first: Coordinate, second: Coordinate, sign: float = 1.0) -> Coordinate:
    """The sum along the dimensions of both."""
    dimensions = (*first.dimensions, *(d for d in second.dimensions if d not in first.dimensions))
    parts = [
        part.values.transpose([part.dimensions.index(d) for d in dimensions if d in part.dimensions]).reshape(
            [part.values.shape[part.dimensions.index(d)] if d in part.dimensions else 1 for d in dimensions]
        )
        for part in (first, second)
    ]
    return Coordinate(dimensions, parts[0] + sign * parts[1])

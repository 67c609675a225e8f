"""Where the wind is from, in words or in a mission file, and how it is read.

`calm`, `8 m/s from 270 deg` (or short, `8@270`), files of a forecast; and how it changes with height: `power:0.143`,
`log:0.1`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal, Protocol, TypeAlias, runtime_checkable

from gcs_windplan import wind as air  # its readers are imported when first asked for: netCDF4 is heavy
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.jobs.missionfile.values import Measure
from gcs_windplan.units import ANGLE, LENGTH, NUMBER, SPEED

if TYPE_CHECKING:
    from gcs_windplan.terrain import Extent, Terrain
    from gcs_windplan.wind import Forecast, LogLaw, PowerLaw, WindField

DAY: Final = 24 * 3600.0  # [s]
_REFERENCE: Final = 10.0  # [m] above ground, where a constant wind is as given
_CALM: Final = "calm"
_CONSTANT: Final = re.compile(r"(.+?)(?:\s+from\s+|\s*@\s*)(.+)")
_LAWS: Final = re.compile(r"(power|log):(.+)")
_SPEED: Final = Measure(SPEED, at_least=0)
_DIRECTION: Final = Measure(ANGLE, at_least=0, at_most=360)
_EXPONENT: Final = Measure(NUMBER, at_least=0, at_most=1)
_ROUGHNESS: Final = Measure(LENGTH, above=0, at_most=_REFERENCE / 2)


@dataclass(frozen=True, slots=True)
class WindProfile:
    """How the wind changes with height above ground: a law with its own figure (exponent, or roughness length [m]).

    The wind is as given at `reference_height` [m].

    >>> import gcs_windplan as gw
    >>> gw.WindProfile("power", 0.143).reference_height
    10.0
    """

    law: Literal["power", "log"]
    figure: float
    reference_height: float = _REFERENCE

    @property
    def function(self) -> PowerLaw | LogLaw:
        """The law as winds take it."""
        return (air.PowerLaw if self.law == "power" else air.LogLaw)(self.reference_height, self.figure)


@dataclass(frozen=True, slots=True, eq=False)
class Surroundings:
    """What a wind is read for: where and when. `lasting` is how long from the departure on [s]."""

    frame: LocalFrame
    terrain: Terrain
    area: Extent
    departure: datetime | None = None
    lasting: float = DAY


@dataclass(frozen=True, slots=True, eq=False)
class LoadedWind:
    """The wind to plan in, those of an ensemble's members, of which it is the mean, and the gusts of each."""

    wind: WindField
    members: tuple[WindField, ...] = ()
    gusts: tuple[WindField, ...] = ()


@runtime_checkable
class WindSource(Protocol):
    """What a wind is read from."""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it is read from."""

    def load(self, where: Surroundings, profile: WindProfile | None) -> LoadedWind:
        """The wind there. Raises `WindError`."""


@dataclass(frozen=True, slots=True)
class GivenWind:
    """A wind that is there already, in the mission's local frame."""

    field: WindField
    files: tuple[Path, ...] = ()

    def load(self, where: Surroundings, profile: WindProfile | None) -> LoadedWind:
        """The wind itself, or with a profile over the ground."""
        return LoadedWind(_over_ground(self.field, where, profile))


@dataclass(frozen=True, slots=True)
class SameWind:
    """The same wind everywhere: its speed [m/s], and the true direction that it blows from [deg]."""

    speed: float
    from_deg: float
    files: tuple[Path, ...] = ()

    def field(self, frame: LocalFrame | None = None) -> WindField:
        """The wind in a local frame; without one its north is true north."""
        return air.ConstantWind.from_direction(self.speed, self.from_deg, frame)

    def load(self, where: Surroundings, profile: WindProfile | None) -> LoadedWind:
        """The wind, or with a profile over the ground."""
        return LoadedWind(_over_ground(self.field(where.frame), where, profile))


@dataclass(frozen=True, slots=True)
class ForecastFiles:
    """A forecast or reanalysis in files; `members` of an ensemble; `extend`: outside its area the nearest values."""

    files: tuple[Path, ...]
    members: Literal["all"] | tuple[int, ...] | None = None
    extend: bool = False

    def load(self, where: Surroundings, profile: WindProfile | None) -> LoadedWind:
        """The winds of the files."""
        forecast = self.read(where, profile)
        return LoadedWind(forecast.mean, forecast.fields if len(forecast.fields) > 1 else (), forecast.gusts)

    def read(self, where: Surroundings, profile: WindProfile | None) -> Forecast:
        """The forecast in the files. Raises `WindError`."""
        area, edge = where.area, where.terrain.extent
        query = air.ForecastQuery(
            frame=where.frame,
            ground=where.terrain.heights_at,
            departure=where.departure,
            lasting=where.lasting,
            area=(
                max(area.west, edge.west),
                max(area.south, edge.south),
                min(area.east, edge.east),
                min(area.north, edge.north),
            ),
            extend=self.extend,
            members=self.members,
            exponent=profile.figure if profile is not None and profile.law == "power" else None,
            roughness=profile.figure if profile is not None and profile.law == "log" else None,
            carried=profile is not None,
            known_height=None if profile is None else profile.reference_height,
            ground_resolution=where.terrain.resolution,
        )
        return air.read_forecast(self.files, query)


#: A file or several, `8 m/s from 270 deg`, `calm`, or a wind: a source of one, or itself.
WindWords: TypeAlias = "str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | WindSource | WindField"


def as_wind(
    words: WindWords, *, members: Literal["all"] | Sequence[int] | None = None, extend: bool = False
) -> WindSource:
    """The source that words or a value say; members and extend are of a forecast's files. Raises `ValueError`."""
    if isinstance(words, str | os.PathLike):
        words = [words]
    if not isinstance(words, Sequence):
        return words if isinstance(words, WindSource) else GivenWind(words)
    names = [os.fspath(word) for word in words]
    if not names or names == [_CALM]:
        return GivenWind(air.Calm())
    if len(names) == 1 and not Path(names[0]).exists():
        if same := _CONSTANT.fullmatch(names[0]):
            return SameWind(_SPEED.read(same[1]), _DIRECTION.read(same[2]))
        if _SPEED.read_or_none(names[0]) is not None:
            raise ValueError(f"{names[0]!r} says no direction: write '{names[0]} from 270'")
    chosen = members if members is None or members == "all" else tuple(map(int, members))
    return ForecastFiles(tuple(map(Path, names)), chosen, extend)


def as_profile(words: WindProfile | str | None) -> WindProfile | None:
    """The profile that words say: `power:0.143`, `log:0.1`. Raises `ValueError`."""
    if words is None or isinstance(words, WindProfile):
        return words
    named = _LAWS.fullmatch(words)
    if named is None:
        raise ValueError(f"{words!r} is no law: write power:EXPONENT or log:ROUGHNESS, power:0.143")
    if named[1] == "power":
        return WindProfile("power", _EXPONENT.read(named[2]))
    return WindProfile("log", _ROUGHNESS.read(named[2]))


def _over_ground(field: WindField, where: Surroundings, profile: WindProfile | None) -> WindField:
    if profile is None:
        return field
    return air.ProfileWind(field, where.terrain.heights_at, profile.function, where.terrain.resolution)

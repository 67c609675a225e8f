"""Terrain and wind by the words of options: files, `sample:jacksboro`, `flat:120`, `8 m/s from 270`."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from gcs_windplan.errors import InputError, Problem

if TYPE_CHECKING:
    from gcs_windplan.geo.frame import LocalFrame
    from gcs_windplan.terrain import Extent, Terrain
    from gcs_windplan.wind import ForecastQuery, LogLaw, PowerLaw, WindField

T = TypeVar("T")

_LASTING: Final = 24 * 3600.0  # [s]
_SPARE: Final = 1000.0  # [m] of plain around everything
_REFERENCE: Final = 10.0  # [m] above ground, where a constant wind is as given
_FLAT: Final = re.compile(r"flat:(.+)")
_CONSTANT: Final = re.compile(r"(.+?)\s+from\s+(.+)")
_LAWS: Final = re.compile(r"(power|log):(.+)")


@dataclass(frozen=True, slots=True)
class Air:
    """The wind as options name it: files, or one wind in words; how it changes with height; whether it is extended."""

    names: tuple[str, ...] = ()
    profile: str | None = None
    extended: bool = False


def is_file(name: str) -> bool:
    """Whether the word of an option names a file."""
    return not (name.startswith("sample:") or _FLAT.fullmatch(name) or _CONSTANT.fullmatch(name))


def terrain_by_name(names: Sequence[str], frame: LocalFrame, area: Extent) -> Terrain:
    """The ground in files, or the one that a word names. Raises `TerrainError`, or `InputError` for a word unknown."""
    from gcs_windplan import terrain as ground
    from gcs_windplan.jobs.missionfile.values import SIGNED_LENGTH

    if list(names) == ["sample:jacksboro"]:
        return ground.sample_dem(frame, area)
    if len(names) == 1 and (plain := _FLAT.fullmatch(names[0])):
        size = 2 * max(abs(area.west), abs(area.east), abs(area.south), abs(area.north)) + _SPARE
        return ground.flat(size, told("--terrain", lambda: SIGNED_LENGTH.read(plain[1])))
    words = [name for name in names if not is_file(name)]
    if words:
        text = f"{words[0]!r} is no terrain: name files, or sample:jacksboro or flat:ALTITUDE alone"
        raise InputError(Problem(text, "--terrain"))
    return ground.read_dem([Path(name) for name in names], frame, area)


def winds_by_name(
    air: Air, frame: LocalFrame, terrain: Terrain, area: Extent, departure: datetime | None
) -> tuple[WindField, tuple[WindField, ...]]:
    """The wind in files, or the one in words, still air without either; and its gusts. Raises `WindError`."""
    from gcs_windplan import wind

    law = _law(air.profile)
    if not air.names:
        if law is not None:
            raise InputError(Problem("belongs only beside --wind", "--profile"))
        return wind.Calm(), ()
    if len(air.names) == 1 and (plain := _CONSTANT.fullmatch(air.names[0])):
        field = _constant(plain[1], plain[2], frame)
        return (field if law is None else wind.ProfileWind(field, terrain.heights_at, law, terrain.resolution)), ()
    query = _forecast_query(air, law, frame, terrain, area, departure)
    forecast = wind.read_forecast([Path(name) for name in air.names], query)
    return forecast.mean, forecast.gusts


def told(option: str, read: Callable[[], T]) -> T:
    """What is read, with the option's name in front of errors."""
    try:
        return read()
    except ValueError as error:
        raise InputError(Problem(str(error), option)) from None


def _constant(speed: str, direction: str, frame: LocalFrame) -> WindField:
    """The same wind everywhere."""
    from gcs_windplan import wind
    from gcs_windplan.jobs.missionfile.values import Measure
    from gcs_windplan.units import ANGLE, SPEED

    blows = told("--wind", lambda: Measure(SPEED, at_least=0).read(speed))
    whence = told("--wind", lambda: Measure(ANGLE, at_least=0, at_most=360).read(direction))
    return wind.ConstantWind.from_direction(blows, whence, frame)


def _law(text: str | None) -> PowerLaw | LogLaw | None:
    """How the wind changes with height: `power:0.143`, `log:0.1`."""
    from gcs_windplan import wind
    from gcs_windplan.jobs.missionfile.values import Measure
    from gcs_windplan.units import LENGTH, NUMBER

    if text is None:
        return None
    named = _LAWS.fullmatch(text)
    if named is None:
        raise InputError(
            Problem(f"{text!r} is no law: write power:EXPONENT or log:ROUGHNESS, power:0.143", "--profile")
        )
    if named[1] == "power":
        return wind.PowerLaw(
            _REFERENCE, told("--profile", lambda: Measure(NUMBER, at_least=0, at_most=1).read(named[2]))
        )
    roughness = told("--profile", lambda: Measure(LENGTH, above=0, at_most=_REFERENCE / 2).read(named[2]))
    return wind.LogLaw(_REFERENCE, roughness)


def _forecast_query(
    air: Air,
    law: PowerLaw | LogLaw | None,
    frame: LocalFrame,
    terrain: Terrain,
    area: Extent,
    departure: datetime | None,
) -> ForecastQuery:
    """What is asked of the forecast's files."""
    from gcs_windplan import wind

    edge = terrain.extent
    return wind.ForecastQuery(
        frame=frame,
        ground=terrain.heights_at,
        departure=departure,
        lasting=_LASTING,
        area=(
            max(area.west, edge.west),
            max(area.south, edge.south),
            min(area.east, edge.east),
            min(area.north, edge.north),
        ),
        extend=air.extended,
        exponent=law.exponent if isinstance(law, wind.PowerLaw) else None,
        roughness=law.roughness if isinstance(law, wind.LogLaw) else None,
        carried=law is not None,
        known_height=None if law is None else law.reference,
        ground_resolution=terrain.resolution,
    )

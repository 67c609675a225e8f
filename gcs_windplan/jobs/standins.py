"""A stand-in vehicle from words: whose rules it keeps, where it stands, in which wind it flies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.missionfile.values import AIRSPEED
from gcs_windplan.jobs.places import PlaceWords, as_place
from gcs_windplan.jobs.winds import GivenWind, SameWind, WindSource, WindWords, as_wind
from gcs_windplan.jobs.words import Naming, read_as
from gcs_windplan.mission import Home
from gcs_windplan.mission.firmware import autopilots, firmware_of
from gcs_windplan.standin.rules import ServerOptions
from gcs_windplan.standin.vehicle import StandInOptions, planned_profile
from gcs_windplan.standin.world import planned_world, simulator_world, world_at

if TYPE_CHECKING:
    from gcs_windplan.planning.request import Request
    from gcs_windplan.vehicle import Autopilot
    from gcs_windplan.wind import WindField


def standin_options(
    mission: Path | None,
    server: ServerOptions,
    *,
    autopilot: str | None = None,
    wind: WindWords | None = None,
    airspeed: float | str | None = None,
    home: PlaceWords | None = None,
    speedup: float = 1.0,
    fly: bool = False,
    on_note: Callable[[str], None] = print,
    named: Naming = str,
) -> StandInOptions:
    """What a stand-in plays: a mission file's wind, terrain and vehicle, or a level world around `home`.

    `wind`, `airspeed`, `autopilot` and `home` take the place of the mission's. Raises `InputError`.
    """
    source = None if wind is None else read_as(named("wind"), lambda: as_wind(wind))
    place = None if home is None else _home(home, named)
    request = None if mission is None else _request(mission, source)
    firmware = firmware_of(_autopilot(autopilot, request, named), "multicopter")
    if request is not None and not request.vehicle.hovers:
        on_note("the mission's vehicle is a fixed-wing; the stand-in flies as a multicopter")
    if request is not None:
        world = planned_world(request, place)
    else:
        field = None if source is None else _steady(source, named)
        world = world_at(place, field) if place is not None else simulator_world(firmware, field)
    profile = planned_profile(firmware, request.vehicle if request is not None else None)
    if airspeed is not None:
        profile = replace(profile, airspeed=read_as(named("airspeed"), lambda: AIRSPEED.read(airspeed)))
    return StandInOptions(firmware, profile, world, server=server, speedup=speedup, fly=fly)


def _request(path: Path, wind: WindSource | None) -> Request:
    """The mission file's request, in another wind if one is given."""
    from gcs_windplan.jobs.missionfile import read_mission
    from gcs_windplan.jobs.requests import request_of  # what plans is heavy, and a stand-in need not wait for it

    mission = read_mission(path)
    return request_of(mission if wind is None else replace(mission, wind=wind, profile=None))


def _autopilot(name: str | None, request: Request | None, named: Naming) -> Autopilot:
    if name is None:
        return request.vehicle.autopilot if request is not None else "ardupilot"
    if name not in autopilots():
        raise InputError(Problem(f"{name!r} is none of {', '.join(autopilots())}", named("autopilot")))
    return name


def _home(words: PlaceWords, named: Naming) -> Home:
    """A home, which needs its altitude: no terrain tells it."""
    place = read_as(named("home"), lambda: as_place(words))
    if place.altitude is None or not isinstance(place.point, GeoPoint):
        text = f"{words!r} has no altitude above mean sea level; write LAT,LON,ALT, for example 47.3977,8.5456,488"
        raise InputError(Problem(text, named("home")))
    return Home(place.point, place.altitude)


def _steady(source: WindSource, named: Naming) -> WindField:
    """A wind that needs no terrain."""
    if isinstance(source, SameWind):
        return source.field()
    if isinstance(source, GivenWind):
        return source.field
    raise InputError(Problem(f"a forecast needs {named('mission')}, whose place and time it is for", named("wind")))

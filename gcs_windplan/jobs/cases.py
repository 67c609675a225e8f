"""A drawn mission with the terrain, wind and vehicle that criteria name: the case that is judged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from gcs_windplan.assessment import AssessmentLimits, Case
from gcs_windplan.assessment.planned import pace_with_rates
from gcs_windplan.errors import InputError, Problem, WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.jobs.criteria import Criteria
from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.jobs.sources import source, sources_of_terrain, sources_of_wind
from gcs_windplan.jobs.terrains import TerrainSource, as_terrain
from gcs_windplan.jobs.winds import GivenWind, LoadedWind, Surroundings, WindSource, as_profile, as_wind
from gcs_windplan.jobs.words import read_as
from gcs_windplan.mission import MissionItems
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.scene import Scene
from gcs_windplan.terrain import Extent
from gcs_windplan.vehicle import Airframe, Autopilot, MotionProfile, VehicleType
from gcs_windplan.wind import Calm

if TYPE_CHECKING:
    from collections.abc import Iterator

    from gcs_windplan.assessment import Source

_FARTHEST: Final = 300_000.0  # [m] from the first place: the local frame's distances are good to some metres over it
_SPARE: Final = 1000.0  # [m] of ground and wind around the mission


def case_by_criteria(mission: MissionItems, name: str, file: Path | None, criteria: Criteria) -> Case:
    """The mission and what the criteria say it is judged by. Raises `InputError`."""
    terrain_source, wind_source = _terrain_source(criteria), _wind_source(criteria)
    airframe = _airframe(criteria)
    autopilot, kind, remarks = _vehicle_of(mission, airframe, criteria, file)
    mission = replace(mission, autopilot=autopilot, vehicle_type=kind)
    frame = _frame(mission, criteria, file)
    area = _area(mission, frame, criteria)
    terrain = terrain_source.load(frame, area)
    where = Surroundings(frame, terrain, area, criteria.moment)
    winds = _winds(wind_source, criteria, where)
    if criteria.wind is None:
        remarks += (f"no {criteria.named('wind')} was given: the air is taken to be still",)
    pace = _pace(autopilot, airframe)
    if airframe is None:
        remarks += (_unknown_vehicle(kind, autopilot, pace, criteria),)
    case = Case(
        name=name,
        mission=mission,
        scene=Scene(frame, terrain, winds.wind, winds.members, winds.gusts, departure=criteria.moment),
        autopilot=autopilot,
        vehicle_type=kind,
        pace=pace,
        cruise=_cruise(mission, airframe, autopilot),
        limits=criteria.limits_with(_own_limits(airframe), defaults=True),
        airframe=airframe,
        remarks=remarks,
    )
    case = criteria.with_home(case)
    return replace(case, sources=tuple(_sources(terrain_source, wind_source, case, criteria)))


def _terrain_source(criteria: Criteria) -> TerrainSource:
    words, named = criteria.terrain, criteria.named
    if words is None:
        text = (
            f"is needed to judge a mission file: heights from a GeoTIFF or SRTM tile ({named('terrain')} dem.tif),"
            f" sample:jacksboro, or flat:ALTITUDE; or {named('by')} MISSION.yaml takes the world of a mission file"
        )
        raise criteria.error("terrain", text)
    return read_as(named("terrain"), lambda: as_terrain(words))


def _wind_source(criteria: Criteria) -> WindSource:
    words = criteria.wind
    if words is not None:
        return read_as(criteria.named("wind"), lambda: as_wind(words, extend=criteria.extend))
    if criteria.profile is not None:
        raise criteria.error("profile", f"belongs only beside {criteria.named('wind')}")
    return GivenWind(Calm())


def _winds(source: WindSource, criteria: Criteria, where: Surroundings) -> LoadedWind:
    """The wind there. Raises `InputError` for an ensemble of which no members were chosen."""
    profile = read_as(criteria.named("profile"), lambda: as_profile(criteria.profile))
    try:
        return source.load(where, profile)
    except WindError as error:
        if error.reason != "members":
            raise
        names, members = ", ".join(map(str, source.files)), error.members
        text = (
            f"{names}: it holds an ensemble of {len(members)} members ({members[0]} to {members[-1]}): judge by a"
            f" mission file that names it, with `wind: members: all` there ({criteria.named('by')} MISSION.yaml)"
        )
        raise criteria.error("wind", text) from None


def _airframe(criteria: Criteria) -> Airframe | None:
    vehicle = criteria.vehicle
    return vehicle if vehicle is None or isinstance(vehicle, Airframe) else read_airframe(Path(vehicle))


def _vehicle_of(
    mission: MissionItems, airframe: Airframe | None, criteria: Criteria, file: Path | None
) -> tuple[Autopilot, VehicleType, tuple[str, ...]]:
    """Autopilot and kind of vehicle, and what was assumed."""
    remarks: tuple[str, ...] = ()
    autopilot = criteria.autopilot or mission.autopilot or (airframe.vehicle.autopilot if airframe else None)
    if autopilot is None:
        said = (
            f"the mission names no autopilot: ArduPilot is taken; say {criteria.named('autopilot')} px4 for the other"
        )
        autopilot, remarks = "ardupilot", (said,)
    kind = criteria.vehicle_type or mission.vehicle_type
    if airframe is not None:
        if kind is not None and kind != airframe.vehicle.type:
            text = f"is of a {airframe.vehicle.type} ({airframe.name}), and {file or 'this'} is a {kind}'s mission"
            raise criteria.error("vehicle", f"{text}: give another airframe")
        kind = airframe.vehicle.type
    if kind is None:
        said = (
            f"the mission names no kind of vehicle: a multicopter is taken; say {criteria.named('vehicle_type')}"
            " fixed-wing for the other"
        )
        kind, remarks = "multicopter", (*remarks, said)
    return autopilot, kind, remarks


def _unknown_vehicle(kind: VehicleType, autopilot: Autopilot, pace: MotionProfile, criteria: Criteria) -> str:
    """What is said where no airframe is known."""
    given = f"no {criteria.named('vehicle')} was given: energy is not known, and"
    if kind == "fixed-wing":
        return f"{given} it cruises at the mission's or its autopilot's speed"
    who = firmware_of(autopilot, "multicopter").name
    return f"{given} the vehicle is taken to reach {pace.airspeed:g} m/s through the air ({who}'s default lean)"


def _pace(autopilot: Autopilot, airframe: Airframe | None) -> MotionProfile:
    pace = firmware_of(autopilot).motion
    if airframe is None:
        return pace
    return pace_with_rates(replace(pace, airspeed=airframe.maximum_airspeed), airframe.vehicle)


def _cruise(mission: MissionItems, airframe: Airframe | None, autopilot: Autopilot) -> float:
    """The airspeed of a fixed-wing [m/s]."""
    if airframe is not None:
        return airframe.vehicle.airspeed
    return firmware_of(autopilot).cruise if mission.cruise_speed is None else mission.cruise_speed


def _own_limits(airframe: Airframe | None) -> AssessmentLimits:
    if airframe is None:
        return AssessmentLimits()
    vehicle = airframe.vehicle
    return AssessmentLimits(climb=vehicle.climb, descent=vehicle.descent, airspeed=airframe.maximum_airspeed)


def _places(mission: MissionItems, criteria: Criteria) -> list[tuple[str, GeoPoint]]:
    """All places of a mission, with what they are."""
    places = [
        (f"item {n}", GeoPoint(item.latitude_deg, item.longitude_deg))
        for n, item in enumerate(mission.items, start=1)
        if item.has_place
    ]
    given = criteria.home_point
    if given is not None:
        places.append((criteria.named("home"), given))
    elif mission.home is not None:
        places.append(("home", mission.home.point))
    return places


def _frame(mission: MissionItems, criteria: Criteria, file: Path | None) -> LocalFrame:
    """The local frame about the middle of all places. Raises `InputError` without any, and for one too far away."""
    places = _places(mission, criteria)
    say_home = criteria.named("home")
    if not places or not mission.items:
        text = f"names neither home nor any place: say where it begins with {say_home}"
        raise InputError(Problem(text, file=file))
    latitudes = np.array([point.latitude_deg for _, point in places])
    longitudes = np.array([point.longitude_deg for _, point in places])
    about = LocalFrame(places[0][1])
    here = about.to_local(latitudes, longitudes)
    away = np.hypot(*here.T)
    worst = int(np.argmax(away))
    if away[worst] > _FARTHEST:
        text = f"{places[worst][0]} lies {away[worst] / 1000:.0f} km from {places[0][0]}; a mission spans at most"
        raise InputError(
            Problem(f"{text} {_FARTHEST / 1000:.0f} km: correct one of them, or give {say_home}", file=file)
        )
    middle = (here.min(axis=0) + here.max(axis=0)) / 2
    latitude, longitude = about.to_geographic(middle[None])
    return LocalFrame(GeoPoint(float(latitude[0]), float(longitude[0])))


def _area(mission: MissionItems, frame: LocalFrame, criteria: Criteria) -> Extent:
    """The box of the mission with something to spare."""
    points = [point for _, point in _places(mission, criteria)] + [rally.point for rally in mission.rally]
    here = frame.to_local(
        np.array([point.latitude_deg for point in points]), np.array([point.longitude_deg for point in points])
    )
    here = here[np.hypot(*here.T) <= _FARTHEST]
    margin = max(_SPARE, 0.25 * float(np.ptp(here, axis=0).max()))
    west, south = here.min(axis=0) - margin
    east, north = here.max(axis=0) + margin
    return Extent(float(west), float(south), float(east), float(north))


def _sources(terrain: TerrainSource, wind: WindSource, case: Case, criteria: Criteria) -> Iterator[Source]:
    """What the criteria name."""
    yield from sources_of_terrain(terrain, case.scene.terrain.name, f"heights in {case.scene.terrain.vertical_datum}")
    yield from sources_of_wind(wind, case.scene.wind.name)
    if criteria.vehicle is not None and not isinstance(criteria.vehicle, Airframe):
        yield source("vehicle", Path(criteria.vehicle), "" if case.airframe is None else case.airframe.name)

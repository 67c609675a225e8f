"""What `gcs-windplan review` judges by, from its options: terrain, wind, vehicle, home, limits."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

from gcs_windplan.cli.surroundings import Air, terrain_by_name, told, winds_by_name
from gcs_windplan.errors import InputError, Problem, WindError

if TYPE_CHECKING:
    from gcs_windplan.assessment import Case, Limits
    from gcs_windplan.geo.frame import GeoPoint, LocalFrame
    from gcs_windplan.mission import Home, Mission
    from gcs_windplan.terrain import Extent, Terrain
    from gcs_windplan.vehicle import Airframe, Autopilot, MotionProfile, VehicleType
    from gcs_windplan.wind import WindField

_FARTHEST: Final = 300_000.0  # [m] from the first place: the local frame's distances are good to some metres over it
_SPARE: Final = 1000.0  # [m] of ground and wind around the mission
_NEEDED: Final = (
    "is needed to judge a mission file: heights from a GeoTIFF or SRTM tile (--terrain dem.tif), sample:jacksboro, or"
    " flat:ALTITUDE; or --by MISSION.yaml takes the world of a mission file"
)


@dataclass(frozen=True, slots=True)
class Options:
    """The options as written; None where they were not."""

    terrain: tuple[str, ...] = ()
    wind: tuple[str, ...] = ()
    profile: str | None = None
    extend: str | None = None
    departure: str | None = None
    vehicle: Path | None = None
    autopilot: Autopilot | None = None
    vehicle_type: VehicleType | None = None
    home: str | None = None
    clearance: str | None = None
    max_height: str | None = None
    max_wind: str | None = None
    max_gust: str | None = None
    min_battery: str | None = None
    first_leg: str | None = None

    @property
    def world(self) -> tuple[str, ...]:
        """The names of the options given that a mission file settles by itself."""
        given = {"--terrain": self.terrain, "--wind": self.wind, "--vehicle": self.vehicle, "--profile": self.profile,
                 "--extend": self.extend, "--autopilot": self.autopilot,
                 "--vehicle-type": self.vehicle_type}  # fmt: skip
        return tuple(name for name, value in given.items() if value)


def case_by_options(mission: Mission, name: str, file: Path, options: Options) -> Case:
    """The mission and what the options say it is judged by. Raises `InputError`."""
    from gcs_windplan.assessment import Case

    if not options.terrain:
        raise InputError(Problem(_NEEDED, "--terrain"))
    airframe = None if options.vehicle is None else _airframe(options.vehicle)
    autopilot, kind, remarks = _vehicle_of(mission, airframe, options, file)
    mission = replace(mission, autopilot=autopilot, vehicle_type=kind)
    frame = _frame(mission, options, file)
    area = _area(mission, frame, options)
    terrain = terrain_by_name(options.terrain, frame, area)
    departure = read_departure(options)
    air = Air(options.wind, options.profile, options.extend == "nearest")
    wind, gusts = _winds(air, frame, terrain, area, departure)
    if not options.wind:
        remarks += ("no --wind was given: the air is taken to be still",)
    pace = _pace(autopilot, airframe)
    if airframe is None:
        remarks += (_unknown_vehicle(kind, autopilot, pace),)
    case = Case(
        name=name,
        mission=mission,
        frame=frame,
        terrain=terrain,
        wind=wind,
        autopilot=autopilot,
        vehicle_type=kind,
        pace=pace,
        cruise=_cruise(mission, airframe, autopilot),
        limits=limits_with(_own_limits(airframe), options, defaults=True),
        airframe=airframe,
        gusts=gusts,
        departure=departure,
        remarks=remarks,
    )
    return with_given_home(case, options)


def with_given_home(case: Case, options: Options) -> Case:
    """The case with the home that the options name, on the ground where they name no altitude.

    Raises `InputError` where they limit what the case does not know.
    """
    _refuse_limits_unknown(case, options)
    if options.home is None:
        return case
    from gcs_windplan.assessment.home import ground_at
    from gcs_windplan.mission import Home

    point, altitude = read_home(options.home)
    if altitude is None:
        altitude = ground_at(point, case)
        if math.isnan(altitude):
            raise InputError(Problem(f"{point} lies outside of the terrain: write its altitude too", "--home"))
    mission = replace(case.mission, home=Home(point, altitude))
    return replace(case, mission=mission, home_is_given=True)


def _refuse_limits_unknown(case: Case, options: Options) -> None:
    """A limit of gusts that no forecast tells, or of a battery that no airframe has, would be kept by anything."""
    if options.max_gust is not None and not case.gusts:
        text = f"no gusts are told by the wind ({case.wind.name}): leave it out, or take a forecast with gusts"
        raise InputError(Problem(text, "--max-gust"))
    if options.min_battery is not None and case.airframe is None:
        raise InputError(Problem("the battery is not known: leave it out, or give an airframe", "--min-battery"))


def limits_with(own: Limits, options: Options, defaults: bool = False) -> Limits:
    """The limits with those that the options name; `defaults` fills in a clearance of 30 m and a first leg of 500 m."""
    from gcs_windplan.jobs.missionfile.values import CLEARANCE, HEIGHT, Measure
    from gcs_windplan.units import SHARE, SPEED

    speed, share = Measure(SPEED, above=0), Measure(SHARE, at_least=0, at_most=1)
    asked = {
        "clearance": ("--clearance", options.clearance, HEIGHT),
        "max_height": ("--max-height", options.max_height, CLEARANCE),
        "wind": ("--max-wind", options.max_wind, speed),
        "gust": ("--max-gust", options.max_gust, speed),
        "battery": ("--min-battery", options.min_battery, share),
        "first_leg": ("--first-leg", options.first_leg, CLEARANCE),
    }
    read = {
        field: told(option, lambda measure=measure, text=text: measure.read(text))  # type: ignore[misc]
        for field, (option, text, measure) in asked.items()
        if text is not None
    }
    usual = {"clearance": 30.0, "first_leg": 500.0} if defaults else {}
    return replace(own, **{**usual, **read})


def read_departure(options: Options) -> datetime | None:
    """The departure that the options name."""
    from gcs_windplan.jobs.missionfile.values import Moment

    text = options.departure
    return None if text is None else told("--departure", lambda: Moment().read(text))


def read_home(text: str) -> tuple[GeoPoint, float | None]:
    """Latitude, longitude and perhaps the altitude AMSL [m] of a home."""
    from gcs_windplan.geo.frame import GeoPoint
    from gcs_windplan.jobs.missionfile.values import LATITUDE, LONGITUDE, SIGNED_LENGTH

    parts = text.split(",")
    if len(parts) not in (2, 3):
        raise InputError(Problem(f"{text!r} is no place; write LAT,LON or LAT,LON,ALT: 46.81,9.84,1560", "--home"))
    latitude, longitude = (
        told("--home", lambda m=m, p=p: m.read(p))  # type: ignore[misc]
        for m, p in ((LATITUDE, parts[0]), (LONGITUDE, parts[1]))
    )
    altitude = told("--home", lambda: SIGNED_LENGTH.read(parts[2])) if len(parts) == 3 else None
    return GeoPoint(latitude, longitude), altitude


def _airframe(path: Path) -> Airframe:
    from gcs_windplan.jobs.missionfile.airframe import read_airframe

    return read_airframe(path)


def _vehicle_of(
    mission: Mission, airframe: Airframe | None, options: Options, file: Path
) -> tuple[Autopilot, VehicleType, tuple[str, ...]]:
    """Autopilot and kind of vehicle, and what was assumed."""
    remarks: tuple[str, ...] = ()
    autopilot = options.autopilot or mission.autopilot or (airframe.vehicle.autopilot if airframe else None)
    if autopilot is None:
        autopilot, remarks = (
            "ardupilot",
            ("the mission names no autopilot: ArduPilot is taken; say --autopilot px4 for the other",),
        )
    kind = options.vehicle_type or mission.vehicle_type
    if airframe is not None:
        if kind is not None and kind != airframe.vehicle.type:
            text = f"is of a {airframe.vehicle.type} ({airframe.name}), and {file} is a {kind}'s mission"
            raise InputError(Problem(f"{text}: give another airframe", "--vehicle"))
        kind = airframe.vehicle.type
    if kind is None:
        said = (
            "the mission names no kind of vehicle: a multicopter is taken; say --vehicle-type fixed-wing for the other"
        )
        kind, remarks = "multicopter", (*remarks, said)
    return autopilot, kind, remarks


def _unknown_vehicle(kind: VehicleType, autopilot: Autopilot, pace: MotionProfile) -> str:
    """What is said where no airframe is known."""
    if kind == "fixed-wing":
        return "no --vehicle was given: energy is not known, and it cruises at the mission's or its autopilot's speed"
    from gcs_windplan.mission.firmware import firmware_of

    who = firmware_of(autopilot, "multicopter").name
    return (
        f"no --vehicle was given: energy is not known, and the vehicle is taken to reach {pace.airspeed:g} m/s through"
        f" the air ({who}'s default lean)"
    )


def _winds(
    air: Air, frame: LocalFrame, terrain: Terrain, area: Extent, departure: datetime | None
) -> tuple[WindField, tuple[WindField, ...]]:
    """Wind and gusts by name. Raises `InputError` for a speed without a direction, and for an ensemble."""
    for name in air.names:
        if not Path(name).exists() and _is_speed(name):
            raise InputError(Problem(f"{name!r} says no direction: write '{name} from 270'", "--wind"))
    try:
        return winds_by_name(air, frame, terrain, area, departure)
    except WindError as error:
        holds, ensemble, _ = str(error).partition(": say `members")
        if not ensemble:
            raise
        text = f"{holds}: judge by a mission file that names it, with `wind: members: all` there (--by MISSION.yaml)"
        raise InputError(Problem(text, "--wind")) from None


def _is_speed(text: str) -> bool:
    """Whether words are a speed and nothing else."""
    from gcs_windplan.jobs.missionfile.values import Measure
    from gcs_windplan.units import SPEED

    try:
        Measure(SPEED, at_least=0).read(text)
    except ValueError:
        return False
    return True


def _pace(autopilot: Autopilot, airframe: Airframe | None) -> MotionProfile:
    from gcs_windplan.assessment.planned import pace_with_rates
    from gcs_windplan.mission.firmware import firmware_of

    pace = firmware_of(autopilot).motion
    if airframe is None:
        return pace
    return pace_with_rates(replace(pace, airspeed=airframe.maximum_airspeed), airframe.vehicle)


def _cruise(mission: Mission, airframe: Airframe | None, autopilot: Autopilot) -> float:
    """The airspeed of a fixed-wing [m/s]."""
    from gcs_windplan.mission.firmware import firmware_of

    if airframe is not None:
        return airframe.vehicle.airspeed
    return firmware_of(autopilot).cruise if mission.cruise_speed is None else mission.cruise_speed


def _own_limits(airframe: Airframe | None) -> Limits:
    from gcs_windplan.assessment import Limits

    if airframe is None:
        return Limits()
    vehicle = airframe.vehicle
    return Limits(climb=vehicle.climb, descent=vehicle.descent, airspeed=airframe.maximum_airspeed)


def _places(mission: Mission, options: Options) -> list[tuple[str, GeoPoint]]:
    """All places of a mission, with what they are."""
    from gcs_windplan.geo.frame import GeoPoint

    places = [
        (f"item {n}", GeoPoint(item.latitude_deg, item.longitude_deg))
        for n, item in enumerate(mission.items, start=1)
        if item.has_place
    ]
    home: Home | None = mission.home
    if options.home is not None:
        places.append(("--home", read_home(options.home)[0]))
    elif home is not None:
        places.append(("home", home.point))
    return places


def _frame(mission: Mission, options: Options, file: Path) -> LocalFrame:
    """The local frame about the middle of all places. Raises `InputError` without any, and for one too far away."""
    import numpy as np

    from gcs_windplan.geo.frame import GeoPoint, LocalFrame

    places = _places(mission, options)
    if not places or not mission.items:
        raise InputError(Problem("names neither home nor any place: say where it begins with --home", file=file))
    latitudes = np.array([point.latitude_deg for _, point in places])
    longitudes = np.array([point.longitude_deg for _, point in places])
    about = LocalFrame(places[0][1])
    here = about.to_local(latitudes, longitudes)
    away = np.hypot(*here.T)
    worst = int(np.argmax(away))
    if away[worst] > _FARTHEST:
        text = f"{places[worst][0]} lies {away[worst] / 1000:.0f} km from {places[0][0]}; a mission spans at most"
        raise InputError(Problem(f"{text} {_FARTHEST / 1000:.0f} km: correct one of them, or give --home", file=file))
    middle = (here.min(axis=0) + here.max(axis=0)) / 2
    latitude, longitude = about.to_geographic(middle[None])
    return LocalFrame(GeoPoint(float(latitude[0]), float(longitude[0])))


def _area(mission: Mission, frame: LocalFrame, options: Options) -> Extent:
    """The box of the mission with something to spare."""
    import numpy as np

    from gcs_windplan.terrain import Extent

    points = [point for _, point in _places(mission, options)] + [rally.point for rally in mission.rally]
    here = frame.to_local(
        np.array([point.latitude_deg for point in points]), np.array([point.longitude_deg for point in points])
    )
    here = here[np.hypot(*here.T) <= _FARTHEST]
    margin = max(_SPARE, 0.25 * float(np.ptp(here, axis=0).max()))
    west, south = here.min(axis=0) - margin
    east, north = here.max(axis=0) + margin
    return Extent(float(west), float(south), float(east), float(north))

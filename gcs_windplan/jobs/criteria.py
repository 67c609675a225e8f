"""What a mission is judged by, in words: terrain, wind, vehicle, home, limits."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

from gcs_windplan.assessment import AssessmentLimits, Case
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.jobs.mission import as_moment
from gcs_windplan.jobs.missionfile.values import CLEARANCE, HEIGHT, Measure
from gcs_windplan.jobs.places import Place, PlaceWords, as_place
from gcs_windplan.jobs.terrains import TerrainWords
from gcs_windplan.jobs.winds import WindProfile, WindWords
from gcs_windplan.jobs.words import Naming, read_as
from gcs_windplan.units import SHARE, SPEED

if TYPE_CHECKING:
    from gcs_windplan.geo.frame import GeoPoint
    from gcs_windplan.vehicle import Airframe, Autopilot, VehicleType

_SPEED: Final = Measure(SPEED, above=0)
_SHARE: Final = Measure(SHARE, at_least=0, at_most=1)
#: The limits that may be asked for, as they are called in an assessment's limits, and what they are measured in.
_LIMITS: Final = {
    "clearance": ("clearance", HEIGHT),
    "max_height": ("max_height", CLEARANCE),
    "max_wind": ("wind", _SPEED),
    "max_gust": ("gust", _SPEED),
    "min_battery": ("battery", _SHARE),
    "first_leg": ("first_leg", CLEARANCE),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Criteria:
    """What a mission is judged by; None or empty where nothing is said. See `review` for what each means.

    `named` is how the face that asks calls a criterion: `--max-gust` on the command line.
    """

    terrain: TerrainWords | None = None
    wind: WindWords | None = None
    profile: WindProfile | str | None = None
    extend: bool = False
    departure: datetime | str | None = None
    vehicle: Airframe | Path | str | None = None
    autopilot: Autopilot | None = None
    vehicle_type: VehicleType | None = None
    home: PlaceWords | None = None
    clearance: float | str | None = None
    max_height: float | str | None = None
    max_wind: float | str | None = None
    max_gust: float | str | None = None
    min_battery: float | str | None = None
    first_leg: float | str | None = None
    named: Naming = str

    @property
    def world(self) -> tuple[str, ...]:
        """The criteria given that a mission to be planned settles by itself."""
        own = ("terrain", "wind", "vehicle", "profile", "extend", "autopilot", "vehicle_type")
        return tuple(name for name in own if getattr(self, name) not in (None, False))

    @property
    def moment(self) -> datetime | None:
        """The departure in UTC. Raises `InputError`."""
        return read_as(self.named("departure"), lambda: as_moment(self.departure))

    @property
    def place(self) -> Place | None:
        """The home. Raises `InputError`."""
        home = self.home
        return None if home is None else read_as(self.named("home"), lambda: as_place(home))

    @property
    def home_point(self) -> GeoPoint | None:
        """Where the home is. Raises `InputError`."""
        from gcs_windplan.geo.frame import GeoPoint

        place = self.place
        if place is None:
            return None
        if isinstance(place.point, GeoPoint):
            return place.point
        raise InputError(Problem("needs a latitude and a longitude", self.named("home")))

    def error(self, name: str, message: str) -> InputError:
        """The error about a criterion."""
        return InputError(Problem(message, self.named(name)))

    def limits_with(self, own: AssessmentLimits, *, defaults: bool = False) -> AssessmentLimits:
        """Limits with those that are asked for; `defaults` fills in a clearance of 30 m and a first leg of 500 m."""
        usual = {"clearance": 30.0, "first_leg": 500.0} if defaults else {}
        asked = {name: getattr(self, name) for name in _LIMITS if getattr(self, name) is not None}
        read = {
            _LIMITS[name][0]: read_as(self.named(name), lambda name=name, words=words: _LIMITS[name][1].read(words))  # type: ignore[misc]
            for name, words in asked.items()
        }
        return replace(own, **{**usual, **read})

    def with_home(self, case: Case) -> Case:
        """The case with the home asked for, on the ground where it has no altitude.

        Raises `InputError` where a limit is asked for of what the case does not know.
        """
        self._refuse_limits_unknown(case)
        place, point = self.place, self.home_point
        if place is None or point is None:
            return case
        from gcs_windplan.assessment.home import ground_at
        from gcs_windplan.mission import Home

        altitude = place.altitude
        if altitude is None:
            altitude = ground_at(point, case) + (place.height or 0.0)
            if math.isnan(altitude):
                raise self.error("home", f"{point} lies outside of the terrain: write its altitude too")
        mission = replace(case.mission, home=Home(point, altitude))
        return replace(case, mission=mission, home_is_given=True)

    def _refuse_limits_unknown(self, case: Case) -> None:
        """A limit of gusts that no forecast tells, or of a battery that no airframe has, would be kept by anything."""
        if self.max_gust is not None and not case.scene.gusts:
            text = f"the wind has no gusts ({case.scene.wind.name}): leave it out, or take a forecast with gusts"
            raise self.error("max_gust", text)
        if self.min_battery is not None and case.airframe is None:
            raise self.error("min_battery", "the battery is not known: leave it out, or give an airframe")

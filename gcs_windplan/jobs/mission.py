"""A mission to be planned, in words and values: what a mission file holds, before anything that it names is read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal, Protocol

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.jobs.areas import Area
from gcs_windplan.jobs.missionfile.values import AIRSPEED_OR_FREE, Moment
from gcs_windplan.jobs.obstacles import ObstacleFile
from gcs_windplan.jobs.places import PlaceWords, as_place
from gcs_windplan.jobs.terrains import TerrainWords, as_terrain
from gcs_windplan.jobs.vehicles import VehicleWords, has_airframe
from gcs_windplan.jobs.winds import WindProfile, WindWords, as_profile, as_wind
from gcs_windplan.jobs.words import read_as
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.request import Export, Finish, Limits, Order, Roadmap, Uniform
from gcs_windplan.scene import CollisionTest


class Marked(Protocol):
    """A file whose fields have places."""

    @property
    def file(self) -> Path:
        """The file."""

    def problem(self, field: str, message: str) -> Problem:
        """A problem with a field, with its place in the file."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Mission:
    """A mission to be planned; `gcs_windplan.plan` takes it, `read_mission` reads one from a file.

    `start`, `goal`, `via` and `rally` points are places: (latitude, longitude) [deg], (latitude, longitude, altitude)
    [deg, m above mean sea level], text such as `46.81,9.84,80 m agl`, a `GeoPoint`, or a `Place`. `terrain` is a file
    of heights or several, `sample:jacksboro`, `flat:120`, or a terrain; `wind` a forecast's files, `8 m/s from 270`,
    `calm`, or a wind field, with a `profile` (`power:0.143`, `log:0.1`) over height. Values count in the local frame
    about `origin`, which is the middle of all sites where it is not given. `vehicle` is a `Vehicle`, an `Airframe` or
    an airframe's file; `airspeed` [m/s] takes the place of its own, `free` lets each leg have its own.

    `clearance` and `max_height` are above ground [m], `layers` the heights of the graph's nodes, `margin` [m] how far
    it reaches beyond the sites. `members` of an ensemble's forecast are flown in, and planned for the quantile
    `robust` of the cost. `departure`, with its time zone, is a time or its text. `return_height` is above home [m].

    Raises `InputError` for words that say nothing; terrain, wind and files are read when it is planned.

    >>> import gcs_windplan as gw
    >>> gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.60, -84.20), vehicle=gw.Vehicle(12.0),
    ...     terrain="sample:jacksboro", wind="8 m/s from 270 deg",
    ... )
    Mission('mission': 2 sites, least time)
    """

    start: PlaceWords
    goal: PlaceWords
    vehicle: VehicleWords
    terrain: TerrainWords
    wind: WindWords = "calm"
    name: str = "mission"
    via: Sequence[PlaceWords] = ()
    order: Order = "given"
    airspeed: float | Literal["free"] | str | None = None
    profile: WindProfile | str | None = None
    members: Literal["all"] | Sequence[int] | None = None
    extend: bool = False
    departure: datetime | str | None = None
    origin: GeoPoint | None = None
    clearance: float = 30.0
    max_height: float | None = None
    limits: Limits = field(default_factory=Limits)
    keep_out: Sequence[Area] = ()
    keep_in: Sequence[Area] = ()
    obstacles: Sequence[ObstacleFile] = ()
    cost: CostChoice | str = "time"
    graph: Uniform | Roadmap = field(default_factory=Uniform)
    layers: Sequence[float] = ()
    margin: float | None = None
    collision_test: CollisionTest | None = None
    finish: Finish = "land"
    return_height: float = 15.0
    export: Export = field(default_factory=Export)
    fence_return: PlaceWords | None = None
    rally: Sequence[PlaceWords] = ()
    robust: float = 0.5
    document: Marked | None = None

    def __post_init__(self) -> None:
        settle: dict[str, Any] = {
            name: read_as(name, lambda words=words: as_place(words))  # type: ignore[misc]
            for name, words in (("start", self.start), ("goal", self.goal))
        }
        settle["via"] = tuple(read_as(f"via.{i}", lambda: as_place(one)) for i, one in enumerate(self.via))  # noqa: B023
        settle["rally"] = tuple(read_as(f"rally.{i}", lambda: as_place(one)) for i, one in enumerate(self.rally))  # noqa: B023
        if self.fence_return is not None:
            back = self.fence_return
            settle["fence_return"] = read_as("fence.return_point", lambda: as_place(back))
        settle["terrain"] = read_as("terrain", lambda: as_terrain(self.terrain))
        settle["wind"] = read_as("wind", lambda: as_wind(self.wind, members=self.members, extend=self.extend))
        settle["profile"] = read_as("profile", lambda: as_profile(self.profile))
        settle["departure"] = read_as("departure", lambda: as_moment(self.departure))
        settle["cost"] = as_cost(self.cost)
        if self.airspeed is not None:
            settle["airspeed"] = read_as("airspeed", lambda: AIRSPEED_OR_FREE.read(self.airspeed))
        for name, value in settle.items():
            object.__setattr__(self, name, value)
        if self.airspeed == "free" and not has_airframe(self.vehicle):
            raise InputError(Problem("to be free to choose asks for the mission's vehicle.airframe", "airspeed"))

    def __repr__(self) -> str:
        return f"Mission({self.name!r}: {2 + len(self.via)} sites, least {self.cost})"


def as_cost(words: CostChoice | str) -> CostChoice:
    """The cost that a name or a value says. Raises `InputError` for a name unknown."""
    return CostChoice(words) if isinstance(words, str) else words


def as_moment(words: datetime | str | None) -> datetime | None:
    """The moment in UTC that a text or a value says. Raises `ValueError` where it has no time zone."""
    return None if words is None else Moment().read(words).astimezone(UTC)

"""What judging a mission comes to: its legs as flown, its profile, what breaks a limit, and what it was judged by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal, TypeAlias

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.vehicle import Autopilot, VehicleType

#: danger: do not fly it like this; warning: look at it before flying.
Severity: TypeAlias = Literal["danger", "warning"]
Verdict: TypeAlias = Literal["clear", "warnings", "dangers"]
Fact: TypeAlias = str | int | float | bool | None


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong with a mission, as data.

    `rule` is a stable short name (`clearance`, `height`, `wind`, `reserve`, ...). Where it is: the mission's `item`
    (from 1 on, home being 0), the `leg` (from 1 on), how far along the route (`distance`, level [m]) and the place;
    None where it concerns the whole mission. `value` and `limit` are in `unit`, `facts` what else the rule knows, in
    SI units. `message` is one sentence with the number, the limit and what to do; `wording.py` makes it of the rest.

    >>> import gcs_windplan as gw
    >>> gw.Finding("clearance", "danger", "leg 3 passes 12 m above ground", leg=3, value=12.0, limit=30.0, unit="m").leg
    3
    """

    rule: str
    severity: Severity
    message: str = ""
    item: int | None = None
    leg: int | None = None
    distance: float | None = None
    latitude_deg: float | None = None
    longitude_deg: float | None = None
    value: float | None = None
    limit: float | None = None
    unit: str = ""
    facts: Mapping[str, Fact] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Stop:
    """A place that the mission flies to, in the order flown.

    `item` counts from 1 (0: home, where it takes off); `label` is what it is: `take-off`, `waypoint`, `spline`,
    `loiter`, `land`, `return`. `altitude` above mean sea level, `above_ground` [m], NaN where the ground is not known.
    `distance` level along the route [m], `seconds` since take-off at the arrival, `hold` [s] there. `left` is the share
    of the battery's whole capacity that is left; `return_energy` [J] what flying home from here takes, landing too,
    `diversion_energy` that to the nearest rally point; None where it is not known, infinite where it is not possible.
    """

    number: int
    item: int
    label: str
    latitude_deg: float
    longitude_deg: float
    altitude: float
    above_ground: float
    east: float
    north: float
    distance: float
    seconds: float
    hold: float = 0.0
    left: float | None = None
    return_energy: float | None = None
    diversion_energy: float | None = None


@dataclass(frozen=True, slots=True)
class AssessedLeg:
    """From one stop to the next; figures as in `gcs_windplan.flight.flight.Leg`.

    `item` is the one that it leads to. Angles in degrees from true north, lengths in m, speeds in m/s, means over the
    leg. `gradient` is climb by level distance. `airspeed` is what it is flown at in that wind. `seconds` as the
    autopilot flies it, holds not included, infinite where it cannot be flown. `clearance` and `height` are the smallest
    and the largest height above ground, NaN over unknown ground.
    """

    number: int
    item: int
    track_deg: float
    heading_deg: float
    distance: float
    length: float
    climb: float
    gradient: float
    ground_speed: float
    airspeed: float
    wind_along: float
    wind_across: float
    seconds: float
    clearance: float
    height: float
    energy: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """The flight along its way, n samples in the order flown, (n,) each.

    `distance` level along the route [m], `seconds` since take-off, heights above mean sea level [m]; wind positive from
    behind and from left to right, speeds [m/s]. `power` [W] and `left`, the battery's share, where the airframe is
    known. `leg` is the number of the leg that a sample lies on (0: the take-off's climb). NaN where something is not
    known.
    """

    distance: FloatArray
    seconds: FloatArray
    latitude_deg: FloatArray
    longitude_deg: FloatArray
    east: FloatArray
    north: FloatArray
    altitude: FloatArray
    ground: FloatArray
    wind_along: FloatArray
    wind_across: FloatArray
    wind_east: FloatArray
    wind_north: FloatArray
    ground_speed: FloatArray
    airspeed: FloatArray
    leg: IntArray
    power: FloatArray | None = None
    left: FloatArray | None = None


@dataclass(frozen=True, slots=True, eq=False)
class GroundMap:
    """The ground around the route, on a regular grid of the local frame, and the wind over it.

    `east` (columns,) and `north` (rows,) [m]; `heights` (rows, columns) above mean sea level [m], row 0 in the south,
    NaN where not known. The wind (k, 2) [m/s], east and north, towards where it blows, at `wind_places` (k, 2), at
    `wind_height` above ground [m] at `wind_seconds` after the departure.
    """

    east: FloatArray
    north: FloatArray
    heights: FloatArray
    wind_places: FloatArray
    winds: FloatArray
    wind_height: float
    wind_seconds: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """On the map: `kind` is `keep-out`, `keep-in`, `fence-out`, `fence-in` or `obstacle`; corners (n, 2) in the frame.

    `floor` and `ceiling` above mean sea level [m], None where it has none.
    """

    name: str
    kind: str
    corners: FloatArray
    floor: float | None = None
    ceiling: float | None = None


@dataclass(frozen=True, slots=True)
class AssessmentLimits:
    """What a mission is judged against; None: no such limit. Heights above ground and lengths [m], speeds [m/s].

    `battery` is the smallest share of the capacity that must be left at the end, `reserve_seconds` of level flight must
    be left besides what is not usable, `first_leg` is the largest distance from home to the first waypoint [m].
    """

    clearance: float | None = None
    max_height: float | None = None
    wind: float | None = None
    gust: float | None = None
    battery: float | None = None
    climb: float | None = None
    descent: float | None = None
    airspeed: float | None = None
    first_leg: float | None = None
    reserve_seconds: float | None = None


@dataclass(frozen=True, slots=True)
class Source:
    """Something that the judgement rests on: `role` is `mission`, `terrain`, `wind`, `vehicle`, `limits` or `software`.

    `file` and its `sha256` where it is one; `detail` in words: the vertical datum, the forecast's run, what was
    assumed.
    """

    role: str
    name: str
    file: str | None = None
    sha256: str | None = None
    detail: str = ""


@dataclass(frozen=True, slots=True)
class MissionTotals:
    """The whole mission: times [s], lengths and heights [m], energy [J] and share of the battery left at the end.

    `seconds` from arming to disarmed, with take-off, holds and landing; `wind` and `gust` the strongest met [m/s],
    in any member of an ensemble. `reserve` is what must be left as a share of the capacity.
    """

    seconds: float
    takeoff_seconds: float
    landing_seconds: float
    distance: float
    length: float
    climb: float
    descent: float
    clearance: float
    height: float
    wind: float
    gust: float | None = None
    energy: float | None = None
    left: float | None = None
    reserve: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Assessment:
    """A mission, judged.

    `remarks` say what was repaired, ignored or assumed on the way; they do not count as findings.

    >>> import gcs_windplan as gw
    >>> mission = gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... )
    >>> gw.review(mission).totals.clearance > 0
    True
    """

    name: str
    autopilot: Autopilot
    vehicle_type: VehicleType
    frame: LocalFrame
    vertical_datum: str
    departure: datetime | None
    stops: tuple[Stop, ...]
    legs: tuple[AssessedLeg, ...]
    profile: Profile
    totals: MissionTotals
    limits: AssessmentLimits
    findings: tuple[Finding, ...]
    ground: GroundMap
    outlines: tuple[Outline, ...] = ()
    rally: tuple[tuple[float, float], ...] = field(default=())  # (latitude, longitude) [deg]
    sources: tuple[Source, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def verdict(self) -> Verdict:
        """The worst of what was found."""
        if any(finding.severity == "danger" for finding in self.findings):
            return "dangers"
        return "warnings" if self.findings else "clear"

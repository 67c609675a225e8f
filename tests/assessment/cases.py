"""Missions over small known grounds, to be judged."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from gcs_windplan.assessment import Assessment, AssessmentLimits, Case, Finding, assess
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems
from gcs_windplan.mission.firmware.ardupilot import MOTION
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import Airframe, Battery, PowerTable, Vehicle
from gcs_windplan.wind import Calm
from tests.scenes import in_scene

FRAME = LocalFrame(GeoPoint(46.8, 9.8))
GROUND = 500.0  # [m] the plain's height
RELATIVE, AMSL, TERRAIN = Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL, Frame.GLOBAL_TERRAIN_ALT
SWIFT = replace(MOTION, airspeed=20.0)

PLAIN = Dem.local(np.full((81, 81), GROUND), -4000.0, 4000.0, 100.0)


def ridge(height: float = 60.0, east: float = 1000.0, width: float = 100.0) -> Dem:
    """The plain with a ridge from south to north, as a roof."""
    x = -4000.0 + 50.0 * np.arange(161)
    roof = np.maximum(0.0, 1 - np.abs(x - east) / width) * height
    return Dem.local(np.tile(GROUND + roof, (161, 1)), -4000.0, 4000.0, 50.0)


def airframe(watts: float = 400.0, capacity: float = 360_000.0, **more: Any) -> Airframe:
    """One that draws the same at any airspeed; climbing takes its weight's share."""
    vehicle = Vehicle(10.0, **{"climb": 2.5, "descent": 1.5, **more})
    table = PowerTable(2.0, (0.0, 40.0), (watts, watts), 1.225, 0.5)
    return Airframe("test", vehicle, 2.0, Battery(capacity, 0.8, 0.25), table, 20.0)


def at(
    east: float,
    north: float,
    height: float = 80.0,
    *params: float,
    command: int = Command.NAV_WAYPOINT,
    frame: int = RELATIVE,
) -> MissionItem:
    latitude, longitude = FRAME.to_geographic(np.array([[east, north]]))
    given = (*params, 0.0, 0.0, 0.0, 0.0)
    return MissionItem(frame, command, given[:4], float(latitude[0]), float(longitude[0]), height)


def free(command: int, *params: float) -> MissionItem:
    given = (*params, 0.0, 0.0, 0.0, 0.0)
    return MissionItem(Frame.MISSION, command, given[:4])


def takeoff(height: float = 80.0) -> MissionItem:
    return MissionItem(RELATIVE, Command.NAV_TAKEOFF, altitude=height)


def point(east: float, north: float) -> GeoPoint:
    latitude, longitude = FRAME.to_geographic(np.array([[east, north]]))
    return GeoPoint(float(latitude[0]), float(longitude[0]))


RETURN = free(Command.NAV_RETURN_TO_LAUNCH)
HOME = Home(FRAME.origin, GROUND)


def case(*items: MissionItem, mission: dict[str, Any] | None = None, **more: Any) -> Case:
    """A case of a mission from the origin, over the plain in still air; a take-off comes first."""
    given = {"home": HOME, "autopilot": "ardupilot", "vehicle_type": "multicopter", **(mission or {})}
    flown = MissionItems((takeoff(), *items), **given)
    known = {
        "name": "test",
        "frame": FRAME,
        "terrain": PLAIN,
        "wind": Calm(),
        "autopilot": flown.autopilot,
        "vehicle_type": flown.vehicle_type,
        "pace": SWIFT,
        "cruise": 15.0,
        "limits": AssessmentLimits(),
    }
    return Case(mission=flown, **in_scene(**{**known, **more}))


def judged(*items: MissionItem, **more: Any) -> Assessment:
    return assess(case(*items, **more))


def found(assessment: Assessment, rule: str) -> list[Finding]:
    return [finding for finding in assessment.findings if finding.rule == rule]


def local(finding: Finding) -> np.ndarray:
    """Where a finding is, east and north [m]."""
    return FRAME.to_local(finding.latitude_deg, finding.longitude_deg)[0]


def cosd(degrees: float) -> float:
    return math.cos(math.radians(degrees))

"""Where a mission begins, if it does not say so itself."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from gcs_windplan.assessment.case import Case
from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Home, MissionItems

_FARTHEST: Final = 300_000.0  # [m] from the frame's origin, over which its distances are good to some metres
APART: Final = 5.0  # [m] more, and home is not on this terrain's ground


def with_home(case: Case) -> Case:
    """The case with a home: the mission's, or on the ground under the first place that it names.

    A home at exactly 0 m where the ground is elsewhere is a blank, as ground stations write: the ground counts. Raises
    `InputError` where there is none, or no item with a place.
    """
    home = case.mission.home
    if home is None:
        home = _assumed(case)
        said = f"the mission names no home: it is taken to be at {home.point}, {home.altitude:.1f} m, on the ground"
        return _at(case, home, f"{said} under its first place")
    ground = ground_at(home.point, case)
    if home.altitude == 0 and abs(ground) > APART and not case.home_is_given:
        return _at(
            case,
            replace(home, altitude=ground),
            f"home's altitude is a blank 0 m: heights above home count from the ground there, {ground:.1f} m",
        )
    return case


def check_places(case: Case) -> None:
    """Raise `InputError` for a home or an item so far away that the case's ground and wind are another site's."""
    home, items = case.mission.home, case.mission.items
    places = [(f"item {n}", item.latitude_deg, item.longitude_deg) for n, item in enumerate(items, 1) if item.has_place]
    if home is not None:
        places.insert(0, ("home", home.point.latitude_deg, home.point.longitude_deg))
    for name, latitude, longitude in places:
        away = float(np.hypot(*case.scene.frame.to_local(latitude, longitude)[0]))
        if not away <= _FARTHEST:
            raise InputError(
                f"{name} lies {away / 1000:.0f} km from the middle of the terrain and wind that it is judged by"
                f" ({case.scene.frame.origin}): judge it by those of its own site"
            )


def ground_at(point: GeoPoint, case: Case) -> float:
    """The ground's height at a place [m], NaN where it is not known."""
    places = case.scene.frame.to_local(point.latitude_deg, point.longitude_deg)
    return float(case.scene.terrain.heights_at(np.ascontiguousarray(places))[0])


def first_place(mission: MissionItems) -> GeoPoint | None:
    """The first place that a mission names."""
    return next((GeoPoint(item.latitude_deg, item.longitude_deg) for item in mission.items if item.has_place), None)


def _assumed(case: Case) -> Home:
    point = first_place(case.mission)
    if point is None:
        raise InputError("the mission names neither home nor any place: give home")
    ground = ground_at(point, case)
    if math.isnan(ground):
        raise InputError(
            f"the mission names no home, and its first place, {point}, lies outside of the terrain: give home's"
            " latitude, longitude and altitude, or another terrain"
        )
    return Home(point, ground)


def _at(case: Case, home: Home, remark: str) -> Case:
    return replace(case, mission=replace(case.mission, home=home), remarks=(*case.remarks, remark))

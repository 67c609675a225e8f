"""The short words of a mission file's sections, read as verbs and Python read them: the fields that they stand for.

What reads them is imported when there is something to read: most files have none, and it is heavy.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any


def wind_fields(text: str) -> dict[str, Any]:
    """The fields of a wind: `calm`, `8 m/s from 270 deg`, a forecast's file. Raises `ValueError`."""
    from gcs_windplan.jobs.winds import GivenWind, SameWind, as_wind

    match as_wind(text):
        case GivenWind():
            return {"calm": True}
        case SameWind(speed=speed, from_deg=from_deg):
            return {"constant": {"speed": speed, "from": from_deg}}
    return {"forecast": [_file(text, "wind: write calm, 8 m/s from 270 deg, or the name of a forecast's file")]}


def terrain_fields(text: str) -> dict[str, Any]:
    """The fields of a terrain: `sample:jacksboro`, `flat:120`, a file of heights. Raises `ValueError`."""
    from gcs_windplan.jobs.terrains import FlatGround, SampleDem, as_terrain

    match as_terrain(text):
        case SampleDem():
            return {"sample": "jacksboro"}
        case FlatGround(altitude=altitude):
            return {"flat": altitude}
    return {"dem": [_file(text, "terrain: write sample:jacksboro, flat:ALTITUDE, or the name of a file of heights")]}


def place_fields(text: str) -> dict[str, float]:
    """The fields of a place: `46.81,9.84`, with an altitude or a height behind it if wanted. Raises `ValueError`."""
    from gcs_windplan.geo.frame import GeoPoint
    from gcs_windplan.jobs.places import read_place

    place = read_place(text)
    assert isinstance(place.point, GeoPoint)
    heights = {"height": place.height, "altitude": place.altitude}
    known = {name: value for name, value in heights.items() if value is not None}
    return {"latitude": place.point.latitude_deg, "longitude": place.point.longitude_deg, **known}


def profile_fields(text: str) -> dict[str, Any]:
    """The fields of a wind's profile: `power:0.143`, `log:0.1`. Raises `ValueError`."""
    from gcs_windplan.jobs.winds import as_profile

    profile = as_profile(text)
    assert profile is not None
    return {"law": profile.law, {"power": "exponent", "log": "roughness"}[profile.law]: profile.figure}


def _file(text: str, advice: str) -> str:
    """The text, if it can be nothing but a file's name: it has an ending. A misspelt word is no file."""
    if not Path(text).suffix:
        raise ValueError(f"{text!r} is no {advice}, with its ending")
    return text

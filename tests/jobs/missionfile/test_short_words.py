"""The short words of a mission file: what they stand for, and what is said of those that are wrong."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from gcs_windplan.jobs.mission import Mission
from gcs_windplan.jobs.missionfile.mission import mission_of_document
from gcs_windplan.jobs.missionfile.reference import json_schema
from gcs_windplan.jobs.terrains import as_terrain
from gcs_windplan.jobs.winds import as_profile, as_wind
from gcs_windplan.manual.pages import read_page
from gcs_windplan.vehicle import Vehicle
from tests.jobs.missionfile.missions import FILE, complaints, mission, read

ORIGIN = "origin: {latitude: 36.5, longitude: -84.3, altitude: 120 m}"
SAME = [
    ("wind", "calm", "{calm: true}"),
    ("wind", "8 m/s from 270 deg", "{constant: {speed: 8 m/s, from: 270 deg}}"),
    ("wind", "15 kt from 90", "{constant: {speed: 15 kt, from: 90}}"),
    ("wind", "8@270", "{constant: {speed: 8, from: 270}}"),
    ("wind", "{constant: 8@270}", "{constant: {speed: 8, from: 270}}"),
    ("wind", "forecast.grib2", "{forecast: forecast.grib2}"),
    ("wind", "far/away/run 12.nc", "{forecast: [far/away/run 12.nc]}"),
    ("wind", "{forecast: a.nc, profile: log:0.1}", "{forecast: a.nc, profile: {law: log, roughness: 0.1}}"),
    ("wind", "{constant: 8@270, profile: power:0.143}",
     "{constant: {speed: 8, from: 270}, profile: {law: power, exponent: 0.143}}"),
    ("terrain", "dem.tif", "{dem: dem.tif}"),
    ("terrain", "tiles/N46E009.hgt.zip", "{dem: [tiles/N46E009.hgt.zip]}"),
    ("terrain", "sample:jacksboro", "{sample: jacksboro}"),
    ("terrain", "flat:120", "{flat: 120}"),
    ("terrain", "flat:400 ft", "{flat: 400 ft}"),
    ("terrain", "{mesh: a.ply, origin: '36.5,-84.3,120'}", f"{{mesh: a.ply, {ORIGIN}}}"),
    ("start", "46.81,9.84", "{latitude: 46.81, longitude: 9.84}"),
    ("start", "46.81, 9.84, 2100", "{latitude: 46.81, longitude: 9.84, altitude: 2100}"),
    ("start", "46.81,9.84,300 ft agl", "{latitude: 46.81, longitude: 9.84, height: 300 ft}"),
    ("via", "['36.55,-84.25', {latitude: 36.5, longitude: -84.2}]",
     "[{latitude: 36.55, longitude: -84.25}, {latitude: 36.5, longitude: -84.2}]"),
    ("rally", "\n- 36.55,-84.25,2 km", "[{latitude: 36.55, longitude: -84.25, altitude: 2 km}]"),
    ("obstacles", "[{name: a, mesh: b.stl, at: '36.5,-84.3'}]",
     "[{name: a, mesh: b.stl, at: {latitude: 36.5, longitude: -84.3}}]"),
]  # fmt: skip


@pytest.mark.parametrize(("field", "short", "long"), SAME, ids=lambda value: value[:40])
def test_words_stand_for_fields(field: str, short: str, long: str) -> None:
    assert read(**{field: short}).model == read(**{field: long}).model


def test_the_manuals_table_is_right() -> None:
    rows = re.findall(r"^\| `(\w+): (.+?)`( in `wind`)? \| `\1: (.+?)` \|$", read_page("mission-file"), re.MULTILINE)
    assert len(rows) == 10
    for field, short, inside, long in rows:
        if inside:
            field, short, long = "wind", *(f"{{constant: 8@270, profile: {value}}}" for value in (short, long))
        assert read(**{field: short}).model == read(**{field: long}).model


def test_words_are_those_of_python_and_the_verbs() -> None:
    """One grammar: what a mission in words says, its file says too."""
    words = {"wind": "12 kt from 200 deg", "terrain": "flat:120 m", "start": "36.5,-84.3,80 m agl"}
    ours = Mission(goal="36.6,-84.2", vehicle=Vehicle(12.0), **words)  # type: ignore[arg-type]
    filed = mission_of_document(read(goal="36.6,-84.2", **words))
    for name in ("wind", "terrain", "start", "goal"):
        assert getattr(filed, name) == getattr(ours, name) or name == "terrain"
    assert filed.terrain == as_terrain("flat:120 m")
    assert filed.wind == as_wind("12 kt from 200 deg")
    assert mission_of_document(read(wind="{constant: 8@270, profile: log:0.1}")).profile == as_profile("log:0.1")


def test_files_count_from_the_mission_files_folder() -> None:
    filed = mission_of_document(read(wind="wind/a.nc", terrain="dem.tif"))
    assert filed.wind.files == (FILE.parent / "wind/a.nc",)
    assert filed.terrain.files == (FILE.parent / "dem.tif",)


PLACE = "write LAT,LON or LAT,LON,ALT, for example 46.81,9.84 or 46.81,9.84,2100 or 46.81,9.84,'80 m agl'"
WRONG = [
    ("wind", "8 m/s", "4:7: wind: '8 m/s' says no direction: write '8 m/s from 270'"),
    ("wind", "8 m from 270", "4:7: wind: '8 m' is a length, but a speed belongs here; write for example 12 m/s, or a"
     " plain number in m/s"),
    ("wind", "8 from 400", "4:7: wind: must be between 0 and 360 deg, not '400' (400 deg)"),
    ("wind", "clam", "4:7: wind: 'clam' is no wind: write calm, 8 m/s from 270 deg, or the name of a forecast's file,"
     " with its ending"),
    ("wind", "8", "4:7: wind: calm, 8 m/s from 270 deg, forecast.grib2, or a section with fields (calm, constant,"
     " paper, forecast, members, extend, profile) belongs here, not 8"),
    ("wind", "{constant: 8@270, profile: cubic}", "4:34: wind.profile: 'cubic' is no law: write power:EXPONENT or"
     " log:ROUGHNESS, power:0.143"),
    ("terrain", "sample:everest", "3:10: terrain: 'sample:everest' is no terrain: name files, or sample:jacksboro or"
     " flat:ALTITUDE alone"),
    ("terrain", "hilly", "3:10: terrain: 'hilly' is no terrain: write sample:jacksboro, flat:ALTITUDE, or the name of"
     " a file of heights, with its ending"),
    ("terrain", "flat:high", "3:10: terrain: 'high' is not a length; write for example 120 m, or a plain number in m"),
    ("start", "36.5,-84.3,80,4", f"5:8: start: '36.5,-84.3,80,4' is no place; {PLACE}"),
    ("start", "95,-84.3", "5:8: start: latitude: must be between -90 and 90 deg, not '95' (95 deg)"),
    ("start", "36.5,-84.3,10 m agl", "5:8: start: 10 m is below the clearance of 30 m that every leg keeps"),
    ("start", "36.6,-84.2", "6:7: goal: is the same place as start; there is nothing to fly in between"),
    ("via", "\n- 36.55,-84.25\n- here", "9:3: via.1: a place such as {latitude: 38.1, longitude: 23.7} or {east: 100,"
     " north: 250} belongs here, not 'here'"),
    ("limits", "{gust: 9}", "7:10: limits.gust: needs wind.forecast; no other wind has gusts"),
]  # fmt: skip


@pytest.mark.parametrize(("field", "value", "line"), WRONG, ids=lambda value: value[:40])
def test_words_that_say_nothing(field: str, value: str, line: str) -> None:
    """They have their line and column, and what sections say against each other is told of words too."""
    (told,) = complaints(mission(**{field: value}))
    assert told == line


def test_limits_of_gusts_are_taken_beside_a_forecast_in_words() -> None:
    assert read(wind="a.nc", limits="{gust: 9}").model.limits.gust == 9


def test_two_words_that_are_wrong_are_told_at_once() -> None:
    assert [line.split(": ")[0] for line in complaints(mission(wind="clam", start="95,1"))] == ["4:7", "5:8"]


def test_a_file_without_words_does_not_wait_for_what_reads_them() -> None:
    program = (
        "import sys, pathlib; from gcs_windplan.jobs.missionfile.parsing import parse_mission; "
        f"parse_mission({mission()!r}, pathlib.Path('m.yaml')); print('gcs_windplan.jobs.winds' in sys.modules)"
    )
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert answer.stdout == "False\n"


def test_editors_are_told_that_words_may_stand_there() -> None:
    kinds = json_schema()["$defs"]
    for name in ("WindModel", "TerrainModel", "SiteModel", "PlaceModel", "OriginModel", "ProfileModel"):
        assert kinds[name]["anyOf"][0]["type"] == "string"
    assert "anyOf" not in kinds["CircleModel"]

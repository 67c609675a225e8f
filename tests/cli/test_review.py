"""`review` as a pilot meets it: pages, words, exit codes, and what cannot be used."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from gcs_windplan.cli.app import app
from gcs_windplan.errors import FormatError, InputError, TerrainError, WindError
from gcs_windplan.formats import write_plan, write_waypoints
from gcs_windplan.mission import Fence, FencePolygon, MissionItems
from tests.assessment.cases import HOME, RETURN, at, point, takeoff

ITEMS = (takeoff(60), at(0, 300, 60), at(300, 300, 60), RETURN)
MISSION = MissionItems(ITEMS, HOME, "ardupilot", "multicopter")
WORLD = """name: {name}
vehicle: {{airspeed: 12 m/s}}
terrain: {{surface: {{size: 4 km, cell: 50 m}}, origin: {{latitude: 46.8, longitude: 9.8, altitude: 500}}}}
wind: {{constant: {{speed: 4 m/s, from: 270}}}}
start: {{east: 0, north: 0}}
goal: {{east: 800, north: 600}}
clearance: 40 m
graph: {{uniform: {{spacing: 200 m, neighbours: 8}}}}
"""


def review(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["review", *map(str, arguments)])


@pytest.fixture
def drawn(tmp_path: Path) -> Path:
    write_plan(MISSION, tmp_path / "drawn.plan")
    return tmp_path / "drawn.plan"


@pytest.fixture
def world(tmp_path: Path) -> Path:
    file = tmp_path / "valley.yaml"
    file.write_text(WORLD.format(name="valley"))
    return file


def test_a_mission_file_is_planned_and_judged(world: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    done = review(world)
    assert done.exit_code == 0, done.output
    assert "valley: nothing found" in done.stdout
    page = (tmp_path / "out" / "valley" / "review.html").read_text()
    assert "<html" in page


def test_a_drawn_mission_over_a_plain(drawn: Path, tmp_path: Path):
    done = review(drawn, "--terrain", "flat:500", "--first-leg", "400", "-o", tmp_path / "page.html")
    assert done.exit_code == 0, done.output
    assert "drawn (ArduCopter): 3 legs" in done.stdout
    assert "note: no --wind was given" in done.stdout
    assert (tmp_path / "page.html").is_file()


def test_findings_give_exit_code_1_and_are_told(drawn: Path, tmp_path: Path):
    done = review(drawn, "--terrain", "flat:460", "--max-height", "300 ft", "-o", tmp_path / "page.html")
    assert done.exit_code == 1
    assert "DANGER: leg 1 (to item 2) is 100.0 m above ground, more than the limit of 91.44 m" in done.stdout
    assert "warning: home is 40.0 m above the ground" in done.stdout
    assert done.stdout.count("DANGER") == 3
    assert "drawn: 3 dangers, 1 warning: do not fly it like this" in done.stdout


def test_json_holds_the_whole_verdict(drawn: Path, tmp_path: Path):
    done = review(
        drawn, "--terrain", "flat:500", "--wind", "6 m/s from 270", "--profile", "power:0.14", "--max-wind", "5",
        "--json", "-o", tmp_path / "page.html",
    )  # fmt: skip
    assert done.exit_code == 1
    told = json.loads(done.stdout)
    (mission,) = told["missions"]
    assert told["exit_code"] == 1
    assert mission["verdict"] == "dangers"
    assert {one["rule"] for one in mission["findings"]} == {"wind", "airspeed"}
    assert mission["sums"]["wind"] == pytest.approx(6 * 6**0.14)
    assert len(mission["stops"]) == len(mission["legs"]) + 1
    roles = {one["role"]: one for one in mission["sources"]}
    assert set(roles) == {"mission", "terrain", "wind", "software"}
    assert len(roles["mission"]["sha256"]) == 64


def test_two_missions_are_compared(world: Path, drawn: Path, tmp_path: Path):
    write_waypoints(MISSION, tmp_path / "other.waypoints")
    done = review(world, drawn, "-o", tmp_path / "both.html", "--also", "kml,csv")
    assert done.exit_code == 0, done.output
    assert "judged by the terrain, wind, vehicle, limits and areas of" in done.stdout
    assert sorted(path.name for path in tmp_path.glob("both*")) == [
        "both-1.csv", "both-1.kml", "both-2.csv", "both-2.kml", "both.html",
    ]  # fmt: skip
    flat = review(drawn, tmp_path / "other.waypoints", "--terrain", "flat:500", "-o", tmp_path / "two.html")
    assert flat.exit_code == 0, flat.output


def test_a_mission_in_the_world_of_a_mission_file(world: Path, drawn: Path, tmp_path: Path):
    done = review(drawn, "--by", world, "-o", tmp_path / "page.html", "--json")
    (mission,) = json.loads(done.stdout)["missions"]
    assert mission["limits"]["clearance"] == 40
    assert mission["sums"]["wind"] == pytest.approx(4.0)
    lower = review(drawn, "--by", world, "-o", tmp_path / "page.html", "--clearance", "70")
    assert lower.exit_code == 1


def test_exports_stand_beside_the_page(drawn: Path, tmp_path: Path):
    review(drawn, "--terrain", "flat:500", "-o", tmp_path / "p.html", "--also", "kml,geojson,csv,png")
    names = {path.name for path in tmp_path.glob("p.*")}
    assert names == {"p.html", "p.kml", "p.geojson", "p.csv", "p.map.png", "p.profile.png"}
    assert (tmp_path / "p.map.png").read_bytes().startswith(b"\x89PNG")


def test_units_and_home(drawn: Path, tmp_path: Path):
    done = review(
        drawn, "--terrain", "flat:0", "--home", "46.8,9.8,'1640 ft'".replace("'", ""), "--clearance", "100 ft",
        "-o", tmp_path / "p.html", "--json",
    )  # fmt: skip
    (mission,) = json.loads(done.stdout)["missions"]
    assert mission["limits"]["clearance"] == pytest.approx(30.48)
    assert mission["stops"][1]["altitude"] == pytest.approx(1640 * 0.3048 + 60)
    ground = review(drawn, "--terrain", "flat:200", "--home", "46.8,9.8", "-o", tmp_path / "p.html", "--json")
    (mission,) = json.loads(ground.stdout)["missions"]
    assert mission["stops"][1]["altitude"] == pytest.approx(260)


def test_a_fence_of_the_file_is_held_against_it(tmp_path: Path):
    square = FencePolygon(tuple(point(e, n) for e, n in [(-50, -50), (200, -50), (200, 400), (-50, 400)]))
    file = tmp_path / "fenced.plan"
    write_plan(MissionItems(ITEMS, HOME, "ardupilot", "multicopter", fence=Fence((square,))), file)
    done = review(file, "--terrain", "flat:500", "-o", tmp_path / "p.html")
    assert "DANGER: leg 2 (to item 3) leaves the mission's own fence polygon 1" in done.stdout


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ([], InputError, "--terrain: is needed to judge a mission file"),
        (["--terrain", "nowhere.tif"], TerrainError, "nowhere.tif"),
        (["--terrain", "flat:high"], InputError, "--terrain: 'high' is not a length"),
        (["--terrain", "sample:moon", "--terrain", "flat:2"], InputError, "'sample:moon' is no terrain"),
        (["--terrain", "flat:500", "--wind", "nowhere.grib2"], WindError, "nowhere.grib2"),
        (["--terrain", "flat:500", "--wind", "8 m from 270"], InputError, "--wind: '8 m' is a length"),
        (["--terrain", "flat:500", "--profile", "power:0.1"], InputError, "--profile: belongs only beside --wind"),
        (["--terrain", "flat:500", "--wind", "8 from 270", "--profile", "cubic"], InputError, "'cubic' is no law"),
        (["--terrain", "flat:500", "--max-height", "12 kt"], InputError, "--max-height: '12 kt' is a speed"),
        (["--terrain", "flat:500", "--min-battery", "300 %"], InputError, "--min-battery"),
        (["--terrain", "flat:500", "--home", "46.8"], InputError, "--home: '46.8' is no place"),
        (["--terrain", "flat:500", "--departure", "noon"], InputError, "--departure: 'noon' is not a date"),
        (["--terrain", "flat:500", "--also", "dxf"], InputError, "--also: 'dxf' is none of kml, geojson, csv, png"),
        (["--terrain", "flat:500", "--vehicle", "none.yaml"], InputError, "none.yaml: there is no such file"),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_told_in_one_line(options, error, words, drawn: Path, tmp_path: Path):
    done = review(drawn, *options, "-o", tmp_path / "page.html")
    assert isinstance(done.exception, error), done.output
    assert words in str(done.exception)
    assert len(str(done.exception).splitlines()) == 1
    assert not (tmp_path / "page.html").exists()


def test_an_error_ends_in_exit_code_2_and_one_line(drawn: Path, tmp_path: Path):
    code = "import sys; from gcs_windplan.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code, "review", str(drawn), "--terrain", "none.tif", "-o", "page.html"],
        cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("error: none.tif")
    assert len(done.stderr.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["drawn.plan"]


def test_a_broken_row_is_told_with_its_line(tmp_path: Path):
    file = tmp_path / "broken.waypoints"
    file.write_text(
        "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t46.8\t9.8\t500\t1\n1\t0\t3\tx\t0\t0\t0\t0\t46.8\t9.8\t80\t1\n"
    )
    done = review(file, "--terrain", "flat:500")
    assert isinstance(done.exception, FormatError)
    assert f"{file}:3: field 4 (command) is 'x'" in str(done.exception)


def test_a_mission_file_settles_its_world(world: Path, drawn: Path):
    for files in ((world,), (drawn, "--by", world)):
        done = review(*files, "--terrain", "flat:500")
        assert "--terrain: cannot stand beside" in str(done.exception)


def test_another_kind_of_airframe_is_refused(drawn: Path, gallery: Path):
    done = review(drawn, "--terrain", "flat:500", "--vehicle", gallery / "vehicles" / "fixed_wing.yaml")
    assert "is of a fixed-wing" in str(done.exception)


def test_a_battery_that_is_overdrawn_is_a_finding_not_an_error(tmp_path: Path, gallery: Path):
    """`plan` refuses such a mission; `review` shows it."""
    text = WORLD.format(name="far").replace(
        "{airspeed: 12 m/s}", f"{{airframe: {gallery}/vehicles/small_quadcopter.yaml}}"
    )
    text = (
        text.replace("4 km", "40 km")
        .replace("cell: 50 m", "cell: 500 m")
        .replace("800", "9000")
        .replace("200 m", "2 km")
    )
    file = tmp_path / "far.yaml"
    file.write_text(text)
    done = review(file, "-o", tmp_path / "far.html")
    assert done.exit_code == 1, done.output
    assert "DANGER: the mission takes 130 % of the battery, and the airframe's reserve asks for 36 %" in done.stdout


def test_a_mission_with_a_far_waypoint_says_which(tmp_path: Path):
    write_plan(MissionItems((*ITEMS[:3], at(290_000, 0), at(-290_000, 0), RETURN), HOME), tmp_path / "far.plan")
    done = review(tmp_path / "far.plan", "--terrain", "flat:500")
    assert done.exception is None or "item" in str(done.exception)


@pytest.mark.parametrize("output", ["drawn.plan", "page.kml", "notes.txt"])
def test_nothing_that_was_read_is_written_over(drawn: Path, tmp_path: Path, output: str):
    """Two missions stand side by side on the command line: a name too many must not cost one of them."""
    before = drawn.read_bytes()
    found = review(drawn, "--terrain", "flat:500", "-o", tmp_path / output, "--also", "kml")
    assert isinstance(found.exception, InputError)
    assert "give one that ends in .html" in str(found.exception)
    assert drawn.read_bytes() == before


def test_the_word_of_a_page_that_is_a_folder(drawn: Path, tmp_path: Path):
    (tmp_path / "pages").mkdir()
    done = review(drawn, "--terrain", "flat:500", "-o", tmp_path / "pages")
    assert done.exit_code == 0
    assert (tmp_path / "pages" / "review.html").is_file()
    assert np.isfinite(HOME.altitude)

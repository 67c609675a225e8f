"""Good mission files, their defaults, and where their fields stand."""

import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pydantic
import pytest

from gcs_windplan.errors import Problem
from gcs_windplan.jobs.missionfile.model import MissionModel
from gcs_windplan.jobs.missionfile.parsing import parse_mission, read_document
from tests.jobs.missionfile.missions import FILE, ORIGIN, mission, read

FULL = """\
name: Ridge crossing_2
vehicle:
  type: fixed-wing
  autopilot: px4
  airspeed: 20 kt
  climb: 500 ft/min
  descent: 1.5
  speed_model: paper
terrain:
  dem: [a.tif, b.hgt.zip]
  nodata: 0
  origin: {latitude: 38.1, longitude: 23.7, altitude: 400 ft}
  vertical_datum: EGM96
obstacles:
  - {name: tower, mesh: tower.GLB}
  - {name: mast, mesh: mast.stl, at: {east: 10, north: -1 km}, altitude: 120, margin: 0}
wind:
  constant: {speed: 8 m/s, from: 270°}
  profile: {law: power, exponent: 0.143}
start: {east: 0, north: 0}
goal:
  latitude: 38.2
  longitude: 23.8
  height: 60 m
via:
  - {latitude: 38.15, longitude: 23.75, altitude: -3}
  - {east: 100, north: 2 nmi}
clearance: 40
cost: {name: hybrid, angle: 0}
graph:
  prm: {nodes: 3000, seed: 7, radius: 400 m}
  layers: [40 m, 70, 0.1 km]
  margin: 1 km
limits:
  keep_out:
    - name: school
      polygon: [[38.1, 23.7], [38.2, 23.7], [38.2, 23.8]]
      floor: 0
      ceiling: 500 m
    - name: airfield
      polygon:
        east_north: [[0, 0], [100, 0], [0, 0.1 km]]
  keep_in:
    - {name: all, polygon: [[38, 23], [39, 23], [39, 24], [38, 24]]}
  wind: 20 kt
  max_height: 120 m
  way_home: true
departure: 2026-05-01 08:00 +02:00
finish: return
export: {speed_changes: false, altitude: amsl, waypoints: true, plan: false}
"""


def test_a_mission_with_every_field() -> None:
    model = parse_mission(FULL, FILE).model
    assert model.vehicle.airspeed == pytest.approx(10.288888888888889)  # 20 · 1852 / 3600
    assert model.vehicle.climb == pytest.approx(2.54)
    assert model.terrain.dem == ("a.tif", "b.hgt.zip")
    assert model.terrain.origin is not None
    assert model.terrain.origin.altitude == pytest.approx(121.92)
    assert model.obstacles[1].at is not None
    assert (model.obstacles[1].at.east, model.obstacles[1].at.north) == (10, -1000)
    assert (model.obstacles[0].margin, model.obstacles[1].margin) == (5, 0)
    assert model.wind.constant is not None
    assert model.wind.constant.from_ == 270
    assert model.wind.profile is not None
    assert model.wind.profile.reference_height == 10
    assert [site.altitude for site in model.via] == [-3, None]
    assert model.via[1].north == 3704
    assert (model.cost.name, model.cost.distance, model.cost.angle) == ("hybrid", 0.1, 0)
    assert model.graph.layers == (40, 70, 100)
    assert model.graph.uniform is None
    assert model.limits.keep_out[0].polygon.latitude_longitude == ((38.1, 23.7), (38.2, 23.7), (38.2, 23.8))
    assert model.limits.keep_out[1].polygon.east_north == ((0, 0), (100, 0), (0, 100))
    assert model.limits.wind == pytest.approx(10.288888888888889)
    assert (model.limits.max_height, model.limits.way_home, model.limits.battery) == (120, True, None)
    assert model.departure == datetime(2026, 5, 1, 6, tzinfo=UTC)


def test_defaults() -> None:
    model = read().model
    assert (model.vehicle.type, model.vehicle.autopilot) == ("multicopter", "ardupilot")
    assert (model.vehicle.climb, model.vehicle.descent, model.vehicle.speed_model) == (2.5, 1.5, "triangle")
    assert (model.clearance, model.limits.max_height, model.departure) == (30, None, None)
    assert (model.cost.name, model.finish) == ("time", "land")
    assert model.graph.uniform is not None
    assert (model.graph.uniform.spacing, model.graph.uniform.neighbours) == (None, 16)
    assert (model.export.altitude, model.export.speed_changes) == ("relative", True)
    assert (model.via, model.obstacles, model.limits.keep_out, model.limits.keep_in) == ((), (), (), ())


def test_limits_of_the_battery_and_of_gusts() -> None:
    frame, forecast = "{airframe: quadcopter.yaml}", "{forecast: w.nc}"
    limits = read(vehicle=frame, wind=forecast, limits="{gust: 14, battery: 30 %, reserve: 5 min}").model.limits
    assert (limits.gust, limits.battery, limits.reserve) == (14, 0.3, 300)
    assert read(vehicle=frame, limits="{battery: 0.3, reserve: 90}").model.limits.battery == 0.3


GOOD = [
    ("name", "no"),  # in YAML 1.1 a boolean
    ("name", "12-30"),
    ("name", "Höhenweg 3"),
    ("vehicle", "{airspeed: '12'}"),
    ("vehicle", "{airspeed: 1e1}"),
    ("vehicle", "{airspeed: 010 m/s}"),
    ("terrain", "{dem: a.tif}"),
    ("terrain", f"{{mesh: a.PLY, {ORIGIN}}}"),
    ("terrain", f"{{surface: {{size: 800 m, cell: 5 m}}, {ORIGIN}}}"),
    ("terrain", f"{{surface: {{size: 800 m, cell: 5 m, hills: []}}, {ORIGIN}}}"),
    ("wind", "{paper: {field: jet, reading: literal, scale: 9}, profile: {law: log, roughness: 1}}"),
    ("wind", "{paper: {field: rotation}}"),
    ("wind", "{forecast: w.nc, extend: nearest}"),
    ("wind", "{constant: {speed: 0, from: 6.283185307179586 rad}}"),
    ("cost", "angle"),
    ("cost", "{name: time}"),
    ("graph", "{}"),
    ("graph", "{uniform: {}}"),
    ("graph", "{uniform: {spacing: 50, neighbours: 32}}"),
    ("graph", "{prm: {}}"),
    ("graph", "{layers: [30]}"),
    ("limits", "{max_height: 30}"),
    ("limits", "{wind: 12 m/s, way_home: false}"),
    ("limits", "{}"),
    ("departure", "2026-05-01T08:00Z"),
    ("departure", "'2026-05-01T08:00:00.5-03:30'"),
    ("export", "{plan: False}"),
    ("limits", "{keep_out: []}"),
]  # fmt: skip


@pytest.mark.parametrize(("field", "value"), GOOD, ids=lambda value: value[:40])
def test_a_good_field(field: str, value: str) -> None:
    read(**{field: value})


def test_a_graph_without_a_kind_is_uniform() -> None:
    graph = read(graph="{layers: [40]}").model.graph
    assert graph.uniform is not None
    assert graph.prm is None


def test_a_round_trip_may_end_where_it_started() -> None:
    there = "{latitude: 36.6, longitude: -84.2}"
    assert read(start=there, goal=there, via="[{latitude: 36.5, longitude: -84.2}]").model.via


def test_aliases_repeat_a_value() -> None:
    model = read(start="&home {latitude: 36.5, longitude: -84.3}", via="[{latitude: 36, longitude: -84}, *home]").model
    assert model.via[1] == model.start


@pytest.mark.parametrize(
    ("field", "place"),
    [
        ("name", (1, 7)),
        ("vehicle", (3, 3)),
        ("vehicle.airspeed", (5, 13)),
        ("via.0", (26, 5)),
        ("via.1.north", (27, 24)),
        ("via.7", (26, 3)),
        ("terrain.dem.1", (10, 16)),
        ("terrain.mesh", (10, 3)),
        ("limits.keep_out.1.polygon", (42, 9)),
        ("limits.keep_out.1.polygon.east_north.2.1", (42, 44)),
        ("limits.keep_out.0.polygon.1.0", (37, 32)),
        ("limits.keep_out.0.ceiling.deeper.still", (39, 16)),
        ("nothing.like.that", (1, 1)),
        ("", (1, 1)),
    ],
)
def test_places(field: str, place: tuple[int, int]) -> None:
    assert parse_mission(FULL, FILE).place(field) == place


def test_a_problem_and_a_path_of_a_document() -> None:
    document = parse_mission(FULL, Path("folder/m.yaml"))
    problem = document.problem("limits.keep_out.1.polygon", "crosses itself")
    assert problem == Problem("crosses itself", "limits.keep_out.1.polygon", Path("folder/m.yaml"), 42, 9)
    assert document.beside("a.tif") == Path("folder/a.tif")
    assert document.beside("/data/a.tif") == Path("/data/a.tif")


def test_a_file_with_a_byte_order_mark_and_windows_line_ends(tmp_path: Path) -> None:
    file = tmp_path / "m.yaml"
    file.write_bytes(b"\xef\xbb\xbf" + mission().replace("\n", "\r\n").encode())
    document = read_document(file)
    assert document.model == read().model
    assert document.place("vehicle.airspeed") == (2, 21)


def test_the_model_is_frozen_and_checks_itself() -> None:
    model = read().model
    with pytest.raises(pydantic.ValidationError, match="frozen"):
        model.clearance = 3
    with pytest.raises(pydantic.ValidationError, match="one of dem, sample, mesh, surface or flat is missing"):
        MissionModel.model_validate({"terrain": {}})


def test_reading_a_mission_loads_no_heavy_library() -> None:
    program = (
        "import sys, pathlib; from gcs_windplan.jobs.missionfile.parsing import parse_mission; "
        f"parse_mission({mission()!r}, pathlib.Path('m.yaml')); "
        "print(sorted({'numpy', 'numba', 'scipy', 'rasterio', 'netCDF4', 'trimesh'} & set(sys.modules)))"
    )
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert answer.stdout == "[]\n"

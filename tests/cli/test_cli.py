"""The command line as a user meets it: files, tables, exit codes, and bad input."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from tests.verbs import command, run

GOOD = """\
name: small
vehicle: {airspeed: 12 m/s}
terrain:
  surface: {size: 2 km, cell: 25 m, hills: [{east: 0, north: 0, height: 60, radius: 200}]}
  origin: {latitude: 46.8, longitude: 9.8, altitude: 500 m}
wind:
  constant: {speed: 5 m/s, from: 270 deg}
start: {east: -600, north: 0}
goal: {east: 600, north: 50}
clearance: 30 m
limits:
  max_height: 120 m
graph:
  uniform: {spacing: 50 m}
"""


def mission(folder: Path, **changes) -> Path:
    """A mission file with some top-level fields replaced (None: removed)."""
    content = yaml.safe_load(GOOD)
    for field, value in changes.items():
        content.pop(field, None)
        if value is not None:
            content[field] = value
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(content, sort_keys=False))
    return path


def test_plan_writes_everything(tmp_path):
    (tmp_path / "mission.yaml").write_text(GOOD)
    done = subprocess.run(
        command("plan", "mission.yaml"), cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    folder = tmp_path / "out" / "small"
    names = {"small.waypoints", "small.plan", "summary.json", "map.png", "profile.png"}
    assert {path.name for path in folder.iterdir()} == names
    for name in ("map.png", "profile.png"):
        assert (folder / name).read_bytes().startswith(b"\x89PNG")
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["totals"]["clearance"] >= 30.0 - 1e-6
    assert len(summary["legs"]) == len(summary["waypoints"]) - 1
    assert "en route" in done.stdout
    assert (folder / "small.waypoints").read_text().startswith("QGC WPL 110\n0\t1\t0\t16\t")


def test_a_fence_goes_into_the_plan_and_the_other_file_is_said_to_lack_it(tmp_path):
    square = {"name": "field", "polygon": {"east_north": [[-800, -800], [800, -800], [800, 800], [-800, 800]]}}
    path = mission(
        tmp_path, limits={"keep_in": [{**square, "fence": True}]}, rally=[{"east": 0, "north": -300, "height": "60 m"}]
    )
    done = run("plan", path, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    folder = tmp_path / "out" / "small"
    plan = json.loads((folder / "small.plan").read_text())
    assert len(plan["geoFence"]["polygons"][0]["polygon"]) == 4
    assert len(plan["rallyPoints"]["points"]) == 1
    assert "note: small.waypoints has no place for fence and rally points: upload small.plan" in done.stdout
    assert "\t5001\t" not in (folder / "small.waypoints").read_text()
    done = run("plan", mission(tmp_path, rally=[{"east": 0, "north": -3000}]), cwd=tmp_path)
    assert done.returncode == 2
    assert "mission.yaml:" in done.stderr
    assert "rally.0: lies 2.00 km outside of the terrain" in done.stderr


def test_the_same_mission_gives_the_same_bytes(tmp_path):
    (tmp_path / "mission.yaml").write_text(GOOD)
    for folder in ("a", "b"):
        assert run("plan", "mission.yaml", "-o", folder, cwd=tmp_path).returncode == 0
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes(), path.name


def test_options_change_the_plan(tmp_path):
    (tmp_path / "mission.yaml").write_text(GOOD)
    done = run(
        "plan", "mission.yaml", "--cost", "distance", "--airspeed", "24 kt", "--no-speed-changes", "-o", "x",
        cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "x" / "summary.json").read_text())
    assert summary["cost"] == "distance"
    assert summary["vehicle"]["airspeed"] == pytest.approx(24 * 1852 / 3600)
    commands = [row.split("\t")[3] for row in (tmp_path / "x" / "small.waypoints").read_text().splitlines()[1:]]
    assert "178" not in commands  # MAV_CMD_DO_CHANGE_SPEED


def test_compare_lists_every_cost(tmp_path):
    (tmp_path / "mission.yaml").write_text(GOOD)
    done = run("compare", "mission.yaml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for name in ("distance", "angle", "hybrid", "time"):
        assert name in done.stdout
    assert (tmp_path / "out" / "small" / "compare.png").is_file()


def test_schema_and_help(tmp_path):
    assert "`airspeed`" in run("schema", cwd=tmp_path).stdout
    assert json.loads(run("schema", "--json", cwd=tmp_path).stdout)["type"] == "object"
    for verb in ("plan", "compare", "schema"):
        assert run(verb, "--help", cwd=tmp_path).returncode == 0


def test_help_imports_nothing_heavy(tmp_path):
    code = (
        "import sys\nfrom gcs_windplan.cli import main\nsys.argv = ['gcs-windplan', '--help']\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = {'numba', 'numpy', 'scipy', 'rasterio', 'matplotlib', 'trimesh', 'netCDF4', 'pydantic', 'rich'}\n"
        "print('loaded:', sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "loaded: []" in done.stdout


def netcdf(path: Path, *, v: bool = True, hole: bool = False, far: bool = False) -> None:
    """A small wind file over the mission's area, or away from it."""
    import netCDF4

    with netCDF4.Dataset(path, "w") as file:
        east = 20.0 if far else 9.5
        for name, values, units in (
            ("lat", np.linspace(46.5, 47.1, 7), "degrees_north"),
            ("lon", np.linspace(east, east + 0.6, 7), "degrees_east"),
        ):
            file.createDimension(name, 7)
            axis = file.createVariable(name, "f8", (name,))
            axis[:], axis.units = values, units
        for name, standard in (("u", "eastward_wind"), ("v", "northward_wind"))[: 2 if v else 1]:
            wind = file.createVariable(name, "f4", ("lat", "lon"))
            wind.units, wind.standard_name = "m s-1", standard
            values = np.full((7, 7), 4.0)
            if hole:
                values[3, 3] = np.nan
            wind[:] = values


def wind_from(path: Path, **kind):
    netcdf(path, **kind)
    return {"forecast": path.name, "profile": {"law": "log", "roughness": 0.1}}


SURFACE = yaml.safe_load(GOOD)["terrain"]
SQUARE = [[500, -100], [800, -100], [800, 200], [500, 200]]
BAD = {
    "missing DEM": (
        lambda d: {"terrain": {"dem": "no.tif", "origin": SURFACE["origin"]}},
        "no.tif",
        "terrain",
    ),
    "corrupt DEM": (
        lambda d: (
            (d / "bad.tif").write_bytes(b"II*\0garbage")
            and {"terrain": {"dem": "bad.tif", "origin": SURFACE["origin"]}}
        ),
        "bad.tif",
        "terrain",
    ),
    "start outside": (lambda d: {"start": {"east": -5000, "north": 0}}, "outside of the terrain", "start"),
    "start below the ground": (
        lambda d: {"start": {"east": -600, "north": 0, "altitude": 400}},
        "below the ground",
        "start",
    ),
    "goal in a keep-out": (
        lambda d: {"limits": {"keep_out": [{"name": "school", "polygon": {"east_north": SQUARE}}]}},
        "'school' forbids it",
        "goal",
    ),
    "wind without v": (lambda d: {"wind": wind_from(d / "u.nc", v=False)}, "no v", "wind"),
    "NaN in the wind": (lambda d: {"wind": wind_from(d / "n.nc", hole=True)}, "n.nc", "wind"),
    "wind elsewhere": (lambda d: {"wind": wind_from(d / "f.nc", far=True)}, "km short of the area", "wind"),
    "clearance above the limit": (
        lambda d: {"clearance": "200 m"},
        "120 m is below the clearance",
        "limits.max_height",
    ),
    "airspeed 0": (lambda d: {"vehicle": {"airspeed": 0}}, "between 0.1 and 150 m/s", "vehicle.airspeed"),
    "negative weight": (
        lambda d: {"cost": {"name": "hybrid", "distance": -1, "angle": 1}},
        "at least 0",
        "cost.distance",
    ),
    "unknown field": (lambda d: {"clearence": 20}, "did you mean 'clearance'", "clearence"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_clear_message_and_exit_code_2(name, tmp_path):
    change, text, field = BAD[name]
    path = mission(tmp_path, **change(tmp_path))
    done = run("plan", path.name, cwd=tmp_path)
    assert done.returncode == 2, done.stdout + done.stderr
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("error: mission.yaml:")
    head, _, message = lines[0].partition(f": {field}")
    assert all(part.isdigit() for part in head.split(":")[2:]), lines[0]
    assert text in message
    assert not (tmp_path / "out").exists()


def test_start_inside_nodata(tmp_path):
    import rasterio

    heights = np.full((200, 200), 500.0, dtype="float32")
    heights[:, :60] = -9999
    with rasterio.open(
        tmp_path / "dem.tif", "w", driver="GTiff", height=200, width=200, count=1, dtype="float32",
        crs="EPSG:32632", transform=rasterio.Affine(20, 0, 560000, 0, -20, 5200000), nodata=-9999,
    ) as file:  # fmt: skip
        file.write(heights, 1)
    places = {"start": (46.93, 9.797), "goal": (46.93, 9.83)}
    sites = {name: {"latitude": lat, "longitude": lon} for name, (lat, lon) in places.items()}
    path = mission(tmp_path, terrain={"dem": "dem.tif"}, **sites)
    done = run("plan", path.name, cwd=tmp_path)
    assert done.returncode == 2, done.stdout
    assert "start: the terrain" in done.stderr
    assert "no data there" in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("name: [\n", "mission.yaml:2:1"),
        ("", "empty"),
        ("- a\n- b\n", "something else"),
        ("name: a\nname: b\n", "2:1"),
    ],
)
def test_yaml_that_does_not_parse(text, said, tmp_path):
    (tmp_path / "mission.yaml").write_text(text)
    done = run("plan", "mission.yaml", cwd=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_every_error_at_once(tmp_path):
    path = mission(tmp_path, vehicle={"airspeed": "12 m"}, clearance=-3, cost="fuel", goal=None)
    done = run("plan", path.name, cwd=tmp_path)
    assert done.returncode == 2
    fields = [line.split(": ")[2] for line in done.stderr.splitlines()]
    assert sorted(fields) == ["clearance", "cost", "goal", "vehicle.airspeed"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("plan", "none.yaml"), "no such file"),
        (("plan", "mission.yaml", "--cost", "fuel"), "'fuel' is no cost"),
        (("plan", "mission.yaml", "--airspeed", "fast"), "--airspeed"),
        (("plan", "mission.yaml", "--airspeed", "1e9"), "between 0.1 and 150 m/s"),
        (("plan", "mission.yaml", "-o", "mission.yaml"), "folder"),
        (("plan",), "Missing argument"),
        (("fly", "mission.yaml"), "No such command"),
    ],
)
def test_bad_arguments(arguments, said, tmp_path):
    (tmp_path / "mission.yaml").write_text(GOOD)
    done = run(*arguments, cwd=tmp_path)
    assert done.returncode == 2, done.stdout
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


def test_no_route_is_exit_code_1(tmp_path):
    path = mission(tmp_path, wind={"constant": {"speed": 40, "from": 90}})
    done = run("plan", path.name, cwd=tmp_path)
    assert done.returncode == 1
    assert "no route" in done.stderr
    assert "wind" in done.stderr
    assert not (tmp_path / "out").exists()

"""`gcs-windplan wind` as a pilot meets it, and its numbers beside those of eccodes, netCDF4 and json."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from gcs_windplan.cli import linking
from gcs_windplan.cli.app import app
from gcs_windplan.errors import WindplanError
from tests.verbs import run
from tests.wind.grib_files import box, message
from tests.wind.other_readers import NAMES, Value, real, whole_winds
from tests.wind.trap_file import write_trap

ONE_CM_PER_SECOND = 0.01
TEN_METRES = {"typeOfLevel": "heightAboveGround", "level": 10}
WIDTH = 100


def wind(*arguments: object) -> Any:
    return CliRunner().invoke(app, ["wind", *map(str, arguments)])


def told(*arguments: object) -> str:
    """What the verb prints where all goes well: nothing wider than a terminal of 100 columns."""
    result = wind(*arguments)
    assert result.exception is None, result.exception
    assert result.exit_code == 0
    if "--json" not in arguments:
        assert max(map(len, result.stdout.splitlines())) <= WIDTH
    return str(result.stdout)


def refused(*arguments: object) -> str:
    """The one line of an error that ends in exit code 2."""
    result = wind(*arguments)
    assert isinstance(result.exception, WindplanError), result.output
    assert linking.code_of(result.exception) == 2
    (line,) = linking.told(result.exception)
    assert "\n" not in line
    return line


def row_of(text: str, level: str) -> list[float]:
    """u, v, speed and direction in the row of a level."""
    (line,) = [line for line in text.splitlines() if line.strip().startswith(level)]
    return [float(cell) for cell in line.split()[-4:]]


def only_row_of(text: str) -> list[float]:
    """The numbers in the row below the table's head."""
    lines = text.splitlines()
    rule = next(number for number, line in enumerate(lines) if "───" in line)
    return [float(cell) for cell in lines[rule + 1].split()]


def at(value: Value) -> tuple[str, ...]:
    place = f"{value.latitude!r},{value.longitude!r}"
    member = () if value.member is None else ("--member", str(value.member))
    return ("--at", place, "--time", f"{value.time:%Y-%m-%dT%H:%MZ}", *member)


def expected(first: Value, second: Value) -> tuple[float, float]:
    if first.quantity == "u":
        return first.value, second.value
    angle = np.radians(second.value)
    return -first.value * np.sin(angle), -first.value * np.cos(angle)


@pytest.mark.parametrize("name", NAMES)
def test_ten_numbers_at_nodes_are_those_of_other_readers(name: str) -> None:
    """u and v at five nodes, levels and times; speed and direction follow from them."""
    path = real(name)
    found = whole_winds(path, 5)
    stopped = {"ens_ztu": "it has u (u) but no v", "_uv": "it has no geopotential"}
    if said := next((text for part, text in stopped.items() if part in name), None):
        assert said in refused(path, "--at", "20,10")  # as planning is
        return
    for first, second in found:
        u, v, speed, direction = row_of(told(path, *at(first)), first.level.replace(" above ground", " agl"))
        right = expected(first, second)
        np.testing.assert_allclose((u, v), right, atol=ONE_CM_PER_SECOND)
        assert speed == pytest.approx(np.hypot(*right), abs=ONE_CM_PER_SECOND)
        if speed > 1.0:
            apart = (direction - np.degrees(np.arctan2(-right[0], -right[1])) + 180.0) % 360.0 - 180.0
            assert abs(apart) * np.radians(1.0) * speed < ONE_CM_PER_SECOND


@pytest.mark.parametrize(
    "name", ["gfs_height_above_ground_wrt.nc", "ndfd_20170603T1800.nc", "openmeteo_slc_hourly_pressure_levels.json"]
)
def test_a_height_above_ground_on_a_level_has_its_numbers(name: str) -> None:
    path = real(name)
    pairs = [pair for pair in whole_winds(path, 40) if pair[0].level.endswith("above ground")][:3]
    assert pairs
    for first, second in pairs:
        _, place, *rest = at(first)
        text = told(path, "--at", f"{place},{first.level.split()[0]} m agl", *rest)
        numbers = only_row_of(text)
        np.testing.assert_allclose(numbers[:2], expected(first, second), atol=ONE_CM_PER_SECOND)


@pytest.mark.parametrize("name", NAMES)
def test_an_inventory_of_each_real_file(name: str) -> None:
    path = real(name)
    text = told(path)
    assert re.search(r"^file +\S", text)
    for fact in ("run", "times", "members", "grid", "planning"):
        assert re.search(rf"^{fact}s? +\S", text, re.MULTILINE), fact
    assert re.search(r"^ (u|speed) ", text, re.MULTILINE)
    stopped = "no picture: it has u (u) but no v: download it along"
    picture = stopped if "ens_ztu" in name else "arrows point where it blows to"
    assert picture in " ".join(text.split())
    document = json.loads(told(path, "--json"))
    assert document["files"][0]["path"] == str(path)
    assert document["planning"]["possible"] == ("stopped" not in text)
    assert document["times"]["count"] == len(document["times"]["all"])


def test_facts_of_an_inventory(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc", hours=(0.0, 1.0, 2.0, 4.0, 5.0), units="knots", gap="nan")
    text = told(path)
    flat = " ".join(text.split())
    assert "2026-05-01 12:00 to 17:00 UTC, 5 times, every 1 h or more; gaps: 2026-05-01 14:00 to 16:00 UTC" in flat
    assert "knots → m/s" in text
    assert "10, 100 m above ground" in text
    assert "latitudes 49 to 53, longitudes -2 to 2" in flat
    assert [line.split()[-1] for line in text.splitlines() if re.match(" [uv] ", line)] == ["%", "none"]
    assert re.search(r"^ u .* 0\.4 % *$", text, re.MULTILINE)
    assert "planning ready: u, v, 2 levels" in flat
    assert "asks for `departure` from 2026-05-01 12:00 to 17:00 UTC" in flat


def test_a_picture(tmp_path: Path) -> None:
    """u = 10 + east, v = 10 (north - 50): to the north-east in the north, to the south-east in the south."""
    text = told(write_trap(tmp_path / "a.nc", slope=True))
    lines = text.splitlines()
    top = next(number for number, line in enumerate(lines) if "lat\\lon" in line)
    assert lines[top].split()[1:] == ["-2", "-1", "0", "1", "2"]
    assert lines[top + 1].split() == ["53", "↑", "31.0", "↑", "31.3", "↑", "31.6", "↑", "32.0", "↑", "32.3"]
    assert lines[top + 4].split() == ["50", "→", "8.0", "→", "9.0", "→", "10.0", "→", "11.0", "→", "12.0"]
    assert lines[top + 5].split()[-2:] == ["↘", "15.6"]
    assert "from 8.0 m/s at 50, -2 to 32.3 m/s at 53, 2" in text
    assert "wind at 100 m above ground, 2026-05-01 12:00 UTC; all nodes of the grid" in text


def test_a_picture_of_another_level_and_time(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc", shear=True, gusty=True, hours=(0.0, 2.0))
    text = told(path, "--level", "10 m", "--time", "2026-05-01T13:00Z")
    assert "→ 25.0" in text
    assert "wind at 10 m above ground, 2026-05-01 13:00 UTC (between 2026-05-01 12:00 and 14:00 UTC)" in text


def test_a_picture_of_missing_values_and_calm(tmp_path: Path) -> None:
    path = tmp_path / "calm.grib2"
    holes = np.zeros(12)
    holes[5] = 9999.0
    path.write_bytes(message("u", holes, missing=9999.0, **TEN_METRES) + message("v", 0.0, **TEN_METRES))
    text = told(path)
    assert text.count("·  0.0") == 11
    assert text.count(" --") == 1


def test_the_surroundings_of_a_place(tmp_path: Path) -> None:
    text = told(write_trap(tmp_path / "a.nc"), "--at", "51,2", "--around", "20 km")
    assert "km     -20     -16" in text
    assert "blank: outside of its area" in text
    assert "wind at 51.00000, 2.00000; 2026-05-01 12:00 UTC" in text


def test_the_wind_at_a_height_says_how_it_was_found() -> None:
    path = real("bella_lui_weather_data_ERA5.nc")
    flat = " ".join(told(path, "--at", "46.81,9.84,2100", "--time", "2020-02-22T08:00Z").split())
    assert "wind at 46.81000, 9.84000; 2100 m above mean sea level; 2020-02-22 08:00 UTC" in flat
    assert re.search(r"linear between 800 hPa \(20\d\d m AMSL\) and 775 hPa \(23\d\d m AMSL\)", flat)
    assert "in time between 2020-02-22 06:00 and 12:00 UTC" in flat


def test_gusts_and_the_forecasts_ground() -> None:
    path = real("openmeteo_slc_hourly_pressure_levels.json")
    answer = json.loads(path.read_text())
    text = told(path, "--at", f"{answer['latitude']},{answer['longitude']}")
    assert f"gust {answer['hourly']['wind_gusts_10m'][0] * 1609.344 / 3600:.2f} m/s" in text
    assert f"the forecast's ground is at {answer['elevation']:.0f} m" in text


def _ensemble(path: Path, members: int) -> Path:
    """Member n has a wind of n m/s to the east."""
    keys = {**TEN_METRES, "productDefinitionTemplateNumber": 1, "numberOfForecastsInEnsemble": members}
    path.write_bytes(
        b"".join(
            message(name, number * (name == "u"), **keys, perturbationNumber=number)
            for number in range(1, members + 1)
            for name in "uv"
        )
    )
    return path


def test_few_members_have_a_row_each(tmp_path: Path) -> None:
    path = _ensemble(tmp_path / "e.grib2", 3)
    text = told(path, "--at", "51,9")
    assert [line.split()[-5:-3] for line in text.splitlines() if " 270.00" in line] == [
        ["1", "1.00"], ["2", "2.00"], ["3", "3.00"],
    ]  # fmt: skip
    assert row_of(told(path, "--at", "51,9", "--member", 2), "10 m agl")[0] == 2.0
    assert "members   3: 1 to 3" in told(path)
    assert "member 1, the first of 3" in told(path)
    assert "`members: all`, or some" in told(path)


def test_many_members_have_a_median_and_a_range(tmp_path: Path) -> None:
    path = _ensemble(tmp_path / "e.grib2", 21)
    text = told(path, "--at", "51,9,10 agl")
    rows = {line.split()[0]: line.split()[-4:] for line in text.splitlines() if line.strip()}
    assert rows["median"] == ["11.00", "0.00", "11.00", "270.00"]
    assert rows["least"] == ["1.00", "0.00", "1.00", "270.00"]
    assert rows["most"] == ["21.00", "0.00", "21.00", "270.00"]
    assert "median of 21" in text
    document = json.loads(told(path, "--at", "51,9,10 agl", "--json"))
    assert [row["u"] for row in document["winds"]] == pytest.approx(range(1, 22), abs=ONE_CM_PER_SECOND)


def test_several_files_belong_together(tmp_path: Path) -> None:
    paths = [tmp_path / "u.grib2", tmp_path / "v.grib2"]
    for path, name, value in zip(paths, "uv", (3.0, 4.0), strict=True):
        path.write_bytes(message(name, value, **TEN_METRES))
    assert row_of(told(*paths, "--at", "51,9"), "10 m agl")[:3] == [3.0, 4.0, 5.0]
    assert len(re.findall("^file ", told(*paths), re.MULTILINE)) == 2
    assert "no v" in refused(paths[0], "--at", "51,9")


def test_json_of_a_place() -> None:
    path = real("bella_lui_weather_data_ERA5.nc")
    document = json.loads(told(path, "--at", "46.75,9.75", "--json"))
    assert [level["level"]["value"] for level in document["levels"]][:2] == [100000.0, 97500.0]
    assert document["ground"] is None
    spot = json.loads(told(path, "--at", "46.75,9.75,2000", "--json"))
    assert [level["text"] for level in spot["between"]] == ["825 hPa", "800 hPa"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--at", "46.81"), "--at: '46.81' is no place; write LAT,LON or LAT,LON,ALT"),
        (("--at", "north,9"), "--at: latitude: 'north' is not an angle"),
        (("--at", "96,9"), "--at: latitude: must be between -90 and 90 deg"),
        (("--at", "51,9,high"), "--at: altitude: 'high' is not a length"),
        (("--at", "51,9,-5 agl"), "--at: altitude: must be between 0"),
        (("--at", "51,0,100", "--time", "2026-05-01T12:00"), "--time: the offset from UTC is missing"),
        (("--at", "51,0,100", "--time", "noon"), "--time: 'noon' is not a date and time"),
        (
            ("--at", "51,0", "--time", "2026-05-02T12:00Z"),
            "a.nc: the departure 2026-05-02 12:00 UTC lies 18.0 h outside",
        ),
        (("--time", "2026-05-01T06:00Z"), "a.nc: the departure 2026-05-01 06:00 UTC lies 6.0 h outside of its times"),
        (("--at", "60,0"), "a.nc: the wind ends 778 km short of the area: it covers latitudes 49.000 to"),
        (("--at", "51,0,100"), "it has no terrain, so that 100 m above mean sea level cannot be told"),
        (("--at", "51,0,500 ft agl"), "152.4 m above ground is above its highest level above ground, 100 m"),
        (("--level", "80 m"), "it has no wind at 80 m above ground, but at 10 m above ground, 100 m above ground"),
        (("--level", "850 hPa"), "it has no wind at 850 hPa"),
        (("--level", "high"), "--level: 'high' is not a length"),
        (("--around", "20 km"), "--around: needs --at"),
        (("--at", "51,0", "--around", "far"), "--around: 'far' is not a length"),
        (("--member", "1"), "it is no ensemble"),
        (("--member", "one"), "--member: 'one' is no member"),
    ],
)
def test_errors_are_one_clear_line(options: tuple[str, ...], said: str, tmp_path: Path) -> None:
    assert said in refused(write_trap(tmp_path / "a.nc", hours=(0.0, 6.0)), *options)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("a.nc", "--at", "60,0"), "error: a.nc: the wind ends 778 km short of the area"),
        (("nowhere.grib2",), "error: nowhere.grib2: no such file"),
        (("a.nc", "--around", "5 km"), "error: --around: needs --at"),
        ((), "Missing argument"),
    ],
)
def test_exit_codes_of_errors(arguments: tuple[str, ...], said: str, tmp_path: Path) -> None:
    write_trap(tmp_path / "a.nc")
    done = run("wind", *arguments, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_exit_code_of_an_inventory_of_half_a_wind(tmp_path: Path) -> None:
    write_trap(tmp_path / "a.nc", without=("v",))
    done = run("wind", "a.nc", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "stopped: it has u (u) but no v: download it along" in done.stdout


def test_help_imports_nothing_heavy(tmp_path: Path) -> None:
    code = (
        "import sys\nfrom gcs_windplan.cli import main\nsys.argv = ['gcs-windplan', 'wind', '--help']\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = {'numba', 'numpy', 'scipy', 'netCDF4', 'eccodes', 'rich'}\n"  # pydantic is typer's own
        "print('loaded:', sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "--around RADIUS" in done.stdout
    assert "loaded: []" in done.stdout


def test_a_southern_place_is_no_option(tmp_path: Path) -> None:
    path = tmp_path / "south.grib2"
    grid: dict[str, Any] = {"north": -33.0, "south": -35.0, "west": 17.0, "east": 20.0}
    path.write_bytes(b"".join(message(name, 5.0, grid=box(**grid), **TEN_METRES) for name in "uv"))
    assert row_of(told(path, "--at", "-33.9,18.4"), "10 m agl")[:2] == [5.0, 5.0]

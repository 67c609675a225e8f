"""Answers of Open-Meteo: a real one, and ones with traps."""

from __future__ import annotations

import json
import sys
from datetime import UTC, datetime, timedelta
from pathlib import Path
from subprocess import run
from typing import Any

import numpy as np
import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.units import KNOT, STATUTE_MILE
from gcs_windplan.wind.field_index import SURFACE, Field2D, Level, Quantity
from gcs_windplan.wind.files.openmeteo import open_openmeteo

ONE_CM_PER_SECOND = 0.01
REAL = (
    Path(__file__).resolve().parents[3].parent
    / "shared"
    / "data"
    / "wind"
    / "openmeteo_slc_hourly_pressure_levels.json"
)
NOON = 1777636800.0  # 2026-05-01 12:00 UTC
TEN = Level("height", 10.0)
ZERO = np.zeros(1, dtype=np.int64)


def _answer(latitude: float = 47.0, longitude: float = 8.0, **changes: Any) -> dict[str, Any]:
    """Two hours of wind at 10 m; a change of None takes a field away, `hourly` and its units gain fields."""
    hourly = {
        "time": ["2026-05-01T14:00", "2026-05-01T15:00"],
        "wind_speed_10m": [36.0, 18.0],
        "wind_direction_10m": [270, 90],
        **changes.pop("hourly", {}),
    }
    units = {"time": "iso8601", "wind_speed_10m": "km/h", "wind_direction_10m": "°", **changes.pop("units", {})}
    answer = {
        "latitude": latitude,
        "longitude": longitude,
        "elevation": 400.0,
        "utc_offset_seconds": 7200,
        "hourly_units": {name: unit for name, unit in units.items() if unit is not None},
        "hourly": {name: values for name, values in hourly.items() if values is not None},
        **changes,
    }
    return {name: value for name, value in answer.items() if value is not None}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "answer.json"


def _fields(path: Path, answer: Any) -> tuple[tuple[Field2D, ...], tuple[str, ...]]:
    path.write_text(json.dumps(answer), encoding="utf-8")
    with open_openmeteo(path) as index:
        return index.fields, index.unused


def _say(path: Path, answer: Any) -> str:
    with pytest.raises(WindError) as error:
        _fields(path, answer)
    assert str(error.value).startswith(f"{path}: ")
    return str(error.value).removeprefix(f"{path}: ")


def _values(
    fields: tuple[Field2D, ...], quantity: Quantity, level: Level = TEN, member: int | None = None
) -> list[float]:
    """The values at the first node in order of time."""
    found = [s for s in fields if (s.quantity, s.level, s.member) == (quantity, level, member)]
    return [float(field2d.read(ZERO, ZERO)[0, 0]) for field2d in sorted(found, key=lambda field2d: field2d.time or 0.0)]


def test_a_real_answer_holds_what_a_naive_reading_of_it_gives() -> None:
    """Miles an hour, mountain time, old and new names; ten values of each kind."""
    if not REAL.exists():
        pytest.skip("the shared test data are missing")
    answer, random = json.loads(REAL.read_text()), np.random.default_rng(12)
    names: dict[Quantity, tuple[str, float]] = {
        "speed": ("windspeed_{}hPa", STATUTE_MILE / 3600),
        "direction": ("winddirection_{}hPa", 1.0),
        "height": ("geopotential_height_{}hPa", 1.0),
    }
    with open_openmeteo(REAL) as index:
        assert index.unused == ()
        assert index.fields[0].grid.shape == (1, 1)
        fields = {(s.quantity, s.level, s.time): s for s in index.fields}
        for quantity, (name, factor) in names.items():
            for _ in range(10):
                hour, pressure = int(random.integers(12)), int(random.choice([850, 800, 750, 700, 650, 600, 550]))
                local = datetime.fromisoformat(answer["hourly"]["time"][hour]) + timedelta(hours=6)
                field2d = fields[quantity, Level("pressure", pressure * 100), local.replace(tzinfo=UTC).timestamp()]
                expected = answer["hourly"][name.format(pressure)][hour] * factor
                assert float(field2d.read(ZERO, ZERO)[0, 0]) == pytest.approx(expected, abs=ONE_CM_PER_SECOND)
        first = datetime(2025, 9, 11, 18, tzinfo=UTC).timestamp()
        kinds: tuple[Quantity, ...] = ("speed", "direction", "gust")
        ten = {q: float(fields[q, TEN, first].read(ZERO, ZERO)[0, 0]) for q in kinds}
        assert ten == pytest.approx({"speed": 13.0 * 0.44704, "direction": 191.0, "gust": 23.5 * 0.44704})
        assert float(fields["terrain", SURFACE, None].read(ZERO, ZERO)[0, 0]) == 1288.0


@pytest.mark.parametrize(
    ("unit", "factor"), [("km/h", 1 / 3.6), ("m/s", 1.0), ("mp/h", STATUTE_MILE / 3600), ("kn", KNOT)]
)
def test_speeds_are_converted(path: Path, unit: str, factor: float) -> None:
    fields, _ = _fields(path, _answer(units={"wind_speed_10m": unit}))
    assert _values(fields, "speed") == pytest.approx([36.0 * factor, 18.0 * factor])
    assert _values(fields, "direction") == [270.0, 90.0]


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"hourly": {"time": [NOON, NOON + 3600]}, "units": {"time": "unixtime"}},
        {"hourly": {"time": ["2026-05-01T12:00", "2026-05-01T13:00"]}, "utc_offset_seconds": 0},
        {"hourly": {"time": ["2026-05-01T17:30", "2026-05-01T18:30"]}, "utc_offset_seconds": 19800},
        {"hourly": {"time": ["2026-05-01T12:00Z", "2026-05-01T13:00Z"]}},
    ],
)
def test_times_become_utc(path: Path, changes: dict[str, Any]) -> None:
    fields, _ = _fields(path, _answer(**changes))
    assert [field2d.time for field2d in fields if field2d.quantity == "speed"] == [NOON, NOON + 3600]


def test_levels_gusts_and_terrain(path: Path) -> None:
    hourly: dict[str, Any] = {
        "windspeed_100m": [10.0, 10.0], "winddirection_100m": [0, 0], "wind_gusts_10m": [72.0, None],
        "wind_speed_850hPa": [54.0, 54.0], "wind_direction_850hPa": [10, 20],
        "geopotential_height_850hPa": [5000.0, 5000.0],
        "wind_u_component_80m": [3.0, 3.0], "wind_v_component_80m": [4.0, 4.0], "temperature_2m": [20.0, 21.0],
        "wind_speed_10m_spread": [1.0, 1.0],
    }  # fmt: skip
    units = {
        "windspeed_100m": "m/s", "winddirection_100m": "°", "wind_gusts_10m": "km/h", "wind_speed_850hPa": "km/h",
        "wind_direction_850hPa": "°", "geopotential_height_850hPa": "ft", "wind_u_component_80m": "m/s",
        "wind_v_component_80m": "m/s", "temperature_2m": "°C",
    }  # fmt: skip
    fields, unused = _fields(path, _answer(hourly=hourly, units=units))
    assert unused == ()
    at_850, at_80 = Level("pressure", 85000.0), Level("height", 80.0)
    assert _values(fields, "speed", Level("height", 100.0)) == [10.0, 10.0]
    assert _values(fields, "gust") == pytest.approx([20.0, np.nan], nan_ok=True)
    assert _values(fields, "speed", at_850) == pytest.approx([15.0, 15.0])
    assert _values(fields, "height", at_850) == pytest.approx([1524.0, 1524.0])
    assert (_values(fields, "u", at_80), _values(fields, "v", at_80)) == ([3.0, 3.0], [4.0, 4.0])
    terrain = [field2d for field2d in fields if field2d.quantity == "terrain"]
    assert [(field2d.level, field2d.time) for field2d in terrain] == [(SURFACE, None)]
    assert len(fields) == 2 * 10 + 1


def test_without_an_elevation_there_is_no_terrain(path: Path) -> None:
    assert {field2d.quantity for field2d in _fields(path, _answer(elevation=None))[0]} == {"speed", "direction"}


def test_members_and_their_control_run(path: Path) -> None:
    hourly = {"wind_speed_10m_member01": [1.0, 1.0], "wind_direction_10m_member01": [5, 5],
              "wind_speed_10m_member02": [None, None], "wind_direction_10m_member02": [None, None]}  # fmt: skip
    units = {"wind_speed_10m_member01": "m/s", "wind_direction_10m_member01": "°",
             "wind_speed_10m_member02": "m/s", "wind_direction_10m_member02": "°"}  # fmt: skip
    fields, unused = _fields(path, _answer(hourly=hourly, units=units))
    assert {field2d.member for field2d in fields if field2d.quantity != "terrain"} == {0, 1}
    assert (_values(fields, "speed", member=0), _values(fields, "speed", member=1)) == ([10.0, 5.0], [1.0, 1.0])
    assert unused == ("wind_speed_10m_member02, wind_direction_10m_member02: without any value",)


def test_the_quarter_of_an_hour_is_taken_where_the_hour_has_no_wind(path: Path) -> None:
    answer = _answer()
    answer["minutely_15"], answer["minutely_15_units"] = answer["hourly"], answer["hourly_units"]
    answer["minutely_15"]["time"] = ["2026-05-01T14:00", "2026-05-01T14:15"]
    answer["hourly"], answer["hourly_units"] = {"time": [], "rain": []}, {"time": "iso8601", "rain": "mm"}
    fields, _ = _fields(path, answer)
    assert [field2d.time for field2d in fields if field2d.quantity == "speed"] == [NOON, NOON + 900]


def test_a_lattice_of_places_is_one_grid(path: Path) -> None:
    """In any order, with noise of single precision, one place twice, and local times of two zones."""
    places = [(47.1, 8.0), (47.0, 8.25), (47.1, 8.25), (47.000001, 8.000004), (47.0, 8.25)]
    answers = [
        _answer(latitude, longitude, elevation=latitude * 10, hourly={"wind_speed_10m": [latitude, longitude]},
                units={"wind_speed_10m": "m/s"})
        for latitude, longitude in places
    ]  # fmt: skip
    answers[0].update(utc_offset_seconds=3600)
    answers[0]["hourly"]["time"] = ["2026-05-01T13:00", "2026-05-01T14:00"]
    fields, _ = _fields(path, answers)
    assert len({id(field2d.grid) for field2d in fields}) == 1
    grid = fields[0].grid
    np.testing.assert_allclose(grid.latitudes, [47.0, 47.1], atol=1e-5)
    np.testing.assert_allclose(grid.longitudes, [8.0, 8.25], atol=1e-5)
    rows, columns = np.array([1, 0]), np.array([0, 1])
    both = [field2d.read(rows, columns) for field2d in fields if field2d.quantity == "speed"]
    np.testing.assert_allclose(both[0], [[47.1, 47.1], [47.0, 47.0]], atol=1e-5)
    np.testing.assert_allclose(both[1], [[8.0, 8.25], [8.0, 8.25]], atol=1e-5)
    terrain = next(field2d for field2d in fields if field2d.quantity == "terrain")
    np.testing.assert_allclose(terrain.read(rows, columns), [[471, 471], [470, 470]], atol=1e-4)


def test_places_in_no_lattice_are_refused(path: Path) -> None:
    answers = [_answer(47.0, 8.0), _answer(47.1, 8.0), _answer(47.05, 8.2)]
    assert "its 3 places form no lattice of latitudes and longitudes: 3 of 6 nodes are missing" in _say(path, answers)


def test_places_with_other_times_are_refused_and_with_other_fields_have_gaps(path: Path) -> None:
    later = _answer(47.1, utc_offset_seconds=0)
    assert "its places have different times" in _say(path, [_answer(), later])
    bare = _answer(47.1, hourly={"wind_speed_10m": [None, None], "wind_gusts_10m": [1.0, 1.0],
                                 "wind_speed_80m": [1.0, 1.0], "wind_direction_80m": [1, 1]},
                   units={"wind_gusts_10m": "m/s", "wind_speed_80m": "m/s", "wind_direction_80m": "°"})  # fmt: skip
    fields, unused = _fields(path, [_answer(), bare])
    speed = next(field2d for field2d in fields if field2d.quantity == "speed" and field2d.level == TEN)
    np.testing.assert_allclose(speed.read(np.array([0, 1]), ZERO), [[10.0], [np.nan]])
    assert unused == ("wind_speed_10m: without any value", "wind_direction_10m: without speed")


def test_a_speed_without_a_direction_is_said_and_an_error_if_there_is_no_other(path: Path) -> None:
    hourly, units = {"wind_speed_80m": [1.0, 1.0]}, {"wind_speed_80m": "m/s"}
    fields, unused = _fields(path, _answer(hourly=hourly, units=units))
    assert unused == ("wind_speed_80m: without direction",)
    assert {field2d.level for field2d in fields if field2d.quantity == "speed"} == {TEN}
    message = _say(path, _answer(hourly={"wind_direction_10m": None}))
    assert message.startswith("has no wind of known direction (wind_speed_10m: without direction): ask for `hourly=")


def test_fields_of_several_models_are_pointed_out(path: Path) -> None:
    hourly = {"wind_speed_80m_icon_seamless": [1.0, 1.0], "wind_direction_80m_gfs_seamless": [1, 1]}
    assert _fields(path, _answer(hourly=hourly))[1] == (
        "fields of several models (gfs_seamless, icon_seamless): ask for one model",
    )


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"units": {"wind_speed_10m": None}}, "wind_speed_10m has no units"),
        ({"units": {"wind_speed_10m": "furlongs"}}, "wind_speed_10m is in 'furlongs'"),
        ({"units": {"wind_direction_10m": None}}, "wind_direction_10m has no units"),
        ({"hourly_units": None}, "has no `hourly_units`"),
        ({"units": {"time": None}}, "has times in None, which are neither iso8601 nor unixtime"),
        ({"hourly": {"time": None}}, "has no times"),
        ({"hourly": {"time": ["2026-05-01T14:00", "soon"]}}, "has a time 'soon' that cannot be read"),
        ({"utc_offset_seconds": None}, "has no `utc_offset_seconds`"),
        ({"hourly": {"time": [0, None]}, "units": {"time": "unixtime"}}, "has a time that is none"),
        ({"utc_offset_seconds": 1e300}, "has a time '2026-05-01T14:00' that cannot be read"),
        ({"hourly": {"wind_speed_10m": [1.0, 10**400]}}, "has wind_speed_10m beyond all numbers"),
        ({"hourly": {"wind_speed_10m": [1.0]}}, "has 1 values of wind_speed_10m for 2 times"),
        ({"hourly": {"wind_speed_10m": 3.0}}, "has no values of wind_speed_10m for 2 times"),
        ({"hourly": {"wind_speed_10m": [1.0, "strong"]}}, "has wind_speed_10m 'strong', which is no number"),
        ({"latitude": None}, "has no latitude and longitude"),
        ({"latitude": "47"}, "has latitude '47', which is no number"),
        ({"hourly": {"wind_speed_10m": [None, None], "wind_direction_10m": [None, None]}}, "without any value"),
        ({"hourly": {"wind_speed_10m": None, "wind_direction_10m": None}}, "has no wind by the hour"),
    ],
)
def test_what_is_missing_or_odd_is_an_error(path: Path, changes: dict[str, Any], message: str) -> None:
    latitude = {"latitude": changes.pop("latitude")} if "latitude" in changes else {}
    answer = {name: value for name, value in {**_answer(**changes), **latitude}.items() if value is not None}
    assert message in _say(path, answer)


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ({"error": True, "reason": "Daily API request limit exceeded."}, "tells: Daily API request limit exceeded."),
        ([_answer(), {"error": True, "reason": "out of range"}], "is an error that Open-Meteo tells: out of range"),
        ([], "is an empty list"),
        ([1, 2], "is JSON, but no answer of Open-Meteo"),
        ({"type": "FeatureCollection"}, "no latitude and longitude"),
        ("wind", "is JSON, but no answer of Open-Meteo"),
    ],
)
def test_other_json_is_told_from_an_answer(path: Path, answer: Any, message: str) -> None:
    assert message in _say(path, answer)


@pytest.mark.parametrize("data", [b'{"latitude": 47.0, "hourly": {"time": [', b"{\xff\xfe", b"[" * 100_000])
def test_broken_json_is_an_error(path: Path, data: bytes) -> None:
    path.write_bytes(data)
    with (
        pytest.raises(WindError, match=r"answer\.json: is no complete JSON .*: download it again"),
        open_openmeteo(path),
    ):
        pass


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_byte_order_marks_do_no_harm(path: Path, encoding: str) -> None:
    """PowerShell's `>` writes UTF-16."""
    path.write_text(json.dumps(_answer()), encoding=encoding)
    with open_openmeteo(path) as index:
        assert len(index.fields) == 5


def test_it_needs_no_other_library_than_numpy() -> None:
    heavy = "{'netCDF4', 'eccodes', 'rasterio', 'numba'}"
    code = f"import sys, gcs_windplan.wind.files.openmeteo; print(*{heavy} & set(sys.modules))"
    assert run([sys.executable, "-c", code], capture_output=True, check=True, text=True).stdout.strip() == ""

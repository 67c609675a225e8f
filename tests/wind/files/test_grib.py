"""GRIB files as eccodes writes them, each with a trap; and real forecasts, read beside eccodes' own way."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import eccodes
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.field_index import Field2D, FieldIndex, Level
from gcs_windplan.wind.files.grib import open_grib
from tests.wind.grib_files import box, in_one_message, message, stored

ONE_CM_PER_SECOND = 0.01
TEN_METRES = 1e-4  # [deg]
DATA = Path(__file__).resolve().parents[3].parent / "shared" / "data" / "wind"
NOON = datetime(2026, 5, 1, 12, tzinfo=UTC).timestamp()
HALF_LEVELS = [0.0, 2000.0, 4000.0, 0.0, 0.0, 0.1, 0.6, 1.0]  # a [Pa], then b

Opened = Callable[..., FieldIndex]


@pytest.fixture
def opened(tmp_path: Path) -> Any:
    """Writes messages to a file and opens it until the test ends."""
    contexts = []

    def write_and_open(*messages: bytes) -> FieldIndex:
        path = tmp_path / f"wind{len(contexts)}.grib"
        path.write_bytes(b"".join(messages))
        contexts.append(open_grib(path))
        return contexts[-1].__enter__()

    yield write_and_open
    for context in contexts:
        context.__exit__(None, None, None)


def _real(name: str) -> Path:
    if not (DATA / name).exists():
        pytest.skip(f"{name} is not on this machine: the shared test data are missing")
    return DATA / name


def _numbers(parameter: int, category: int = 2) -> dict[str, int]:
    """The keys of a parameter of edition 2 by its numbers, momentum (2) if not said otherwise."""
    return {"discipline": 0, "parameterCategory": category, "parameterNumber": parameter}


def _whole(field2d: Field2D) -> FloatArray:
    rows, columns = field2d.grid.shape
    return field2d.read(np.arange(rows), np.arange(columns))


def _only(index: FieldIndex) -> Field2D:
    (field2d,) = index.fields
    return field2d


def _levels(index: FieldIndex) -> list[tuple[str, Level]]:
    return [(field2d.quantity, field2d.level) for field2d in index.fields]


def _say(path: Path) -> str:
    with pytest.raises(WindError) as error, open_grib(path):
        pass
    assert str(error.value).startswith(f"{path}: ")
    return str(error.value)


def _places(field2d: Field2D) -> tuple[FloatArray, FloatArray]:
    """Latitudes and longitudes of all nodes."""
    grid = field2d.grid
    if grid.regular:
        return np.broadcast_arrays(grid.latitudes[:, np.newaxis], grid.longitudes)
    return grid.latitudes, grid.longitudes


# ---------------------------------------------------------------------------------------------- real files


@pytest.mark.parametrize(
    "name",
    [
        "ecmwf_data_uv.grib",
        "ecmwf_ens_ztu_multi_dim.grib",
        "ecmwf_pl_regular_ll_10deg.grib",
        "ecmwf_uv_on_different_levels.grib",
    ],
)
def test_ten_values_of_a_real_file_are_those_that_eccodes_finds_nearest(name: str) -> None:
    path, random = _real(name), np.random.default_rng(10)
    with open_grib(path) as index:
        for number in random.choice(len(index.fields), 10):
            field2d = index.fields[number]
            row, column = (int(random.integers(size)) for size in field2d.grid.shape)
            value = field2d.read(np.array([row]), np.array([column]))[0, 0]
            expected = _found_by_eccodes(path, field2d, field2d.grid.latitudes[row], field2d.grid.longitudes[column])
            assert value == pytest.approx(expected, abs=ONE_CM_PER_SECOND)


def _found_by_eccodes(path: Path, field2d: Field2D, latitude: float, longitude: float) -> float:
    """The value at a node of the message that holds a field."""
    wanted = (field2d.name, field2d.level.value / 100, field2d.time, field2d.run, field2d.member or 0)
    with path.open("rb") as file:
        while (handle := eccodes.codes_grib_new_from_file(file)) is not None:
            try:
                get = eccodes.codes_get
                times = [_seconds(get(handle, f"{k}Date"), get(handle, f"{k}Time")) for k in ("validity", "data")]
                if (get(handle, "shortName"), get(handle, "level"), *times, get(handle, "number")) == wanted:
                    (near,) = eccodes.codes_grib_find_nearest(handle, latitude, longitude)
                    assert near.distance < 0.1
                    return float(near.value) / (9.80665 if field2d.name == "z" else 1.0)
            finally:
                eccodes.codes_release(handle)
    raise AssertionError(f"no message is {wanted}")


def _seconds(date: int, time: int) -> float:
    day = datetime(date // 10000, date // 100 % 100, date % 100, tzinfo=UTC)
    return (day + timedelta(hours=time // 100, minutes=time % 100)).timestamp()


def test_the_real_ensemble_has_its_members_and_all_fields_share_one_grid() -> None:
    with open_grib(_real("ecmwf_ens_ztu_multi_dim.grib")) as index:
        assert {field2d.member for field2d in index.fields} == {1, 2, 3, 4, 5, 6}
        assert Counter(field2d.quantity for field2d in index.fields) == {"height": 96, "u": 96}
        assert len({id(field2d.grid) for field2d in index.fields}) == 1
        assert index.title.startswith("European Centre")


def test_a_real_deterministic_forecast_has_no_members_and_all_its_runs() -> None:
    with open_grib(_real("ecmwf_pl_regular_ll_10deg.grib")) as index:
        assert {field2d.member for field2d in index.fields} == {None}
        assert len({field2d.run for field2d in index.fields}) == 4
        assert {field2d.time - field2d.run for field2d in index.fields} == {0.0, 6 * 3600.0}


# ---------------------------------------------------------------------------------------------- what and where


@pytest.mark.parametrize("edition", [1, 2])
def test_wind_on_a_pressure_level(opened: Opened, edition: int) -> None:
    field2d = _only(opened(message("u", 5.0, edition)))
    assert (field2d.quantity, field2d.level, field2d.name) == ("u", Level("pressure", 85000.0), "u")
    assert (field2d.units, field2d.member, field2d.along_grid, field2d.half_levels) == ("m s**-1", None, False, None)
    assert field2d.grid.name == "latitude-longitude grid, 3 x 4"
    np.testing.assert_array_equal(field2d.grid.latitudes, [50, 51, 52])
    np.testing.assert_array_equal(field2d.grid.longitudes, [8, 9, 10, 11])
    np.testing.assert_allclose(_whole(field2d), np.full((3, 4), 5.0))


@pytest.mark.parametrize(
    ("name", "edition", "quantity", "height"),
    [
        ("10u", 1, "u", 10), ("10v", 1, "v", 10), ("100u", 1, "u", 100), ("100v", 1, "v", 100), ("200u", 1, "u", 200),
        ("10u", 2, "u", 10), ("10v", 2, "v", 10), ("100u", 2, "u", 100), ("100v", 2, "v", 100), ("200v", 2, "v", 200),
        ("10si", 1, "speed", 10), ("10si", 2, "speed", 10), ("10wdir", 2, "direction", 10), ("10fg", 1, "gust", 10),
        ("10fg3", 1, "gust", 10), ("i10fg", 2, "gust", 10), ("10fg", 2, "gust", 10),
    ],
)  # fmt: skip
def test_a_name_with_a_height_is_at_that_height(
    opened: Opened, name: str, edition: int, quantity: str, height: float
) -> None:
    """Edition 1 of ECMWF says "surface", level 0, to all of them."""
    index = opened(message(name, edition=edition, typeOfLevel="surface", level=0))
    assert _levels(index) == [(quantity, Level("height", height))]


@pytest.mark.parametrize(
    ("edition", "kind", "level", "expected"),
    [
        (1, "heightAboveGround", 80, Level("height", 80)),
        (2, "heightAboveGround", 80, Level("height", 80)),
        (1, "heightAboveSea", 500, Level("altitude", 500)),
        (2, "heightAboveSea", 500, Level("altitude", 500)),
        (1, "isobaricInPa", 500, Level("pressure", 500)),
        (2, "isobaricInPa", 50, Level("pressure", 50)),
        (1, "hybrid", 90, Level("model", 90)),
        (2, "hybrid", 90, Level("model", 90)),
        (2, "hybridHeight", 3, Level("model", 3)),
        (2, "hybridPressure", 3, Level("model", 3)),
        (1, "surface", 0, Level("surface")),
        (2, "surface", 0, Level("surface")),
        (1, "meanSea", 0, Level("altitude")),
        (2, "meanSea", 0, Level("altitude")),
    ],
)
def test_kinds_of_levels(opened: Opened, edition: int, kind: str, level: int, expected: Level) -> None:
    index = opened(message("u", edition=edition, typeOfLevel=kind, level=level))
    assert _levels(index) == [("u", expected)]


@pytest.mark.parametrize(
    ("surface", "scaled", "factor", "expected"),
    [
        (100, 92550, 0, Level("pressure", 92550)),  # eccodes' own `level` says 925 hPa
        (100, 925, -2, Level("pressure", 92500)),
        (103, 15, 1, Level("height", 1.5)),  # eccodes' own `level` says 2
        (102, 1, -3, Level("altitude", 1000)),
    ],
)
def test_scaled_levels_keep_their_digits(
    opened: Opened, surface: int, scaled: int, factor: int, expected: Level
) -> None:
    keys = {
        "typeOfFirstFixedSurface": surface,
        "scaleFactorOfFirstFixedSurface": factor,
        "scaledValueOfFirstFixedSurface": scaled,
    }
    assert _levels(opened(message("", **_numbers(2), **keys))) == [("u", expected)]


def test_a_layer_between_two_general_vertical_surfaces_is_a_model_level_and_one_alone_is_not(opened: Opened) -> None:
    """As ICON has them: wind in layers, heights at their edges."""
    layer = {f"scaledValueOf{which}FixedSurface": level for which, level in (("First", 65), ("Second", 66))}
    layer |= {"typeOfFirstFixedSurface": 150, "typeOfSecondFixedSurface": 150}
    layer |= {f"scaleFactorOf{which}FixedSurface": 0 for which in ("First", "Second")}
    wind = message("", **_numbers(2), **layer)
    edge = message("", **_numbers(6, 3), **(layer | {"typeOfSecondFixedSurface": 255}))
    assert _levels(opened(wind, edge)) == [("u", Level("model", 65))]


@pytest.mark.parametrize("kind", ["tropopause", "maxWind", "theta", "heightAboveGroundLayer"])
def test_wind_at_no_known_height_is_counted(opened: Opened, kind: str) -> None:
    index = opened(message("u", typeOfLevel=kind), message("v", typeOfLevel=kind), message("t", typeOfLevel=kind))
    assert index.fields == ()
    assert index.unused == (f"2 fields of wind at no known height ({kind}): not used",)


@pytest.mark.parametrize("edition", [1, 2])
def test_quantities_beside_the_wind_and_their_units(opened: Opened, edition: int) -> None:
    ground = {"edition": edition, "typeOfLevel": "surface", "level": 0}
    aloft = {"edition": edition, "typeOfLevel": "hybrid", "level": 90}
    index = opened(
        message("z", 9806.65, edition),
        message("gh", 1000.0, edition),
        message("z", 980.665, **ground),
        message("gh" if edition == 1 else "orog", 100.0, **ground),
        message("sr" if edition == 1 else "fsr", 0.25, **ground),
        message("sp", 1e5, **ground),
        message("t", 280.0, **aloft),
        message("q", 0.01, **aloft),
        message("lnsp", np.log(1e5), **(aloft | {"level": 1})),
        message("t", 280.0, edition),  # not on a model level
        message("2t", 280.0, **ground),
        message("r", 50.0, edition),
    )
    expected = [
        ("height", Level("pressure", 85000), 1000.0), ("height", Level("pressure", 85000), 1000.0),
        ("terrain", Level("surface"), 100.0), ("terrain", Level("surface"), 100.0),
        ("roughness", Level("surface"), 0.25), ("pressure", Level("surface"), 1e5),
        ("temperature", Level("model", 90), 280.0), ("humidity", Level("model", 90), 0.01),
        ("pressure", Level("surface"), 1e5),
    ]  # fmt: skip
    assert [(q, level) for q, level, _ in expected] == _levels(index)
    for field2d, (_, _, value) in zip(index.fields, expected, strict=True):
        np.testing.assert_allclose(_whole(field2d), value, rtol=1e-5)
    assert [field2d.time for field2d in index.fields if field2d.quantity == "terrain"] == [None, None]
    assert index.unused == ()


def test_a_geopotential_on_model_level_1_alone_is_the_terrain(opened: Opened) -> None:
    """So ECMWF keeps it; on several levels it is their height."""
    one, two = (message("z", 980.665, typeOfLevel="hybrid", level=level) for level in (1, 2))
    wind = message("u", typeOfLevel="hybrid", level=137)
    assert _levels(opened(one, wind)) == [("terrain", Level("surface")), ("u", Level("model", 137))]
    assert _levels(opened(one, two)) == [("height", Level("model", 1)), ("height", Level("model", 2))]


def test_names_of_deutscher_wetterdienst_are_known(opened: Opened) -> None:
    """SP is a wind speed there, sp a pressure elsewhere."""
    keys = {"centre": 78, "table2Version": 2, "indicatorOfTypeOfLevel": 105, "level": 10}
    fields = [message("", edition=1, **keys, indicatorOfParameter=number) for number in (31, 32, 33, 34)]
    ground = [
        message("", value, centre=78, typeOfLevel="surface", **_numbers(number, 3))
        for number, value in ((4, 980.665), (6, 100.0))
    ]
    index = opened(*fields, *ground)
    ten = Level("height", 10)
    assert _levels(index) == [
        ("direction", ten), ("speed", ten), ("u", ten), ("v", ten),
        ("terrain", Level("surface")), ("terrain", Level("surface")),
    ]  # fmt: skip
    for field2d in index.fields[-2:]:
        np.testing.assert_allclose(_whole(field2d), 100.0, rtol=1e-6)


@pytest.mark.parametrize("edition", [1, 2])
def test_half_levels_come_from_the_coefficients(opened: Opened, edition: int) -> None:
    one, two = (message("u", edition=edition, typeOfLevel="hybrid", level=level, pv=HALF_LEVELS) for level in (1, 2))
    first, second = opened(one, two).fields
    assert first.half_levels is not None
    np.testing.assert_allclose(first.half_levels[0], HALF_LEVELS[:4], rtol=1e-6)
    np.testing.assert_allclose(first.half_levels[1], HALF_LEVELS[4:], rtol=1e-6)
    assert second.half_levels is first.half_levels


@pytest.mark.parametrize("pv", [[1.0, 2.0, 3.0], [-5.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.5]])
def test_coefficients_of_another_kind_are_left_alone(opened: Opened, pv: list[float]) -> None:
    assert _only(opened(message("u", typeOfLevel="hybrid", level=1, pv=pv))).half_levels is None


# ---------------------------------------------------------------------------------------------- when and which


@pytest.mark.parametrize(
    ("edition", "unit", "steps"),
    [(e, u, n) for e in (1, 2) for u, n in [(0, 45), (0, 90), (1, 0), (1, 7), (2, 2), (10, 2), (11, 1), (12, 3)]]
    + [(1, 13, 3), (1, 14, 1), (2, 13, 1800), (2, 1, 400)],
)
def test_times_agree_with_those_of_eccodes(opened: Opened, edition: int, unit: int, steps: int) -> None:
    when = {"dataDate": 20240228, "dataTime": 2330, "indicatorOfUnitOfTimeRange": unit}
    field = message("u", edition=edition, **when, **{"P1" if edition == 1 else "forecastTime": steps})
    handle = eccodes.codes_new_from_message(field)
    moment = _seconds(*(eccodes.codes_get_long(handle, key) for key in ("validityDate", "validityTime")))
    eccodes.codes_release(handle)
    field2d = _only(opened(field))
    assert (field2d.time, field2d.run) == (moment, _seconds(20240228, 2330))


def test_steps_of_edition_1_beyond_255_hours(opened: Opened) -> None:
    assert _only(opened(message("u", edition=1, step=360))).time == NOON + 360 * 3600


def test_an_analysis_of_edition_1_is_of_its_own_time(opened: Opened) -> None:
    assert _only(opened(message("u", edition=1, timeRangeIndicator=1, P1=6, P2=3))).time == NOON


def test_steps_may_go_back(opened: Opened) -> None:
    assert _only(opened(message("u", forecastTime=-3))).time == NOON - 3 * 3600


def test_months_are_counted_and_not_used(opened: Opened) -> None:
    index = opened(message("u", indicatorOfUnitOfTimeRange=3, forecastTime=1))
    assert index.fields == ()
    assert "1 field without a time that can be read" in index.unused[0]


@pytest.mark.parametrize(("edition", "process", "keys"), [
    (2, "average", {"stepType": "avg"}), (2, "maximum", {"stepType": "max"}), (1, "average", {"stepType": "avg"}),
])  # fmt: skip
def test_averages_and_maxima_over_time_are_no_wind(
    opened: Opened, edition: int, process: str, keys: dict[str, Any]
) -> None:
    span = {"stepRange": "3-6"}
    fields = [message(name, edition=edition, **keys, **span) for name in ("u", "v")]
    assert opened(*fields).unused == ("2 fields of averages or extremes over time: not used",)


@pytest.mark.parametrize(("edition", "centre", "name"), [(1, 98, "10fg"), (2, 98, "10fg"), (2, 7, "")])
def test_a_gust_is_the_strongest_up_to_its_time(opened: Opened, edition: int, centre: int, name: str) -> None:
    keys = {"stepType": "max"} if edition == 1 else {**_numbers(22), "productDefinitionTemplateNumber": 8}
    if edition == 2:
        keys |= {"typeOfLevel": "heightAboveGround", "level": 10, "typeOfStatisticalProcessing": 2}
    field2d = _only(opened(message(name, 20.0, edition, centre=centre, **keys, stepRange="3-6")))
    assert (field2d.quantity, field2d.time) == ("gust", NOON + 6 * 3600)


def test_a_mean_gust_is_no_gust(opened: Opened) -> None:
    mean = message("", 9.0, productDefinitionTemplateNumber=8, typeOfStatisticalProcessing=0, **_numbers(22))
    assert opened(mean).unused == ("1 field of averages or extremes over time: not used",)


@pytest.mark.parametrize("edition", [1, 2])
def test_members_of_an_ensemble_are_numbered_and_the_control_is_0(opened: Opened, edition: int) -> None:
    assert [field2d.member for field2d in opened(*_ensemble(edition)).fields] == [0, 1, 2]


def _ensemble(edition: int) -> list[bytes]:
    if edition == 1:
        return [message("u", edition=1, type="pf" if n else "cf", number=n) for n in range(3)]
    keys = {"productDefinitionTemplateNumber": 1, "numberOfForecastsInEnsemble": 3}
    return [message("u", **keys, typeOfProcessedData=4 if n else 3, perturbationNumber=n) for n in range(3)]


@pytest.mark.parametrize(
    "keys",
    [
        {"edition": 1, "type": "fc", "number": 0},
        {"edition": 2, "typeOfProcessedData": 1},
        {"edition": 2, "productDefinitionTemplateNumber": 1, "typeOfProcessedData": 1, "perturbationNumber": 0},
    ],
)
def test_a_deterministic_forecast_is_no_member_0(opened: Opened, keys: dict[str, Any]) -> None:
    assert _only(opened(message("u", **keys))).member is None


def test_gusts_of_members(opened: Opened) -> None:
    field2d = _only(
        opened(message("10fg", 20.0, productDefinitionTemplateNumber=11, perturbationNumber=7, stepRange="0-3"))
    )
    assert (field2d.quantity, field2d.member, field2d.time) == ("gust", 7, NOON + 3 * 3600)


def _derived(edition: int, mean: bool) -> bytes:
    if edition == 1:
        return message("u", edition=1, type="em" if mean else "es")
    return message("u", productDefinitionTemplateNumber=2, derivedForecast=0 if mean else 4)


@pytest.mark.parametrize("edition", [1, 2])
def test_a_spread_is_never_a_wind_and_a_mean_only_where_there_are_no_members(opened: Opened, edition: int) -> None:
    mean, spread = _derived(edition, mean=True), _derived(edition, mean=False)
    statistics = "1 field of spreads, probabilities or other statistics of an ensemble: not used"
    alone = opened(mean, spread)
    assert (len(alone.fields), alone.fields[0].member, alone.unused) == (1, None, (statistics,))
    beside = opened(*_ensemble(edition), mean, spread)
    assert [field2d.member for field2d in beside.fields] == [0, 1, 2]
    assert beside.unused == (statistics, "1 field of means of an ensemble whose members are there too: not used")


@pytest.mark.parametrize("template", [5, 6, 9, 10])
def test_probabilities_and_percentiles_are_no_wind(opened: Opened, template: int) -> None:
    index = opened(message("", productDefinitionTemplateNumber=template, **_numbers(2)))
    assert index.fields == ()
    assert len(index.unused) == 1


# ---------------------------------------------------------------------------------------------- grids


def _slope(latitude: FloatArray, longitude: FloatArray) -> FloatArray:
    """A wind [m/s] that tells where it is."""
    return latitude + 0.1 * ((longitude + 180.0) % 360.0 - 180.0)


@pytest.mark.parametrize(
    ("edition", "scanning"), [(2, n) for n in range(0, 256, 16)] + [(1, n) for n in range(0, 256, 32)]
)
def test_every_scanning_mode_gives_the_same_wind_at_the_same_place(opened: Opened, edition: int, scanning: int) -> None:
    latitudes, longitudes = np.linspace(50.0, 53.0, 4), np.linspace(8.0, 12.0, 5)
    values = stored(_slope(latitudes[:, np.newaxis], longitudes), scanning)
    edges = [(53.0, 50.0), (8.0, 12.0)]
    north, south = edges[0][::-1] if scanning & 64 else edges[0]
    west, east = edges[1][::-1] if scanning & 128 else edges[1]
    grid = box() | {
        "Ni": 5, "Nj": 4, "scanningMode": scanning,
        "latitudeOfFirstGridPointInDegrees": north, "latitudeOfLastGridPointInDegrees": south,
        "longitudeOfFirstGridPointInDegrees": west, "longitudeOfLastGridPointInDegrees": east,
    }  # fmt: skip
    field2d = _only(opened(message("u", values, edition, grid)))
    np.testing.assert_allclose(field2d.grid.latitudes, latitudes)
    np.testing.assert_allclose(field2d.grid.longitudes, longitudes)
    np.testing.assert_allclose(_whole(field2d), _slope(*_places(field2d)), atol=ONE_CM_PER_SECOND)


def test_flags_that_edition_1_reserves_mean_nothing(opened: Opened) -> None:
    values = np.arange(12.0)
    plain, odd = opened(*(message("u", values, 1, box(scanningMode=scanning)) for scanning in (0, 16 | 1))).fields
    np.testing.assert_array_equal(_whole(odd), _whole(plain))


@given(scanning=st.sampled_from(range(0, 256, 16)), rows=st.integers(1, 6), columns=st.integers(1, 6))
def test_putting_values_in_order_undoes_how_they_are_stored(scanning: int, rows: int, columns: int) -> None:
    from gcs_windplan.wind.files.grib_grid import in_order

    values = np.arange(rows * columns, dtype=np.float64).reshape(rows, columns)
    np.testing.assert_array_equal(in_order(stored(values, scanning), (rows, columns), scanning), values)


#: eccodes has no key `uvRelativeToGrid` in edition 2 on polar stereographic and equal-area grids.
ALONG_GRID = {1: {"resolutionAndComponentFlags": 136}, 2: {"resolutionAndComponentFlags": 56}}
PROJECTED: dict[str, tuple[str, dict[str, Any]]] = {
    "lambert": (
        "+proj=lcc +lat_1=47.5 +lat_2=52 +lat_0=49 +lon_0=10",
        {"LaDInDegrees": 49.0, "LoVInDegrees": 10.0, "Latin1InDegrees": 47.5, "Latin2InDegrees": 52.0},
    ),
    "lambert, southern": (
        "+proj=lcc +lat_1=-40 +lat_2=-40 +lat_0=-40 +lon_0=170",
        {"LaDInDegrees": -40.0, "LoVInDegrees": 170.0, "Latin1InDegrees": -40.0, "Latin2InDegrees": -40.0},
    ),
    "polar_stereographic": (
        "+proj=stere +lat_0=90 +lat_ts=60 +lon_0=20",
        {"LaDInDegrees": 60.0, "orientationOfTheGridInDegrees": 20.0},
    ),
    "polar_stereographic, southern": (
        "+proj=stere +lat_0=-90 +lat_ts=-60 +lon_0=20",
        {"LaDInDegrees": -60.0, "orientationOfTheGridInDegrees": 20.0, "projectionCentreFlag": 128},
    ),
    "lambert_azimuthal_equal_area": (
        "+proj=laea +lat_0=52 +lon_0=10",
        {"standardParallelInDegrees": 52.0, "centralLongitudeInDegrees": 10.0},
    ),
    "mercator": ("+proj=merc +lat_ts=20", {"LaDInDegrees": 20.0}),
}  # fmt: skip
PROJECTED["polar_stereographic, southern, told by its flag"] = (
    "+proj=stere +lat_0=-90 +lat_ts=-60 +lon_0=20",
    PROJECTED["polar_stereographic, southern"][1] | {"LaDInDegrees": 60.0},
)
_CORNERS = {"lambert": (45.0, 5.0), "lambert, southern": (-44.0, 165.0), "polar_stereographic": (65.0, -10.0),
            "polar_stereographic, southern": (-70.0, 40.0),
            "polar_stereographic, southern, told by its flag": (-70.0, 40.0),
            "lambert_azimuthal_equal_area": (50.0, 4.0),
            "mercator": (30.0, -170.0)}  # fmt: skip


def _warp(source: str, target: str, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    from rasterio.warp import transform

    first, second = transform(source, target, np.ravel(x), np.ravel(y))
    return np.reshape(first, np.shape(x)), np.reshape(second, np.shape(x))


def _projected(
    name: str, scanning: int, earth: str = "+R=6371229", **keys: Any
) -> tuple[dict[str, Any], FloatArray, FloatArray]:
    """The keys of a grid of 4 x 5 nodes, 100 km apart, and where PROJ has them (rows northward, columns eastward)."""
    projection, own = PROJECTED[name]
    latitude, longitude = _CORNERS[name]
    globe = f"+proj=longlat {earth}"
    (x0,), (y0,) = _warp(globe, f"{projection} {earth}", np.array([longitude]), np.array([latitude]))
    x, y = np.meshgrid(x0 + 1e5 * np.arange(5), y0 + 1e5 * np.arange(4))
    longitudes, latitudes = _warp(f"{projection} {earth}", globe, x, y)
    first = (0 if scanning & 64 else -1, -1 if scanning & 128 else 0)
    steps = [f"{axis}InMetres" for axis in (("Di", "Dj") if name == "mercator" else ("Dx", "Dy"))]
    grid = {"gridType": name.split(",")[0], "Ni": 5, "Nj": 4, **own, **dict.fromkeys(steps, 100_000), **keys}
    grid |= {"latitudeOfFirstGridPointInDegrees": latitudes[first], "scanningMode": scanning}
    return grid | {"longitudeOfFirstGridPointInDegrees": longitudes[first] % 360.0}, latitudes, longitudes


@pytest.mark.parametrize("name", PROJECTED)
@pytest.mark.parametrize("scanning", range(0, 256, 16))
def test_the_nodes_of_projected_grids_are_where_proj_has_them(opened: Opened, name: str, scanning: int) -> None:
    """The first node is the one stored first, as FM 92 has it, and not always the lower left, as eccodes has it."""
    grid, latitudes, longitudes = _projected(name, scanning)
    field2d = _only(opened(message("u", stored(_slope(latitudes, longitudes), scanning), 2, grid, **ALONG_GRID[2])))
    assert field2d.along_grid
    assert field2d.grid.regular == (name == "mercator")
    found = _places(field2d)
    np.testing.assert_allclose(found[0], latitudes, atol=TEN_METRES)
    np.testing.assert_allclose((found[1] - longitudes + 180.0) % 360.0, 180.0, atol=TEN_METRES)
    np.testing.assert_allclose(_whole(field2d), _slope(latitudes, longitudes), atol=ONE_CM_PER_SECOND)


@pytest.mark.parametrize("scanning", [0, 64])
@pytest.mark.parametrize("name", ["lambert", "polar_stereographic"])
def test_projected_grids_of_edition_1(opened: Opened, name: str, scanning: int) -> None:
    """Its angles are rounded to 0.001 degrees, and the origin of Lambert grids does not matter."""
    grid, latitudes, longitudes = _projected(name, scanning, "+R=6367470")
    grid.pop("LaDInDegrees")
    field2d = _only(opened(message("u", stored(_slope(latitudes, longitudes), scanning), 1, grid, **ALONG_GRID[1])))
    assert field2d.along_grid
    np.testing.assert_allclose(field2d.grid.latitudes, latitudes, atol=6e-4)
    np.testing.assert_allclose((field2d.grid.longitudes - longitudes + 180.0) % 360.0, 180.0, atol=1e-3)


@pytest.mark.parametrize("name", ["lambert", "mercator"])
def test_projected_grids_on_an_ellipsoid(opened: Opened, name: str) -> None:
    grid, latitudes, _ = _projected(name, 64, "+ellps=GRS80", shapeOfTheEarth=4)
    field2d = _only(opened(message("u", 5.0, 2, grid)))
    np.testing.assert_allclose(_places(field2d)[0], latitudes, atol=TEN_METRES)
    assert not field2d.along_grid


@pytest.mark.parametrize(("edition", "scanning"), [(e, n) for e in (1, 2) for n in (0, 64, 128, 192, 32)] + [(2, 80)])
def test_rotated_grids_lie_at_their_true_places(opened: Opened, edition: int, scanning: int) -> None:
    pole = {"latitudeOfSouthernPoleInDegrees": -40.0, "longitudeOfSouthernPoleInDegrees": 10.0}
    y, x = np.linspace(-2.0, 1.0, 4), np.linspace(-3.0, 1.0, 5)
    rotation = "+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p=40 +lon_0=10 +R=6371229"
    mesh = np.meshgrid(x, y)
    longitudes, latitudes = _warp(rotation, "+proj=longlat +R=6371229", *mesh)
    edges = (y[[0, -1]] if scanning & 64 else y[[-1, 0]], x[[-1, 0]] if scanning & 128 else x[[0, -1]])
    grid = box(*edges[0], *edges[1]) | pole | {"Ni": 5, "Nj": 4, "gridType": "rotated_ll", "scanningMode": scanning}
    grid = {"gridType": "rotated_ll", **grid}
    values = stored(_slope(latitudes, longitudes), scanning)
    field2d = _only(opened(message("u", values, edition, grid, **ALONG_GRID[edition])))
    assert field2d.along_grid
    np.testing.assert_allclose(field2d.grid.latitudes, latitudes, atol=TEN_METRES)
    np.testing.assert_allclose((field2d.grid.longitudes - longitudes + 180.0) % 360.0, 180.0, atol=TEN_METRES)
    np.testing.assert_allclose(_whole(field2d), _slope(latitudes, longitudes), atol=ONE_CM_PER_SECOND)


def test_on_latitudes_and_longitudes_components_are_never_along_the_grid(opened: Opened) -> None:
    assert not _only(opened(message("u", **ALONG_GRID[2]))).along_grid


@pytest.mark.parametrize(
    ("west", "east", "step", "columns"),
    [
        (0.0, 359.0, 1.0, 360), (0.0, 360.0, 1.0, 361), (358.0, 2.0, 1.0, 5), (-2.0, 2.0, 1.0, 5),
        (0.0, 359.75, 0.25, 1440), (350.0, 10.0, 2.5, 9), (179.0, 181.0, 0.5, 5), (180.0, 179.0, 1.0, 360),
    ],
)  # fmt: skip
@pytest.mark.parametrize("edition", [1, 2])
def test_longitudes_cross_greenwich_and_go_round_the_globe(
    opened: Opened, edition: int, west: float, east: float, step: float, columns: int
) -> None:
    grid = box(51.0, 50.0, west, east, step) | {"Ni": columns, "Nj": 2}
    values = np.tile(np.arange(columns, dtype=np.float64), 2)
    field2d = _only(opened(message("u", values, edition, grid)))
    assert field2d.grid.shape == (2, columns)
    np.testing.assert_allclose(field2d.grid.longitudes % 360.0, (west + step * np.arange(columns)) % 360.0, atol=1e-6)
    np.testing.assert_allclose(field2d.read(np.array([0]), np.arange(columns))[0], np.arange(columns), atol=1e-3)


def test_steps_that_edition_1_rounds_do_not_move_the_far_end(opened: Opened) -> None:
    """1/16 degree is told as 0.062 or 0.063: after 160 steps that is 0.08 degrees, 9 km."""
    grid = box(52.0, 51.0, 8.0, 18.0, 1 / 16)
    field2d = _only(opened(message("u", edition=1, grid=grid)))
    np.testing.assert_allclose(field2d.grid.longitudes, np.linspace(8.0, 18.0, 161), atol=1e-9)
    np.testing.assert_allclose(field2d.grid.latitudes, np.linspace(51.0, 52.0, 17), atol=1e-9)


def test_a_last_longitude_that_is_wrong_does_not_matter_where_the_steps_go_round_the_globe(opened: Opened) -> None:
    grid = box(51.0, 50.0, 0.0, 360.0, 1.0) | {"Ni": 360, "Nj": 2}
    np.testing.assert_allclose(_only(opened(message("u", grid=grid))).grid.longitudes, np.arange(360.0))


def test_longitudes_that_contradict_their_steps_are_an_error(tmp_path: Path) -> None:
    path = tmp_path / "wind.grib"
    path.write_bytes(message("u", grid=box() | {"iDirectionIncrementInDegrees": 2.0}))
    assert "4 longitudes in steps of 2 degrees do not span 3" in _say(path)


def test_a_grid_of_one_place_and_one_of_one_column(opened: Opened) -> None:
    place = box(50.0, 50.0, 8.0, 8.0) | {"Ni": 1, "Nj": 1}
    column = box(52.0, 50.0, 8.0, 8.0) | {"Ni": 1, "Nj": 3}
    first, second = opened(message("u", 5.0, grid=place), message("u", 5.0, grid=column)).fields
    assert (first.grid.shape, second.grid.shape) == ((1, 1), (3, 1))
    assert _whole(first) == [[5.0]]


def test_a_regular_gaussian_grid_has_rows_and_columns(opened: Opened) -> None:
    field2d = _only(opened(message("u", 5.0, sample="regular_gg_ml_grib2", grid={}, level=7, typeOfLevel="hybrid")))
    assert field2d.grid.regular
    assert field2d.grid.shape == (64, 128)
    np.testing.assert_allclose(field2d.grid.latitudes[::-1], list(eccodes.codes_get_gaussian_latitudes(32)), atol=1e-9)
    np.testing.assert_allclose(field2d.grid.longitudes, np.arange(128) * 360 / 128, atol=1e-3)
    assert field2d.half_levels is not None
    assert len(field2d.half_levels[0]) == len(field2d.half_levels[1]) == 92


@pytest.mark.parametrize(
    ("sample", "name", "said"),
    [
        (
            "reduced_gg_ml_grib2",
            "u",
            "2 fields on a reduced Gaussian grid: not read; ask for a regular grid, or make",
        ),
        ("reduced_gg_pl_32_grib1", "u", "2 fields on a reduced Gaussian grid: not read"),
        ("sh_ml_grib2", "u", "2 fields on spherical harmonics: not read"),
        (
            "sh_ml_grib2",
            "vo",
            "2 fields of vorticity and divergence: make wind of them, for example with `cdo dv2uvl`",
        ),
    ],
)
def test_other_grids_are_counted_with_what_to_do(opened: Opened, sample: str, name: str, said: str) -> None:
    keys: dict[str, Any] = {"grid": {}, "sample": sample, "typeOfLevel": "hybrid"}
    index = opened(message(name, level=3, **keys), message(name, level=4, **keys), message("u"))
    assert len(index.fields) == 1
    (text,) = index.unused
    assert text.startswith(said)
    assert "cdo " in text


@pytest.mark.parametrize(
    ("edition", "name", "keys", "said"),
    [
        (2, "polar_stereographic", {"shapeOfTheEarth": 4}, "southern or on an ellipsoid"),
        (1, "polar_stereographic", {"projectionCentreFlag": 128}, "southern or on an ellipsoid"),
        (2, "mercator", {"orientationOfTheGridInDegrees": 90.0}, "oblique Mercator"),
        (2, "lambert", {"scanningMode": 65}, "staggered"),
        (2, "", {"gridType": "rotated_ll", **box(), "angleOfRotation": 30.0}, "turned about its own pole"),
        (2, "", {"gridType": "space_view", "Ni": 4, "Nj": 3}, "a grid of type space_view"),
    ],
)
def test_grids_that_eccodes_would_misplace_are_counted(
    opened: Opened, capfd: pytest.CaptureFixture[str], edition: int, name: str, keys: dict[str, Any], said: str
) -> None:
    grid = _projected(name, 64)[0] if name else {}
    if edition == 1:
        grid.pop("LaDInDegrees")
    index = opened(message("u", 5.0, edition, grid | keys))
    assert index.fields == ()
    (text,) = index.unused
    assert said in text
    assert "not read" in text
    assert capfd.readouterr() == ("", "")


def test_fields_on_several_grids_each_have_their_own(opened: Opened) -> None:
    near, wide = box(), box(55.0, 45.0, 0.0, 20.0, 5.0)
    first, second, third = opened(message("u", grid=near), message("u", grid=wide), message("v", grid=near)).fields
    assert first.grid is third.grid
    assert second.grid.shape == (3, 5)


# ---------------------------------------------------------------------------------------------- values and files


@pytest.mark.parametrize("packing", ["grid_simple", "grid_complex", "grid_ccsds", "grid_jpeg", "grid_second_order"])
@pytest.mark.parametrize("missing", [9999.0, 3.0])
def test_missing_values_are_no_numbers(opened: Opened, packing: str, missing: float) -> None:
    """Whatever number stands for them in the packer: 9999 may well be a height."""
    values = np.arange(12.0) + 100.0
    values[5] = missing
    field2d = _only(opened(message("u", values, missing=missing, packingType=packing)))
    found = _whole(field2d)[::-1].ravel()
    assert np.isnan(found[5])
    np.testing.assert_allclose(np.delete(found, 5), np.delete(values, 5), atol=ONE_CM_PER_SECOND)


def test_a_constant_field_may_have_gaps(opened: Opened) -> None:
    found = _whole(_only(opened(message("u", [9999.0] + [5.0] * 11, missing=9999.0))))[::-1].ravel()
    assert np.isnan(found[0])
    assert set(found[1:]) == {5.0}


def test_a_true_9999_is_a_value(opened: Opened) -> None:
    values = np.full(12, 50.0)
    values[3], values[4] = 9999.0, -1.0
    found = _whole(_only(opened(message("gh", values, missing=-1.0))))[::-1].ravel()
    assert found[3] == pytest.approx(9999.0, abs=ONE_CM_PER_SECOND)
    assert np.isnan(found[4])


@pytest.fixture(params=["off", "on"])
def multi_support(request: pytest.FixtureRequest) -> Any:
    """eccodes' switch for messages of several fields, which holds for the whole process."""
    getattr(eccodes, f"codes_grib_multi_support_{request.param}")()
    yield request.param
    eccodes.codes_grib_multi_support_off()


@pytest.mark.usefixtures("multi_support")
@pytest.mark.parametrize("section", [3, 4])
def test_a_message_of_edition_2_may_hold_several_fields(tmp_path: Path, section: int) -> None:
    fields = [message("u", 3.0, level=850), message("v", np.arange(12.0), level=700), message("u", 5.0, level=500)]
    path = in_one_message(tmp_path / "wind.grib", fields, section)
    with path.open("ab") as file:
        file.write(message("v", 6.0, 1))
    with open_grib(path) as index:
        levels = [(field2d.quantity, field2d.level.value) for field2d in index.fields]
        assert levels == [("u", 85000), ("v", 70000), ("u", 50000), ("v", 85000)]
        assert len({id(field2d.grid) for field2d in index.fields}) == 2  # one an edition
        means = [float(_whole(field2d).mean()) for field2d in reversed(index.fields)]
        assert means == pytest.approx([6.0, 5.0, 5.5, 3.0], abs=ONE_CM_PER_SECOND)


def test_reading_does_not_turn_eccodes_switch_for_several_fields(tmp_path: Path) -> None:
    path = in_one_message(tmp_path / "wind.grib", [message("u"), message("v")])
    with open_grib(path) as index:
        assert len(index.fields) == 2
    with path.open("rb") as file:
        handles = [eccodes.codes_grib_new_from_file(file) for _ in range(2)]
    eccodes.codes_release(handles[0])
    assert handles[1] is None


def test_a_bitmap_holds_for_later_fields_of_its_message(tmp_path: Path) -> None:
    values = np.arange(12.0)
    values[5] = 9999.0
    first, second = message("u", values, missing=9999.0), message("v", values + (values < 99) * 1.0, missing=9999.0)
    sections = _sections(second)
    sections[6] = (6).to_bytes(4) + b"\x06\xfe"  # bit map indicator 254: the one before
    body = first[16:-4] + b"".join(sections[n] for n in (4, 5, 6, 7))
    path = tmp_path / "wind.grib"
    path.write_bytes(first[:8] + (len(body) + 20).to_bytes(8) + body + b"7777")
    with open_grib(path) as index:
        u, v = (_whole(field2d)[::-1].ravel() for field2d in index.fields)
    assert np.isnan(u[5])
    assert np.isnan(v[5])
    np.testing.assert_allclose(np.delete(v - u, 5), 1.0, atol=ONE_CM_PER_SECOND)


def _sections(field: bytes) -> dict[int, bytes]:
    sections, position = {}, 16
    while position < len(field) - 4:
        length = int.from_bytes(field[position : position + 4])
        sections[field[position + 4]] = field[position : position + length]
        position += length
    return sections


def test_what_lies_between_messages_is_skipped(opened: Opened) -> None:
    noise = b"\x01\r\r\n123\r\r\nHTEC85 ECMF 011200 GRIB is not here \r\r\n" + bytes(10_000)
    index = opened(noise, message("u"), noise, message("v", edition=1), b"\r\r\n\x03")
    assert [field2d.quantity for field2d in index.fields] == ["u", "v"]
    np.testing.assert_allclose(_whole(index.fields[1]), 5.0)


def test_letters_grib_across_the_edge_of_a_chunk_are_found(opened: Opened) -> None:
    for gap in range(8185, 8200):
        assert len(opened(bytes(gap), message("u")).fields) == 1


def test_rows_and_columns_are_read_in_the_order_asked_for_and_as_a_copy(opened: Opened) -> None:
    field2d = _only(opened(message("u", stored(np.arange(12.0).reshape(3, 4), 0))))
    rows, columns = np.array([2, 0]), np.array([3, 1, 0])
    for _ in range(2):
        values = field2d.read(rows, columns)
        np.testing.assert_allclose(values, [[11, 9, 8], [3, 1, 0]], atol=ONE_CM_PER_SECOND)
        assert values.dtype == np.float64
        values[:] = 99.0


@pytest.fixture
def handles(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The handles that were made of messages; in the end all of them must have been released."""
    made: list[int] = []
    held: list[int] = []
    new, release = eccodes.codes_new_from_message, eccodes.codes_release

    def count(field: bytes) -> int:
        made.append(new(field))
        held.append(made[-1])
        return made[-1]

    def let_go(handle: int) -> None:
        if handle in held:
            held.remove(handle)
        release(handle)

    monkeypatch.setattr(eccodes, "codes_new_from_message", count)
    monkeypatch.setattr(eccodes, "codes_release", let_go)
    yield made
    assert not held


def test_eccodes_looks_once_at_fields_that_differ_only_in_time_and_member(opened: Opened, handles: list[int]) -> None:
    fields = [
        message("u", level=level, step=step, productDefinitionTemplateNumber=1, perturbationNumber=member)
        for level in (1000, 850)
        for step in range(4)
        for member in range(1, 5)
    ]
    index = opened(*fields)
    assert len({(s.level, s.time, s.member) for s in index.fields}) == 32
    assert len(handles) == 2


def test_gusts_up_to_several_times_are_of_one_kind(opened: Opened, handles: list[int]) -> None:
    gusts = [message("10fg", productDefinitionTemplateNumber=8, stepRange=f"{n}-{n + 3}") for n in (0, 3, 6)]
    handles.clear()
    times = [field2d.time for field2d in opened(*gusts).fields]
    assert times == [NOON + hours * 3600 for hours in (3, 6, 9)]
    assert len(handles) == 1


def test_the_last_few_fields_stay_decoded(opened: Opened, handles: list[int]) -> None:
    fields = opened(*(message("u", step=step) for step in range(6))).fields
    handles.clear()
    for number, decoded in ((0, 1), (0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (4, 5), (4, 5), (0, 6)):
        _whole(fields[number])
        assert len(handles) == decoded


def test_handles_are_released_when_something_goes_wrong(tmp_path: Path, handles: list[int]) -> None:
    path = tmp_path / "wind.grib"
    path.write_bytes(message("u", grid=box(95.0, 93.0)))
    assert "latitudes beyond the poles" in _say(path)
    assert len(handles) == 1


# ---------------------------------------------------------------------------------------------- errors


def test_a_missing_file_and_a_folder_are_named(tmp_path: Path) -> None:
    assert "no such file" in _say(tmp_path / "nowhere.grib")
    assert "no such file" in _say(tmp_path)


@pytest.mark.parametrize("content", [b"", b"GRI", b"CDF\x01" + bytes(100), b"no GRIB in these many letters " * 9])
def test_a_file_without_messages_is_no_grib(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "wind.grib"
    path.write_bytes(content)
    assert "it is no GRIB" in _say(path)


@pytest.mark.parametrize("magic", [b"BZh91AY", b"\x1f\x8b\x08", b"PK\x03\x04"])
def test_a_compressed_file_is_to_be_unpacked(tmp_path: Path, magic: bytes) -> None:
    path = tmp_path / "wind.grib2.bz2"
    path.write_bytes(magic + bytes(1000))
    assert "compressed: unpack it first" in _say(path)


@pytest.mark.parametrize("edition", [1, 2])
@pytest.mark.parametrize("cut", [1, 4, 50, -20, -9, -4])
def test_a_file_cut_short_is_an_error_that_counts_what_is_whole(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], edition: int, cut: int
) -> None:
    path, last = tmp_path / "wind.grib", message("v", edition=edition)
    path.write_bytes(message("u") * 3 + last[:-cut])
    said = _say(path)
    assert re.search(r"ends \d+ bytes before its last message does, after 3 whole ones: the download was cut", said)
    assert "fetch it again" in said
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("edition", [1, 2])
def test_a_message_that_does_not_end_where_it_says_is_an_error(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], edition: int
) -> None:
    path, first, second = tmp_path / "wind.grib", message("u", edition=edition), message("v")
    path.write_bytes(first[:60] + first[61:] + second)  # a byte was lost
    assert "its message at byte 0 does not end where it should" in _say(path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("edition", "at", "octet", "said"),
    [
        (2, 16 + 3, 255, "do not fit"),  # the length of section 1
        (2, 16 + 4, 9, "do not fit"),  # its number
        (1, 60, 200, "do not fit"),  # the length of section 2: eccodes crashes
        (2, 37 + 6, 200, "is damaged, or too large"),  # the number of nodes: eccodes asks for more memory than there is
    ],
)
def test_damage_is_an_error(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], edition: int, at: int, octet: int, said: str
) -> None:
    field = bytearray(message("u", edition=edition))
    field[at] = octet
    path = tmp_path / "wind.grib"
    path.write_bytes(field)
    assert said in _say(path)
    assert capfd.readouterr() == ("", "")


def test_more_values_than_nodes_are_an_error_before_there_is_room_made_for_them(tmp_path: Path) -> None:
    field = message("u", np.arange(12.0), missing=3.0)
    sections = _sections(field)
    sections[5] = sections[5][:5] + b"\x90" + sections[5][6:]
    path = tmp_path / "wind.grib"
    path.write_bytes(field[:16] + b"".join(sections[n] for n in sorted(sections)) + b"7777")
    with open_grib(path) as index, pytest.raises(WindError, match="not as many as its grid"):
        _whole(_only(index))


def test_values_that_cannot_be_decoded_are_an_error_when_they_are_read(tmp_path: Path) -> None:
    field = message("u", np.arange(12.0), packingType="grid_ccsds")
    sections = _sections(field)
    sections[7] = sections[7][:5] + bytes(len(sections[7]) - 5)
    sections[5] = sections[5][:9] + (4242).to_bytes(2) + sections[5][11:]  # a packing that nobody knows
    path = tmp_path / "wind.grib"
    path.write_bytes(message("v") + field[:16] + b"".join(sections[n] for n in sorted(sections)) + b"7777")
    with open_grib(path) as index:
        good, bad = index.fields
        _whole(good)
        with pytest.raises(
            WindError, match=r"its message at byte \d\d+ cannot be decoded .*download it again"
        ) as error:
            _whole(bad)
        assert str(error.value).startswith(f"{path}: ")


def test_a_sheet_read_after_its_file_was_closed_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "wind.grib"
    path.write_bytes(message("u"))
    with open_grib(path) as index:
        field2d = _only(index)
    with pytest.raises(WindError, match="is closed"):
        _whole(field2d)


def test_an_error_inside_of_the_context_is_left_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "wind.grib"
    path.write_bytes(message("u"))
    with pytest.raises(ValueError, match="mine"), open_grib(path):
        raise ValueError("mine")


def test_a_product_of_few_octets_does_not_matter(opened: Opened) -> None:
    """Template 4.254 ends where others tell their times."""
    assert len(opened(message("", productDefinitionTemplateNumber=254), message("u")).fields) == 1


def test_a_message_of_edition_1_beyond_16_megabytes_is_found(opened: Opened) -> None:
    """Its length does not fit into three octets."""
    grid = box(80.0, -80.0, 0.0, 224.0, 0.08)
    large = message("u", np.tile(np.arange(2801.0), 2001), 1, grid)
    assert len(large) > 1 << 24
    fields = opened(message("v"), large, message("v")).fields
    assert [field2d.quantity for field2d in fields] == ["v", "u", "v"]
    row = fields[1].read(np.array([5]), np.arange(2801))[0]
    np.testing.assert_allclose(row, np.arange(2801.0), atol=ONE_CM_PER_SECOND)


def test_a_path_with_letters_beyond_ascii(tmp_path: Path) -> None:
    path = tmp_path / "Höhenwind 日.grib"
    path.write_bytes(message("u"))
    with open_grib(path) as index:
        assert _whole(_only(index)).shape == (3, 4)


def test_eccodes_is_imported_only_by_those_who_read_grib() -> None:
    code = "import sys, gcs_windplan.wind.field_index; assert 'eccodes' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)

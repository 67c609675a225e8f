"""2D fields of real files and of files with traps: quantities, values, levels, members, reading."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import netCDF4
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import WindError
from gcs_windplan.units import KNOT
from gcs_windplan.wind.field_index import SURFACE, Field2D, Level, LevelKind
from gcs_windplan.wind.files.netcdf import open_netcdf
from tests.wind.netcdf_maker import AXES, HOURS, LAT, LON, MS, NOON, Content, everything, wind, write_netcdf

ONE_CM_PER_SECOND = 0.01
DATA = Path(__file__).resolve().parents[3].parent / "shared" / "data" / "wind"
TIMES: Content = ("time", [0.0, 3.0], {"units": HOURS})
HEIGHTS: Content = ("height", [10.0, 80.0], {"units": "m", "standard_name": "height"})
PRESSURES: Content = ("level", [1000, 850], {"units": "millibars"})
U, V = ({"standard_name": f"{way}ward_wind"} for way in ("east", "north"))


def _real(name: str) -> Path:
    if not (DATA / name).exists():
        pytest.skip(f"{name} is not on this machine: the shared test data are missing")
    return DATA / name


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "trap.nc"


def _only(path: Path, quantity: str) -> tuple[Field2D, Any]:
    found = [(field2d, values) for field2d, values in everything(path)[1] if field2d.quantity == quantity]
    assert len(found) == 1
    return found[0]


def _say(path: Path) -> str:
    with pytest.raises(WindError) as error:
        everything(path)
    assert str(error.value).startswith(f"{path}: ")
    return str(error.value)


@pytest.mark.parametrize(
    ("name", "quantity", "variable", "factor", "level_axis", "level_unit"),
    [
        ("bella_lui_weather_data_ERA5.nc", "u", "u", 1, "level", 100),
        ("bella_lui_weather_data_ERA5.nc", "height", "z", 1 / STANDARD_GRAVITY, "level", 100),
        ("ndrt_2020_weather_data_ERA5_new.nc", "v", "v", 1, "pressure_level", 100),
        (
            "gfs_height_above_ground_wrt.nc",
            "u",
            "u-component_of_wind_height_above_ground",
            1,
            "height_above_ground",
            1,
        ),
        (
            "gfs_height_above_ground_wrt.nc",
            "v",
            "v-component_of_wind_height_above_ground",
            1,
            "height_above_ground",
            1,
        ),
        ("ndfd_20170603T1800.nc", "speed", "Wind_speed_height_above_ground", 1, "height_above_ground1", 1),
        (
            "ndfd_20170603T1800.nc",
            "direction",
            "Wind_direction_from_which_blowing_height_above_ground",
            1,
            "height_above_ground1",
            1,
        ),
    ],
)
def test_at_ten_points_of_real_files_it_gives_what_netcdf4_reads(
    name: str, quantity: str, variable: str, factor: float, level_axis: str, level_unit: float
) -> None:
    path, random = _real(name), np.random.default_rng(11)
    with netCDF4.Dataset(path) as file, open_netcdf(path) as index:
        clock = file["valid_time" if "valid_time" in file.variables else "time"]
        dates: Any = netCDF4.num2date(clock[:], clock.units, "proleptic_gregorian")
        fields = {(s.time, s.level): s for s in index.fields if s.quantity == quantity}
        assert len(fields) == len(clock) * len(file[level_axis])
        for _ in range(10):
            pick = tuple(int(random.integers(size)) for size in file[variable].shape)
            moment = (dates[pick[0]] - type(dates[0])(1970, 1, 1)).total_seconds()
            kind: LevelKind = "pressure" if level_unit == 100 else "height"
            field2d = fields[moment, Level(kind, float(file[level_axis][pick[1]]) * level_unit)]
            read = field2d.read(np.array([pick[2]]), np.array([pick[3]]))
            np.testing.assert_allclose(read, file[variable][pick] * factor, atol=ONE_CM_PER_SECOND)


def test_the_real_ndfd_file_tells_its_run_and_that_its_speeds_need_no_turning() -> None:
    with open_netcdf(_real("ndfd_20170603T1800.nc")) as index:
        assert {field2d.quantity for field2d in index.fields} == {"speed", "direction"}
        assert {(field2d.run, field2d.along_grid) for field2d in index.fields} == {(1496232000.0, False)}
        assert len({id(field2d.grid) for field2d in index.fields}) == 1


def test_the_scalar_number_of_the_new_era5_file_is_no_ensemble() -> None:
    with open_netcdf(_real("ndrt_2020_weather_data_ERA5_new.nc")) as index:
        assert {field2d.member for field2d in index.fields} == {None}
        assert {field2d.quantity for field2d in index.fields} == {"u", "v", "height"}  # no temperature on pressures


def test_the_title_and_the_units_are_told(path: Path) -> None:
    index, fields = everything(write_netcdf(path, {**AXES, "u": wind("lat lon", 3, 4, **U)}, title="a test"))
    assert (index.source, index.title, fields[0][0].units) == ("trap.nc", "a test", "m s-1")


@pytest.mark.parametrize(
    ("units", "value"), [("m s**-1", 10), ("knots", 10 * KNOT), ("mph", 4.4704), ("km h-1", 10 / 3.6), ("m s⁻¹", 10)]
)
def test_speeds_are_converted(path: Path, units: str, value: float) -> None:
    write_netcdf(path, {**AXES, "u": wind("lat lon", 3, 4, **U, units=units)})
    np.testing.assert_allclose(_only(path, "u")[1], value)


def test_every_quantity_is_found_with_its_level(path: Path) -> None:
    grid = "lat lon"
    lev: Content = ("lev", [1, 2], {"standard_name": "hybrid_sigma_pressure", "units": "level"})
    on_levels = {
        "t": ("lev lat lon", np.full((2, 3, 4), -10.0), {"standard_name": "air_temperature", "units": "degC"}),
        "q": ("lev lat lon", np.full((2, 3, 4), 3.0), {"standard_name": "specific_humidity", "units": "g kg-1"}),
    }
    surface = {
        "10u": wind(grid, 3, 4),
        "10v": wind(grid, 3, 4),
        "si100": wind(grid, 3, 4),
        "wdir100": wind(grid, 3, 4, value=270, units="degrees"),
        "i10fg": wind(grid, 3, 4),
        "z": wind(grid, 3, 4, value=980.665, units="m**2 s**-2", standard_name="geopotential"),
        "fsr": wind(grid, 3, 4, value=0.03, units="m"),
        "lnsp": wind(grid, 3, 4, value=math.log(1e5), units="~"),
        "t2m": wind(grid, 3, 4, value=280, units="K", long_name="2 metre temperature"),
    }
    _, fields = everything(write_netcdf(path, {**AXES, "lev": lev, **on_levels, **surface}))
    found = {(s.quantity, s.level): float(values[0, 0]) for s, values in fields}
    ten, hundred = Level("height", 10.0), Level("height", 100.0)
    assert found == pytest.approx(
        {
            **{(name, Level("model", float(k))): value for k in (1, 2) for name, value in
               (("temperature", 263.15), ("humidity", 0.003))},
            ("u", ten): 10, ("v", ten): 10, ("speed", hundred): 10, ("direction", hundred): 270, ("gust", ten): 10,
            ("terrain", SURFACE): 100, ("roughness", SURFACE): 0.03, ("pressure", SURFACE): 1e5,
        }
    )  # fmt: skip


def test_a_direction_that_the_wind_goes_to_is_turned(path: Path) -> None:
    said = {"standard_name": "wind_to_direction", "units": "degree"}
    write_netcdf(path, {**AXES, "dir": ("lat lon", np.full((3, 4), 270.0), said)})
    np.testing.assert_allclose(_only(path, "direction")[1], 90.0)


def test_members_are_told_by_their_numbers_or_their_places(path: Path) -> None:
    number: Content = ("number", [0, 7], {"standard_name": "realization", "units": "1"})
    named: Content = ("ens", ["control", "first"], {})
    write_netcdf(
        path,
        {
            **AXES,
            "number": number,
            "ens": named,
            "u10": wind("number lat lon", 2, 3, 4),
            "u100": wind("ens lat lon", 2, 3, 4),
            "v10": wind("member lat lon", 2, 3, 4),
            "v100": wind("member1 lat lon", 1, 3, 4),
        },
    )
    found = [(field2d.name, field2d.member) for field2d, _ in everything(path)[1]]
    assert found == [("u10", 0), ("u10", 7), ("u100", 0), ("u100", 1), ("v10", 0), ("v10", 1), ("v100", None)]


def test_of_era5s_two_versions_the_one_that_has_values_is_taken(path: Path) -> None:
    values = np.full((2, 2, 3, 4), np.nan)
    values[0, 0], values[1, 1] = 5.0, 7.0
    expver: Content = ("expver", [1, 5], {})
    write_netcdf(path, {**AXES, "time": TIMES, "expver": expver, "u10": ("time expver lat lon", values, MS)})
    assert [float(values.mean()) for _, values in everything(path)[1]] == [5.0, 7.0]


def test_percent_spread_errors_extremes_and_currents_are_no_wind(path: Path) -> None:
    odd = {
        "wind_speed_sd": wind("lat lon", 3, 4),
        "u10_spread": wind("lat lon", 3, 4, **U),
        "Wind_speed_height_above_ground_error": wind("lat lon", 3, 4),
        "wind_speed": wind("lat lon", 3, 4, units="%"),
        "u_error": wind("lat lon", 3, 4, standard_name="eastward_wind standard_error"),
        "v10": wind("lat lon", 3, 4, cell_methods="time: standard_deviation"),
        "ws10": wind("lat lon", 3, 4, cell_methods="time: maximum"),
        "UGRD_tropopause": wind("lat lon", 3, 4),
        "u": wind("depth lat lon", 2, 3, 4),
        "v": wind("lat lon", 3, 4, standard_name="northward_sea_water_velocity"),
        "u10n": wind("lat lon", 3, 4, long_name="10 metre u-component of neutral wind"),
    }
    depth: Content = ("depth", [1.0, 2.0], {"units": "m", "positive": "down"})
    index, fields = everything(write_netcdf(path, {**AXES, "depth": depth, **odd}))
    assert not fields
    assert len(index.unused) == 1
    assert "wind_speed_sd, u10_spread, " in index.unused[0]
    assert "a statistic of it" in index.unused[0]


def test_a_file_of_one_place_is_a_grid_of_one_node(path: Path) -> None:
    place = {"lat": ("", 50.5, LAT[2]), "lon": ("", 7.25, LON[2])}
    write_netcdf(path, {**place, "time": TIMES, "u10": ("time", [1.0, 2.0], {**MS, "coordinates": "lat lon"})})
    _, fields = everything(path)
    assert [(s.grid.shape, s.time) for s, _ in fields] == [((1, 1), NOON), ((1, 1), NOON + 3 * 3600)]
    assert [values.tolist() for _, values in fields] == [[[1.0]], [[2.0]]]
    assert fields[0][0].grid.latitudes.tolist() == [50.5]


def test_missing_or_strange_units_are_told_when_the_sheet_is_read(path: Path) -> None:
    write_netcdf(path, {**AXES, "u": ("lat lon", np.zeros((3, 4)), U)})
    assert "u has no units; set its attribute `units` to a speed" in _say(path)
    write_netcdf(path, {**AXES, "u": wind("lat lon", 3, 4, **U, units="furlongs per fortnight")})
    assert "u is in 'furlongs per fortnight'" in _say(path)


def test_what_can_be_done_without_is_passed_over_if_its_units_are_unknown(path: Path) -> None:
    content = {
        **AXES,
        "u10": wind("lat lon", 3, 4),
        "sr": wind("lat lon", 3, 4, units="W m-2"),
        "gust": ("lat lon", np.zeros((3, 4)), {}),
    }
    index, fields = everything(write_netcdf(path, content))
    assert [field2d.name for field2d, _ in fields] == ["u10"]
    assert "sr is in 'W m-2', which is not a height" in index.unused[0]
    assert index.unused[1].startswith("gust has no units")


def test_a_level_axis_without_units_is_an_error_unless_there_is_other_wind(path: Path) -> None:
    bare: Content = ("h", [10.0, 20.0], {"standard_name": "height"})
    content = {**AXES, "h": bare, "u": wind("h lat lon", 2, 3, 4, **U)}
    assert "u: h has no units; set its attribute `units` to a height" in _say(write_netcdf(path, content))
    index, fields = everything(write_netcdf(path, {**content, "u10": wind("lat lon", 3, 4)}))
    assert [field2d.name for field2d, _ in fields] == ["u10"]
    assert index.unused[0].startswith("u: h has no units")


def test_an_axis_that_counts_nothing_known_is_explained(path: Path) -> None:
    content = {**AXES, "level": ("level", [1000.0, 850.0], {}), "u": wind("level lat lon", 2, 3, 4, **U)}
    index, fields = everything(write_netcdf(path, content))
    assert not fields
    assert "u: an axis level of 2 values counts nothing that is known: set the `units`" in index.unused[0]


def test_attributes_of_odd_types_do_no_harm(path: Path) -> None:
    odd = {
        "standard_name": np.arange(3),
        "long_name": ["10 metre", "wind"],
        "coordinates": 3.5,
        "grid_mapping": np.array([1.0]),
        "formula_terms": b"a: b",
        "missing_value": 3.0,
    }
    write_netcdf(path, {**AXES, "u10": wind("lat lon", 3, 4, **odd)}, title=np.arange(2))
    index, fields = everything(path)
    assert (index.title, fields[0][0].quantity) == ("", "u")


_ATTRIBUTES = (
    "standard_name", "long_name", "units", "coordinates", "bounds", "formula_terms", "positive", "calendar", "axis",
    "grid_mapping", "grid_mapping_name", "standard_parallel", "cell_methods", "missing_value", "valid_range", "level",
)  # fmt: skip
_TEXTS = (
    "", "x", "lat lon", "time", "u crs: lev", "ap: lev b: ap", "%", "K", "days since 0-0-0", "noleap", "up", "height",
    "realization", "latitude", "depth", "projection_x_coordinate", "mercator", "eastward_wind",
)  # fmt: skip
_ARRAYS = st.lists(st.floats(allow_nan=True), min_size=1, max_size=3).map(np.array)
_ODD: st.SearchStrategy[Any] = st.sampled_from([3, -1.5, *_TEXTS]) | _ARRAYS


@settings(max_examples=60)
@given(
    changes=st.dictionaries(st.tuples(st.integers(0, 9), st.sampled_from(_ATTRIBUTES)), _ODD, min_size=1, max_size=6)
)
def test_whatever_stands_in_attributes_there_are_sheets_or_an_error_in_words(
    changes: dict[tuple[int, str], Any],
) -> None:
    content = {
        **AXES,
        "time": TIMES,
        "lev": ("lev", [1.0, 2.0], {"standard_name": "atmosphere_hybrid_sigma_pressure_coordinate"}),
        "ap": ("lev", [5.0, 0.0], {"units": "Pa"}),
        "crs": ("", 0, {"grid_mapping_name": "mercator"}),
        "u": wind("time lev lat lon", 2, 2, 3, 4, grid_mapping="crs"),
        "v10": wind("time lat lon", 2, 3, 4),
        "lnsp": wind("time lat lon", 2, 3, 4, units="1"),
        "z": wind("lat lon", 3, 4, units="m"),
    }
    for (number, attribute), value in changes.items():
        name = list(content)[number]
        dimensions, values, said = content[name]
        content[name] = (dimensions, values, {**said, attribute: value})
    with TemporaryDirectory() as folder:
        path = write_netcdf(Path(folder) / "odd.nc", content)
        try:
            everything(path)
        except WindError as error:
            assert str(error).startswith(f"{path}: ")  # noqa: PT017 - most files are read without one


def test_a_variable_without_values_is_explained(path: Path) -> None:
    empty: Content = ("time", np.zeros(0), {"units": HOURS})
    index, fields = everything(write_netcdf(path, {**AXES, "time": empty, "u10": wind("time lat lon", 0, 3, 4)}))
    assert not fields
    assert index.unused == ("u10: it is empty: nothing was written into it",)


def test_groups_are_pointed_out(path: Path) -> None:
    write_netcdf(path, {**AXES, "u10": wind("lat lon", 3, 4)})
    with netCDF4.Dataset(path, "a") as file:
        file.createGroup("forecast")
    assert "forecast: groups are not read" in everything(path)[0].unused[0]


def test_a_later_error_of_the_user_is_none_of_the_files(path: Path) -> None:
    write_netcdf(path, {**AXES, "u10": wind("lat lon", 3, 4)})
    with pytest.raises(WindError, match=r"^something else$"), open_netcdf(path):
        raise WindError("something else")

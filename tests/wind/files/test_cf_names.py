"""What variables are taken for by their names and attributes."""

from __future__ import annotations

from typing import Any

import pytest

from gcs_windplan.wind.field_index import SURFACE, Level
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.cf_names import looks_like_wind, meaning


def _variable(name: str, **attributes: Any) -> Variable:
    return Variable(name, ("lat", "lon"), (3, 3), attributes)


@pytest.mark.parametrize(
    ("quantity", "names"),
    [
        ("u", "u U ua uas u10 U10 u_10m 10u u10m 10m_u_component_of_wind UGRD_10maboveground ugrdprs ugrd10m uwnd"
         " u_wind u-component_of_wind_isobaric u-component_of_wind_height_above_ground wind_u_component_100m U_10M"
         " u850 eastward_wind"),
        ("v", "v V va vas v10 V10 v_10m 10v 100v v100 VGRD_850mb vgrdprs vwnd v-component_of_wind_hybrid V_10M"),
        ("speed", "ws wspd ws10 si10 10si wind_speed windspeed wind_speed_10m Wind_speed_height_above_ground sfcWind"
         " WIND_10maboveground wspd_80m"),
        ("direction", "wd wdir wdir10 wind_dir wind_direction wind_direction_10m WDIR_10maboveground 10wdir"
         " Wind_direction_from_which_blowing_height_above_ground wind_from_direction"),
        ("gust", "gust GUST_surface gustsfc i10fg fg10 10fg fg310 10fg3 Wind_speed_gust_surface wind_speed_of_gust"
         " VMAX_10M wind_gust wind_gusts_10m"),
        ("height", "z gh zg zg500 z500 HGT_850mb hgtprs geopotential Geopotential_height_isobaric geopotential_height"),
        ("terrain", "orog HSURF topography_c HGT_surface hgtsfc Geopotential_height_surface surface_altitude PHIS"),
        ("roughness", "fsr sr z0 Z0 z0m ZNT SFCR_surface surface_roughness_length Surface_roughness_surface"),
        ("temperature", "t T ta temp Temperature_hybrid tmpprs"),
        ("humidity", "q hus QV Specific_humidity_hybrid"),
        ("pressure", "sp ps PSFC lnsp PRES_surface pressfc Pressure_surface surface_pressure"),
    ],
)  # fmt: skip
def test_names_in_common_use(quantity: str, names: str) -> None:
    found = {name: meaning(_variable(name)) for name in names.split()}
    assert {name: None if one is None else one.quantity for name, one in found.items()} == dict.fromkeys(
        found, quantity
    )


@pytest.mark.parametrize(
    ("standard_name", "quantity"),
    [
        ("eastward_wind", "u"), ("y_wind", "v"), ("grid_northward_wind", "v"), ("wind_speed", "speed"),
        ("wind_to_direction", "direction"), ("wind_speed_of_gust", "gust"), ("geopotential", "height"),
        ("surface_altitude", "terrain"), ("surface_roughness_length", "roughness"), ("air_temperature", "temperature"),
        ("specific_humidity", "humidity"), ("surface_air_pressure", "pressure"),
        ("eastward_sea_water_velocity", None), ("air_pressure", None), ("upward_air_velocity", None),
        ("10-meter_eastward_wind", "u"), ("u_wind_at_10m", "u"), ("eastward_wind_shear", None), ("wind_stress", None),
        ("eastward_wind standard_error", None), ("wind_speed status_flag", None),
    ],
)  # fmt: skip
def test_standard_names_go_first(standard_name: str, quantity: str | None) -> None:
    found = meaning(_variable("u", standard_name=standard_name))
    assert (None if found is None else found.quantity) == quantity


@pytest.mark.parametrize(
    ("name", "said", "level", "guess"),
    [
        ("UGRD_80maboveground", {}, Level("height", 80), None),
        ("TMP_1D5maboveground", {}, Level("height", 1.5), None),
        ("VGRD_850mb", {}, Level("pressure", 85000), None),
        ("UGRD_1829mabovemeansealevel", {}, Level("altitude", 1829), None),
        ("HGT_surface", {}, SURFACE, None),
        ("wind_speed_10m", {}, Level("height", 10), None),
        ("100m_v_component_of_wind", {}, Level("height", 100), None),
        ("u_850hPa", {}, Level("pressure", 85000), None),
        ("u", {"level": "10 m above ground"}, Level("height", 10), None),
        ("u", {"level": "925 mb"}, Level("pressure", 92500), None),
        ("u", {"level": "1.2.3 mb"}, None, None),
        ("gust", {"level": "surface"}, SURFACE, None),
        ("u100", {}, None, Level("height", 100)),
        ("100u", {}, None, Level("height", 100)),
        ("u850", {}, None, Level("pressure", 85000)),
        ("U200", {"long_name": "Zonal wind at 200 mbar pressure surface"}, None, Level("pressure", 20000)),
        ("z100", {}, None, Level("pressure", 10000)),
        ("i10fg", {}, None, Level("height", 10)),
        ("fg310", {}, None, Level("height", 10)),
        ("u", {"long_name": "10 metre U wind component"}, None, Level("height", 10)),
        ("U", {"description": "U at 10 M"}, None, Level("height", 10)),
        ("u", {"long_name": "U at 850 mb"}, None, Level("pressure", 85000)),
        ("uas", {}, None, Level("height", 10)),
        ("U50M", {"standard_name": "50-meter_eastward_wind"}, Level("height", 50), None),
        ("x_wind_0", {"standard_name": "x_wind"}, None, None),
        ("u", {"long_name": "wind in 1 m s-1"}, None, None),
        ("u-component_of_wind_isobaric", {}, None, None),
    ],
)
def test_levels_that_names_tell(name: str, said: dict[str, str], level: Level | None, guess: Level | None) -> None:
    found = meaning(_variable(name, **said))
    assert found is not None
    assert (found.level, found.guess) == (level, guess)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("wind_speed_sd", {}),
        ("u_spread", {"standard_name": "eastward_wind"}),
        ("wind_speed_percentile_90", {"standard_name": "wind_speed"}),
        ("u", {"units": "%"}),
        ("u", {"long_name": "Standard deviation of the U component"}),
        ("u", {"long_name": "Eastward sea water velocity"}),
        ("u", {"long_name": "surface current, east"}),
        ("u10n", {}),
        ("ws10", {"long_name": "neutral wind speed"}),
        ("wind_speed", {"cell_methods": "time: maximum"}),
        ("u", {"GRIB_stepType": "max"}),
        ("u", {"cell_methods": "realization: standard_deviation"}),
        ("Wind_speed_height_above_ground", {"Grib_Statistical_Interval_Type": "Maximum"}),
        ("Wind_speed_height_above_ground_probability_above_17p491", {}),
        ("UGRD_maxwind", {}),
        ("UGRD_30M0mbaboveground", {}),
        ("ucurr", {}),
        ("wind_stress_u", {}),
        ("sr", {"units": "%"}),
        ("T", {"units": "m s-1"}),
        ("uo", {}),
        ("udvdx", {}),
    ],
)
def test_what_is_no_wind(name: str, said: dict[str, str]) -> None:
    assert meaning(_variable(name, **said)) is None


def test_a_gust_may_be_a_maximum() -> None:
    found = meaning(_variable("gust", cell_methods="time: maximum", long_name="maximum 10 metre wind gust"))
    assert found is not None
    assert found.quantity == "gust"


@pytest.mark.parametrize(
    ("name", "said", "towards"),
    [
        ("wind_direction", {}, False),
        ("wdir", {"long_name": "wind direction (from which blowing)"}, False),
        ("d", {"standard_name": "wind_to_direction"}, True),
        ("wind_to_direction", {}, True),
        ("wdir", {"long_name": "direction towards which the wind blows"}, True),
    ],
)
def test_directions_that_the_wind_goes_to(name: str, said: dict[str, str], towards: bool) -> None:
    found = meaning(_variable(name, **said))
    assert found is not None
    assert found.towards is towards


@pytest.mark.parametrize("name", ["wind_speed_sd", "UGRD_tropopause", "u_spread", "wdir_qc"])
def test_what_looks_like_wind_is_missed(name: str) -> None:
    assert looks_like_wind(_variable(name))
    assert not looks_like_wind(_variable("visibility"))
    assert not looks_like_wind(_variable("u", standard_name="eastward_sea_water_velocity"))

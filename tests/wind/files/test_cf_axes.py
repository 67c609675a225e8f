"""What coordinates are taken for."""

from __future__ import annotations

import pytest

from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.cf_axes import role


@pytest.mark.parametrize(
    ("name", "attributes", "expected"),
    [
        ("lat", {}, "latitude"),
        ("XLAT", {"units": "degree_north"}, "latitude"),
        ("y", {"units": "degrees_north"}, "latitude"),
        ("x", {"units": "degree_east"}, "longitude"),
        ("nav_lon", {}, "longitude"),
        ("rlat", {"standard_name": "grid_latitude", "units": "degrees"}, "y"),
        ("rlon", {}, "x"),
        ("x", {"units": "km", "_CoordinateAxisType": "GeoX"}, "x"),
        ("a", {"_CoordinateAxisType": "GeoY"}, "y"),
        ("y", {"standard_name": "projection_y_coordinate"}, "y"),
        ("easting", {"units": "m", "axis": "X"}, "x"),
        ("t", {"units": "hours since 1900-01-01"}, "time"),
        ("base", {"standard_name": "forecast_reference_time", "units": "hours since 1900-01-01"}, "run"),
        ("reftime3", {"units": "Hour since 2017-05-21"}, "run"),
        ("r", {"units": "hours since 2017-05-21", "_CoordinateAxisType": "RunTime"}, "run"),
        ("time", {"units": "hours since 2017-05-21", "long_name": "initial reference time"}, "run"),
        ("step", {"units": "hours"}, "period"),
        ("f", {"standard_name": "forecast_period"}, "period"),
        ("level", {"units": "millibars"}, "pressure"),
        ("lev", {"units": "millibar", "long_name": "altitude"}, "pressure"),
        ("isobaricInhPa", {"units": "hPa"}, "pressure"),
        ("plev", {}, "pressure"),
        ("height_above_ground2", {"units": "m"}, "height"),
        ("heightAboveGround", {"units": "m", "long_name": "height above the surface"}, "height"),
        ("h", {"standard_name": "altitude", "units": "m"}, "altitude"),
        ("h", {"long_name": "Height above mean sea level", "units": "m"}, "altitude"),
        ("height", {"long_name": "Height above mean sea level", "units": "m"}, "altitude"),
        ("altitude_above_msl", {"units": "m"}, "altitude"),
        ("height", {"standard_name": "height_above_reference_ellipsoid", "units": "m"}, None),
        ("height_above_reference_ellipsoid", {"units": "m"}, None),
        ("height", {"standard_name": "height", "long_name": "generalized_height"}, "model"),
        ("hybrid", {"units": "1"}, "model"),
        ("lev", {"units": "hPa", "standard_name": "atmosphere_hybrid_sigma_pressure_coordinate"}, "model"),
        ("lev", {"units": "level", "long_name": "hybrid level at midpoints (1000*(A+B))"}, "model"),
        ("level", {"long_name": "model_level_number"}, "model"),
        ("number", {"standard_name": "realization"}, "member"),
        ("ensemble_member", {}, "member"),
        ("expver", {}, "version"),
        ("depth", {"standard_name": "depth", "units": "m"}, "depth"),
        ("level", {}, None),
        ("sigma", {"units": "1"}, None),
        ("percentile", {"units": "1"}, None),
    ],
)
def test_axes_are_known_by_standard_name_then_units_then_name(
    name: str, attributes: dict[str, str], expected: str | None
) -> None:
    assert role(Variable(name, (name,), (3,), attributes)) == expected

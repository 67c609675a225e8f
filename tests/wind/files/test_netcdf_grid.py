"""Where values stand: latitudes and longitudes of all sorts, projected grids, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gcs_windplan.wind.field_index import Field2D, Grid
from tests.wind.netcdf_maker import AXES, LAT, LON, MS, Content, everything, wind, write_netcdf

ONE_METRE = 1e-5  # [deg]
Y: Content = ("y", [0.0, 1.0, 2.0], {"standard_name": "projection_y_coordinate", "units": "km"})
X: Content = ("x", [0.0, 1.0, 2.0, 3.0], {"standard_name": "projection_x_coordinate", "units": "km"})
BENT = np.array([[50.0, 50.1, 50.2, 50.3], [51.0, 51.1, 51.2, 51.3], [52.0, 52.1, 52.2, 52.3]])
LAT2, LON2 = ({"units": f"degrees_{way}"} for way in ("north", "east"))
LAMBERT: Content = (
    "",
    0,
    {
        "grid_mapping_name": "lambert_conformal_conic",
        "standard_parallel": [25.0, 25.0],
        "latitude_of_projection_origin": 25.0,
        "longitude_of_central_meridian": 265.0,
        "earth_radius": 6371229.0,
    },
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "trap.nc"


def _fields(path: Path, content: dict[str, Content]) -> list[Field2D]:
    return [field2d for field2d, _ in everything(write_netcdf(path, content))[1]]


def _grid(path: Path, content: dict[str, Content]) -> Grid:
    fields = _fields(path, content)
    assert len({id(field2d.grid) for field2d in fields}) == 1
    return fields[0].grid


def _unused(path: Path, content: dict[str, Content]) -> str:
    index, fields = everything(write_netcdf(path, content))
    assert not [field2d for field2d, _ in fields if field2d.quantity in ("u", "v")]
    assert len(index.unused) == 1
    return index.unused[0]


@pytest.mark.parametrize("latitudes", [[52.0, 51.0, 50.0], [50.0, 51.0, 52.0]])
def test_parallels_and_meridians_are_taken_as_they_stand(path: Path, latitudes: list[float]) -> None:
    lon: Content = ("longitude", [358.0, 359.0, 0.0, 1.0], {})
    content = {"latitude": ("latitude", latitudes, {}), "longitude": lon, "u10": wind("latitude longitude", 3, 4)}
    grid = _grid(path, content)
    assert grid.regular
    assert grid.latitudes.tolist() == latitudes
    assert grid.longitudes.tolist() == lon[1]


def test_one_dimensional_coordinates_may_have_other_names_than_their_dimensions(path: Path) -> None:
    content = {"a": ("y", LAT[1], LAT2), "b": ("x", LON[1], LON2), "u10": wind("x y", 4, 3)}
    assert _grid(path, content).shape == (3, 4)


def test_a_slice_along_one_meridian_is_a_grid_of_one_column(path: Path) -> None:
    grid = _grid(path, {"lat": LAT, "lon": ("", 7.0, LON[2]), "u10": wind("lat", 3)})
    assert (grid.shape, grid.longitudes.tolist()) == ((3, 1), [7.0])


def test_variables_with_and_without_dimensions_of_one_share_a_grid(path: Path) -> None:
    content = {
        "lat": ("lat", [50.0], LAT[2]), "lon": ("lon", [7.0], LON[2]),
        "u10": wind("lat lon", 1, 1), "v10": wind("lon", 1, value=3.0), "z": ("", 5.0, {"units": "m"}),
    }  # fmt: skip
    _, fields = everything(write_netcdf(path, content))
    assert len({id(field2d.grid) for field2d, _ in fields}) == 1
    assert [values.tolist() for _, values in fields] == [[[10.0]], [[3.0]], [[5.0]]]


@pytest.mark.parametrize("said", [{"coordinates": "nav_lon nav_lat"}, {}])
def test_nodes_with_their_own_latitudes_and_longitudes(path: Path, said: dict[str, str]) -> None:
    content = {
        "y": Y,
        "x": X,
        "nav_lat": ("y x", BENT, LAT2),
        "nav_lon": ("y x", BENT.T.reshape(3, 4), LON2),
        "u10": wind("y x", 3, 4, **said),
        "v10": wind("y x", 3, 4, **said),
    }
    grid = _grid(path, content)
    np.testing.assert_array_equal(grid.latitudes, BENT)


def test_rows_are_the_dimension_that_is_not_x(path: Path) -> None:
    content = {
        "y": Y,
        "x": X,
        "lat": ("x y", BENT.T, LAT2),
        "lon": ("x y", BENT.T + 1, LON2),
        "u10": ("x y", BENT.T, MS),
    }
    _, fields = everything(write_netcdf(path, content))
    np.testing.assert_array_equal(fields[0][0].grid.latitudes, BENT)
    np.testing.assert_array_equal(fields[0][1], BENT)


def test_a_table_of_parallels_and_meridians_is_known_as_such(path: Path) -> None:
    lat, lon = np.meshgrid(LAT[1], LON[1], indexing="ij")
    content = {"lat": ("y x", lat, LAT2), "lon": ("y x", lon, LON2), "u10": wind("y x", 3, 4)}
    grid = _grid(path, content)
    assert grid.regular
    assert (grid.latitudes.tolist(), grid.longitudes.tolist()) == (LAT[1], LON[1])


def test_wrfs_winds_on_the_nodes_are_used_and_those_between_them_explained(path: Path) -> None:
    mesh = "Time south_north west_east"
    content = {
        "XLAT": (mesh, np.stack([BENT, BENT]), {"units": "degree_north"}),
        "XLONG": (mesh, np.stack([BENT, BENT]), {"units": "degree_east"}),
        "XTIME": ("Time", [0.0, 60.0], {"units": "minutes since 2026-05-01 12:00:00"}),
        "U10": wind(mesh, 2, 3, 4, coordinates="XLONG XLAT XTIME"),
        "V10": wind(mesh, 2, 3, 4, coordinates="XLONG XLAT XTIME"),
        "HGT": ("south_north west_east", BENT, {"units": "m"}),
        "U": wind("Time bottom_top south_north west_east_stag", 2, 6, 3, 5),
        "T": wind("Time bottom_top south_north west_east", 2, 6, 3, 4, units="K"),
    }
    index, fields = everything(write_netcdf(path, content))
    assert [(s.quantity, s.along_grid) for s, _ in fields] == [("u", True)] * 2 + [("v", True)] * 2 + [
        ("terrain", False)
    ]
    assert index.unused[0].startswith("U: they stand between the nodes, on a staggered grid (west_east_stag): bring")


def test_a_moving_nest_is_refused(path: Path) -> None:
    mesh = "Time south_north west_east"
    content = {
        "XLAT": (mesh, np.stack([BENT, BENT + 1]), {"units": "degree_north"}),
        "XLONG": (mesh, np.stack([BENT, BENT]), {"units": "degree_east"}),
        "U10": wind(mesh, 2, 3, 4),
    }
    assert "U10: its nodes (XLAT, XLONG) move with time" in _unused(path, content)


def test_u_and_v_at_the_sides_of_cells_are_explained(path: Path) -> None:
    """COSMO's U stands on slonu, slatu, its V on slonv, slatv; its winds at 10 m stand on the nodes."""
    content = {
        "lat": ("rlat rlon", BENT, LAT2),
        "lon": ("rlat rlon", BENT, LON2),
        "slatu": ("rlat srlon", BENT, LAT2),
        "slonu": ("rlat srlon", BENT + 0.05, LON2),
        "slatv": ("srlat rlon", BENT + 0.05, LAT2),
        "slonv": ("srlat rlon", BENT, LON2),
        "U": wind("rlat srlon", 3, 4, standard_name="grid_eastward_wind", coordinates="slonu slatu"),
        "V": wind("srlat rlon", 3, 4, standard_name="grid_northward_wind", coordinates="slonv slatv"),
        "U_10M": wind("rlat rlon", 3, 4, standard_name="grid_eastward_wind", coordinates="lon lat"),
        "V_10M": wind("rlat rlon", 3, 4, standard_name="grid_northward_wind", coordinates="lon lat"),
    }
    index, fields = everything(write_netcdf(path, content))
    assert [(field2d.name, field2d.along_grid) for field2d, _ in fields] == [("U_10M", True), ("V_10M", True)]
    assert index.unused == ("U, V: u and v stand at different places, on a staggered grid: bring them to one first",)


@pytest.mark.parametrize("said", [{"grid_mapping": "crs"}, {"grid_mapping": "crs: x y"}, {"grid_mapping": "gone"}, {}])
def test_a_projection_places_the_nodes(path: Path, said: dict[str, str]) -> None:
    """25 degrees north, 95 degrees west is where both axes are 0."""
    content = {"y": Y, "x": X, "crs": LAMBERT, "u10": wind("y x", 3, 4, **said), "v10": wind("y x", 3, 4, **said)}
    grid = _grid(path, content)
    assert (grid.shape, grid.regular, grid.name) == ((3, 4), False, "lambert_conformal_conic")
    assert abs(grid.latitudes[0, 0] - 25.0) < ONE_METRE
    assert abs(grid.longitudes[0, 0] % 360 - 265.0) < ONE_METRE
    assert (np.diff(grid.latitudes, axis=0) > 0).all()
    assert (np.diff(grid.longitudes, axis=1) > 0).all()


def test_a_projection_helps_out_where_nodes_are_missing(path: Path) -> None:
    gaps = np.where(BENT > 52.2, np.nan, BENT)
    content = {
        "y": Y, "x": X, "crs": LAMBERT, "lat": ("y x", gaps, LAT2), "lon": ("y x", BENT, LON2),
        "u10": wind("y x", 3, 4, grid_mapping="crs", coordinates="lon lat"),
    }  # fmt: skip
    assert np.isfinite(_grid(path, content).latitudes).all()
    del content["crs"], content["x"]
    assert "u10: its latitudes and longitudes have missing values" in _unused(path, content)


def test_a_rotated_grid_has_latitudes_and_longitudes_of_its_own(path: Path) -> None:
    pole: dict[str, Any] = {"grid_north_pole_latitude": 40.0, "grid_north_pole_longitude": -170.0}
    content = {
        "rlat": ("rlat", [-1.0, 0.0, 1.0], {"standard_name": "grid_latitude", "units": "degrees"}),
        "rlon": ("rlon", [-1.0, 0.0, 1.0, 2.0], {"standard_name": "grid_longitude", "units": "degrees"}),
        "pole": ("", 0, {"grid_mapping_name": "rotated_latitude_longitude", **pole}),
        "u": wind("rlat rlon", 3, 4, grid_mapping="pole", standard_name="grid_eastward_wind"),
    }
    grid = _grid(path, content)
    assert abs(grid.latitudes[1, 1] - 50.0) < ONE_METRE
    assert abs(grid.longitudes[1, 1] - 10.0) < ONE_METRE


@pytest.mark.parametrize(
    ("name", "said", "along_grid", "assumed"),
    [
        ("u", {"standard_name": "eastward_wind"}, False, False),
        ("u", {"standard_name": "x_wind"}, True, False),
        ("u", {"standard_name": "grid_eastward_wind"}, True, False),
        ("u", {"standard_name": "eastward_wind", "GRIB_uvRelativeToGrid": np.int64(1)}, True, False),
        ("u", {"GRIB_uvRelativeToGrid": np.int64(0)}, False, False),
        ("u", {"long_name": "Eastward wind component"}, False, False),
        ("u", {"long_name": "zonal wind"}, False, False),
        ("u", {"long_name": "grid-relative u"}, True, False),
        ("u-component_of_wind_height_above_ground", {}, True, True),
    ],
)
def test_whether_components_follow_the_grid(
    path: Path, name: str, said: dict[str, Any], along_grid: bool, assumed: bool
) -> None:
    content = {"lat": ("y x", BENT, LAT2), "lon": ("y x", BENT, LON2), name: wind("y x", 3, 4, **said)}
    index, fields = everything(write_netcdf(path, content))
    assert [field2d.along_grid for field2d, _ in fields] == [along_grid]
    assert [f"{name}: used as following the grid" in note for note in index.unused] == [True] * assumed


def test_on_parallels_and_meridians_nothing_follows_the_grid(path: Path) -> None:
    fields = _fields(path, {**AXES, "u": wind("lat lon", 3, 4, standard_name="x_wind")})
    assert [field2d.along_grid for field2d in fields] == [False]


@pytest.mark.parametrize("dimension", ["cell", "node", "values"])
def test_unstructured_grids_are_explained(path: Path, dimension: str) -> None:
    content = {
        "lat": (dimension, [50.0, 51.0, 50.5], LAT2),
        "lon": (dimension, [7.0, 7.0, 8.0], LON2),
        "u": wind(dimension, 3, coordinates="lat lon"),
        "v": wind(dimension, 3, coordinates="lat lon"),
    }
    assert f"u, v: they stand at single places along {dimension}, on an unstructured grid" in _unused(path, content)


def test_axes_without_places_are_explained(path: Path) -> None:
    content = {"y": Y, "x": X, "u": wind("y x", 3, 4), "v": wind("y x", 3, 4)}
    assert "u, v: it stands on a projected grid (y, x) without latitudes and longitudes" in _unused(path, content)
    content = {"u": wind("a b", 3, 4), "v": wind("a b", 3, 4)}
    assert "u, v: their dimensions (a, b) are no latitudes and longitudes" in _unused(path, content)
    nowhere: Content = ("lat", [50.0, np.nan, 52.0], LAT2)
    assert "places that are no numbers" in _unused(path, {"lat": nowhere, "lon": LON, "u": wind("lat lon", 3, 4)})

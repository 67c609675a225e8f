"""Pictures of winds: which places, which level, which way."""

from __future__ import annotations

from pathlib import Path

import netCDF4
import numpy as np
import pytest

from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.wind.field_index import Level
from gcs_windplan.wind.inspect.wind_map import COLUMNS, ROWS, WindMap, map_around, map_of_area, usual_level
from gcs_windplan.wind.reading import open_indexes
from tests.wind.grib_files import box, message
from tests.wind.netcdf_maker import NOON, write_netcdf
from tests.wind.other_readers import real
from tests.wind.trap_file import write_trap

ONE_CM_PER_SECOND = 0.01
HOUR = 3600.0


def _map(path: Path, asked: float | None = None, level: Level | None = None) -> WindMap:
    with open_indexes([path]) as indexes:
        return map_of_area(indexes, asked, level, None)


def _around(path: Path, place: GeoPoint, radius: float) -> WindMap:
    with open_indexes([path]) as indexes:
        return map_around(indexes, place, radius, None, None, None)


@pytest.mark.parametrize(
    ("levels", "usual"),
    [
        ([Level("height", 10), Level("height", 80), Level("height", 180), Level("pressure", 1e5)], Level("height", 80)),
        ([Level("pressure", 85000), Level("pressure", 1e5)], Level("pressure", 1e5)),
        ([Level("model", 60), Level("model", 137)], Level("model", 137)),
        ([Level("altitude", 3000), Level("altitude", 500)], Level("altitude", 500)),
        ([Level("unknown")], Level("unknown")),
    ],
)
def test_the_usual_level_is_nearest_to_100_m_or_the_lowest(levels: list[Level], usual: Level) -> None:
    assert usual_level(levels) == usual


def test_small_grids_are_shown_node_by_node(tmp_path: Path) -> None:
    """North is up and west is left, whichever way the file stores them."""
    found = _map(write_trap(tmp_path / "a.nc", slope=True, whole_circle=True))
    np.testing.assert_allclose(found.rows, [53, 52, 51, 50, 49])
    np.testing.assert_allclose(found.columns, [-2, -1, 0, 1, 2])
    east, north = np.meshgrid(found.columns, found.rows)
    np.testing.assert_allclose(found.winds[..., 0], 10 + east, atol=ONE_CM_PER_SECOND)
    np.testing.assert_allclose(found.winds[..., 1], 10 * (north - 50), atol=ONE_CM_PER_SECOND)
    assert (found.level, found.stride) == (Level("height", 100.0), (1, 1))
    assert not found.outside.any()


def test_of_a_globe_every_few_nodes_without_the_poles() -> None:
    found = _map(real("ecmwf_data_uv.grib"))
    assert found.rows.tolist() == [80, 60, 40, 20, 0, -20, -40, -60, -80]
    assert len(found.columns) == COLUMNS
    assert (np.diff(found.columns) == 35).all()
    assert found.columns[0] == -180


def test_another_level_and_a_moment_between_two_times(tmp_path: Path) -> None:
    path = write_trap(tmp_path / "a.nc", hours=(0.0, 2.0), gusty=True, shear=True)
    found = _map(path, NOON + HOUR / 2, Level("height", 10.0))
    np.testing.assert_allclose(found.winds[..., 0], 22.5, atol=ONE_CM_PER_SECOND)
    assert found.times == (NOON, NOON + 2 * HOUR)


def test_a_level_that_is_not_there_lists_those_that_are(tmp_path: Path) -> None:
    with pytest.raises(WindError, match="no wind at 50 m above ground, but at 10 m above ground, 100 m above ground"):
        _map(write_trap(tmp_path / "a.nc"), level=Level("height", 50.0))


def test_missing_values_are_missing(tmp_path: Path) -> None:
    found = _map(write_trap(tmp_path / "a.nc", gap="nan"))
    assert np.isnan(found.winds).sum() == 1
    assert np.isnan(found.winds[0, -1, 0])


def test_without_wind_there_is_no_picture(tmp_path: Path) -> None:
    with pytest.raises(WindError, match="no v"):
        _map(write_trap(tmp_path / "a.nc", without=("v",)))


def test_a_projected_grid_is_shown_on_parallels_and_meridians() -> None:
    found = _map(real("ndfd_20170603T1800.nc"))
    assert found.winds.shape == (ROWS, COLUMNS, 2)
    assert (np.diff(found.rows) < 0).all()
    assert found.outside[0, 0]
    assert not found.outside[ROWS // 2, COLUMNS // 2]
    assert np.isnan(found.winds[found.outside]).all()
    assert np.isfinite(found.winds[~found.outside]).all()


def test_places_of_a_projected_grid_have_the_wind_of_the_nearest_node() -> None:
    """Beside a search through all nodes, and the file's speeds as netCDF4 reads them."""
    path = real("ndfd_20170603T1800.nc")
    found = _map(path)
    with open_indexes([path]) as indexes:
        grid = indexes[0].fields[0].grid
    with netCDF4.Dataset(path) as file:
        speeds = np.ma.filled(file["Wind_speed_height_above_ground"][0, 0], np.nan)
    narrow = np.cos(np.radians(grid.latitudes))
    for row, column in zip(*np.nonzero(~found.outside), strict=True):
        east = (grid.longitudes - found.columns[column] + 180.0) % 360.0 - 180.0
        nearest = np.argmin(((grid.latitudes - found.rows[row]) ** 2 + (east * narrow) ** 2).ravel())
        assert np.hypot(*found.winds[row, column]) == pytest.approx(speeds.ravel()[nearest], abs=ONE_CM_PER_SECOND)


@pytest.mark.parametrize("angle", [0.0, 30.0, 75.0, -60.0])
def test_winds_along_a_turned_grid_are_turned_to_true_north(angle: float, tmp_path: Path) -> None:
    j, i = np.mgrid[-10.0:10.0:21j, -12.0:12.0:25j] / 10.0
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    said = {"units": "m s-1", "coordinates": "latitude longitude"}
    path = write_netcdf(
        tmp_path / "bent.nc",
        {
            "latitude": ("y x", i * sin + j * cos, {"units": "degrees_north"}),
            "longitude": ("y x", i * cos - j * sin, {"units": "degrees_east"}),
            "u": ("y x", np.full(i.shape, 10.0), {**said, "standard_name": "x_wind"}),
            "v": ("y x", np.zeros(i.shape), {**said, "standard_name": "y_wind"}),
        },
    )
    winds = _map(path).winds
    winds = winds[np.isfinite(winds).all(axis=2)]
    np.testing.assert_allclose(winds, np.tile([10 * cos, 10 * sin], (len(winds), 1)), atol=ONE_CM_PER_SECOND)
    found = _around(path, GeoPoint(0.1, 0.1), 30_000.0)
    np.testing.assert_allclose(
        found.winds.reshape(-1, 2), winds[:1].repeat(ROWS * COLUMNS, axis=0), atol=ONE_CM_PER_SECOND
    )


def test_around_a_place(tmp_path: Path) -> None:
    """50 km are about 0.45 degrees of latitude and 0.71 of longitude."""
    place = GeoPoint(51.0, 0.5)
    found = _around(write_trap(tmp_path / "a.nc", slope=True), place, 50_000.0)
    assert (found.rows[0], found.rows[-1], found.columns[0], found.columns[-1]) == (50e3, -50e3, -50e3, 50e3)
    assert found.about == place
    np.testing.assert_allclose(found.winds[ROWS // 2, COLUMNS // 2], [10.5, 10.0], atol=ONE_CM_PER_SECOND)
    assert found.winds[0, COLUMNS // 2, 1] == pytest.approx(10 + 10 * 50 / 111.25, abs=0.02)
    assert found.winds[ROWS // 2, -1, 0] == pytest.approx(10.5 + 50 / 70.2, abs=0.02)


def test_around_a_place_at_the_edge_the_outside_stays_blank(tmp_path: Path) -> None:
    found = _around(write_trap(tmp_path / "a.nc"), GeoPoint(51.0, 2.0), 50_000.0)
    assert found.outside[:, COLUMNS // 2 + 1 :].all()
    assert not found.outside[:, : COLUMNS // 2].any()
    with pytest.raises(WindError, match=r"the wind ends 35\.0 km short of 51\.00000, 2\.50000"):
        _around(write_trap(tmp_path / "a.nc"), GeoPoint(51.0, 2.5), 50_000.0)


def test_around_a_place_across_greenwich_and_the_date_line(tmp_path: Path) -> None:
    path = tmp_path / "globe.grib2"
    globe = box(80.0, -80.0, 0.0, 350.0, 10.0)
    columns = (np.arange(36) * 10.0 + 180.0) % 360.0 - 180.0
    u = np.tile(np.abs(columns), 17) / 10.0
    level = {"typeOfLevel": "heightAboveGround", "level": 10}
    path.write_bytes(message("u", u, grid=globe, **level) + message("v", 0.0, grid=globe, **level))
    for longitude, speed in ((0.0, 0.0), (-180.0, 18.0), (179.0, 17.9)):
        found = _around(path, GeoPoint(0.0, longitude), 100_000.0)
        middle = found.winds[ROWS // 2, COLUMNS // 2, 0]
        assert middle == pytest.approx(speed, abs=ONE_CM_PER_SECOND)
        assert not found.outside.any()

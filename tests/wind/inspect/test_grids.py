"""Areas and spacings of grids."""

from __future__ import annotations

import numpy as np
import pytest

from gcs_windplan.arrays import FloatArray
from gcs_windplan.wind.field_index import Grid
from gcs_windplan.wind.inspect.grids import great_circle, summary_of, unit_vectors

ONE_PART_IN_A_HUNDRED = 0.01


def _grid(longitudes: FloatArray | list[float], latitudes: FloatArray | list[float] = (50.0, 51.0)) -> Grid:  # type: ignore[assignment]
    return Grid(np.asarray(latitudes, dtype=np.float64), np.asarray(longitudes, dtype=np.float64), "grid")


@pytest.mark.parametrize(
    ("longitudes", "west", "east", "closed"),
    [
        ([8.0, 9.0, 10.0], 8.0, 10.0, False),
        ([10.0, 9.0, 8.0], 8.0, 10.0, False),
        ([358.0, 359.0, 0.0, 1.0], -2.0, 1.0, False),  # across Greenwich
        ([0.0, 1.0, 358.0, 359.0], -2.0, 1.0, False),
        ([178.0, 179.0, 180.0, 181.0], 178.0, 181.0, False),  # across the date line
        (np.arange(0.0, 360.0, 5.0), -180.0, 175.0, True),
        (np.arange(-180.0, 181.0, 30.0), -180.0, 150.0, True),  # a meridian at both ends
        ([-111.98], -111.98, -111.98, False),
        ([0.0, 10.0, 20.0], 0.0, 20.0, False),
    ],
)
def test_longitudes(longitudes: FloatArray, west: float, east: float, closed: bool) -> None:
    found = summary_of(_grid(longitudes))
    assert (found.west, found.east, found.all_longitudes) == (pytest.approx(west), pytest.approx(east), closed)
    assert (found.south, found.north) == (50.0, 51.0)


def test_a_projected_grid_about_the_pole_has_all_longitudes() -> None:
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 21), np.linspace(-1.0, 1.0, 20))
    grid = Grid(90.0 - 20.0 * np.hypot(x, y), np.degrees(np.arctan2(x, -y)), "polar")
    found = summary_of(grid)
    assert found.all_longitudes
    assert found.south == pytest.approx(90.0 - 20.0 * np.sqrt(2.0))


def test_a_projected_grid_across_greenwich() -> None:
    y, x = np.mgrid[50.0:52.0:5j, -3.0:3.0:7j]
    found = summary_of(Grid(y + 0.1 * x, x % 360.0, "bent"))
    assert (found.west, found.east, found.all_longitudes) == (pytest.approx(-3.0), pytest.approx(3.0), False)


def test_spacing_of_parallels_and_meridians() -> None:
    """Across as at the middle row, 59.5 degrees north."""
    found = summary_of(_grid([8.0, 8.25, 8.5], [60.0, 59.5, 59.0]))
    expected = (0.5 * 111_195, 0.25 * 111_195 * np.cos(np.radians(59.5)))
    assert found.spacing_metres == pytest.approx(expected, rel=ONE_PART_IN_A_HUNDRED)


def test_one_row_has_no_spacing() -> None:
    assert summary_of(_grid([8.0], [47.0])).spacing_metres == (None, None)
    assert summary_of(_grid([8.0, 9.0], [47.0])).spacing_metres[0] is None


def test_spacing_of_a_projected_grid() -> None:
    y, x = np.mgrid[50.0:52.0:41j, 3.0:5.0:21j]
    found = summary_of(Grid(y, x, "bent"))
    expected = (0.05 * 111_195, 0.1 * 111_195 * np.cos(np.radians(51.0)))
    assert found.spacing_metres == pytest.approx(expected, rel=ONE_PART_IN_A_HUNDRED)


def test_great_circle_distances() -> None:
    """A quarter of the globe, and across the date line."""
    places = unit_vectors(np.zeros(3), np.array([179.5, 90.0, -179.0]))
    ways = great_circle(np.linalg.norm(places[1:] - places[0], axis=-1))
    np.testing.assert_allclose(ways / 111_195, [89.5, 1.5])

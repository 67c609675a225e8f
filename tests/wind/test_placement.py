"""Which part of a grid an area needs, and where places lie on it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import WindError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.wind.field_index import Grid
from gcs_windplan.wind.placement import axes_directions, subset_of

AREA = (-20e3, -20e3, 20e3, 20e3)
one_thousandth_of_a_cell = 1e-3


def grid(latitudes, longitudes) -> Grid:
    return Grid(np.asarray(latitudes, dtype=float), np.asarray(longitudes, dtype=float), "test grid")


WORLD = grid(np.arange(90, -91, -5), np.arange(0, 360, 5))


def places_of(subset, area=AREA):
    """Corners and middle of an area on the placement's axes, as shares of the part from 0 to 1."""
    points = np.array([[x, y] for x in (area[0], 0.0, area[2]) for y in (area[1], 0.0, area[3])])
    return points, subset.placement.at(points)


@pytest.mark.parametrize("origin", [(51.0, 0.5), (51.0, 179.5), (51.0, -179.5), (-36.0, 149.0), (64.9, -140.0)])
def test_of_a_world_from_0_to_360_a_few_nodes_around_the_area_are_kept(origin):
    frame = LocalFrame(GeoPoint(*origin))
    subset = subset_of(WORLD, frame, AREA)
    assert len(subset.rows) <= 5
    assert len(subset.columns) <= 5
    points, places = places_of(subset)
    latitudes, longitudes = frame.to_geographic(points)
    np.testing.assert_allclose(places[:, 0], latitudes, atol=1e-6)
    np.testing.assert_allclose((places[:, 1] - longitudes + 180) % 360 - 180, 0, atol=1e-6)
    assert (places[:, 1] >= subset.placement.columns[0]).all()
    assert (places[:, 1] <= subset.placement.columns[-1]).all()
    named = WORLD.longitudes[subset.columns]
    np.testing.assert_allclose((named - subset.placement.columns + 180) % 360 - 180, 0, atol=1e-9)


def test_a_meridian_that_stands_at_both_ends_counts_once():
    subset = subset_of(
        grid(np.arange(40, 60, 1.0), np.arange(-180, 180.5, 1.0)), LocalFrame(GeoPoint(50.0, 179.8)), AREA
    )
    assert (np.diff(subset.placement.columns) > 0.5).all()


def test_an_area_outside_is_an_error_that_says_by_how_much_unless_it_is_extended():
    small, frame = grid(np.arange(40, 45, 0.5), np.arange(0, 5, 0.5)), LocalFrame(GeoPoint(46.0, 2.0))
    with pytest.raises(WindError, match=r"ends 14[67] km short of the area: it covers latitudes 40\.000 to 44\.500"):
        subset_of(small, frame, AREA)
    with pytest.raises(WindError, match="take another file"):
        subset_of(small, frame, AREA, extend=True)
    near = LocalFrame(GeoPoint(44.9, 2.0))
    with pytest.raises(WindError, match="extend: nearest"):
        subset_of(small, near, AREA)
    assert len(subset_of(small, near, AREA, extend=True).rows)


def test_latitudes_that_stand_twice_are_refused():
    with pytest.raises(WindError, match="each value once"):
        subset_of(grid([50.0, 50.0, 51.0], [0.0, 1.0]), LocalFrame(GeoPoint(50.5, 0.5)), None)


def rotated_grid(angle: float, step: float = 5e3, nodes: int = 41) -> tuple[Grid, LocalFrame]:
    """A square lattice in the local frame, turned by an angle [deg], as latitudes and longitudes of its nodes."""
    frame = LocalFrame(GeoPoint(60.0, 10.0))
    offsets = (np.arange(nodes) - nodes // 2) * step
    x, y = np.meshgrid(offsets, offsets)
    turn = math.radians(angle)
    east, north = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
    latitudes, longitudes = frame.to_geographic(np.stack([east.ravel(), north.ravel()], axis=-1))
    return Grid(latitudes.reshape(x.shape), longitudes.reshape(x.shape), "turned lattice"), frame


@given(angle=st.floats(-80, 80), east=st.floats(-20e3, 20e3), north=st.floats(-20e3, 20e3))
def test_on_any_lattice_places_lie_where_its_nodes_say(angle, east, north):
    lattice, frame = rotated_grid(angle)
    subset = subset_of(lattice, frame, AREA)
    row, column = subset.placement.at(np.array([[east, north]]))[0, :2]
    turn = math.radians(angle)
    x, y = east * math.cos(turn) + north * math.sin(turn), north * math.cos(turn) - east * math.sin(turn)
    assert row + subset.rows[0] == pytest.approx(20 + y / 5e3, abs=one_thousandth_of_a_cell)
    assert column + subset.columns[0] == pytest.approx(20 + x / 5e3, abs=one_thousandth_of_a_cell)


@pytest.mark.parametrize("angle", [-60.0, 0.0, 33.0, 80.0])
def test_the_axes_of_a_lattice_point_where_it_was_turned_to(angle):
    lattice, frame = rotated_grid(angle)
    subset = subset_of(lattice, frame, AREA)
    directions = np.degrees(axes_directions(lattice, subset.rows, subset.columns))
    places = subset.placement.nodes.reshape(-1, 2)
    expected = angle - np.degrees(frame.convergence(places)).reshape(directions.shape)
    np.testing.assert_allclose(
        directions, expected, atol=0.06
    )  # the lattice is the ellipsoid's, the models' globe round


def test_how_far_a_place_lies_outside_is_told_in_metres():
    lattice, frame = rotated_grid(0.0)
    subset = subset_of(lattice, frame, (-100e3, -100e3, 100e3, 100e3))
    beyond = subset.placement.at(np.array([[112e3, 0.0], [0.0, 0.0]]))
    np.testing.assert_allclose(subset.placement.misses(beyond), [12e3, 0], rtol=0.02)


def test_a_lattice_of_few_nodes_is_placed_too():
    lattice, frame = rotated_grid(20.0, nodes=3, step=40e3)
    subset = subset_of(lattice, frame, AREA)
    np.testing.assert_allclose(subset.placement.at(np.zeros((1, 2)))[0, :2], [1, 1], atol=one_thousandth_of_a_cell)


def test_an_uneven_grid_is_refused():
    lattice, frame = rotated_grid(0.0)
    latitudes = lattice.latitudes.copy()
    latitudes[20, 20] += 0.02
    with pytest.raises(WindError, match="too uneven"):
        subset_of(Grid(latitudes, lattice.longitudes, "bent"), frame, AREA)


@pytest.mark.parametrize("longitude", [0.0, 45.0, 89.0, 135.0, 180.0, -100.0])
def test_on_a_polar_grid_the_axes_turn_with_the_meridian_all_around(longitude):
    """Polar stereographic about the pole, y axis along 180 degrees: at a longitude the x axis lies so far clockwise."""
    radius = 6371229.0
    x, y = np.meshgrid(np.arange(-2000e3, 2001e3, 50e3), np.arange(-2000e3, 2001e3, 50e3))
    latitudes = 90 - 2 * np.degrees(np.arctan(np.hypot(x, y) / (2 * radius)))
    longitudes = np.degrees(np.arctan2(x, -y))
    polar, frame = Grid(latitudes, longitudes, "polar stereographic"), LocalFrame(GeoPoint(76.0, longitude))
    subset = subset_of(polar, frame, AREA)
    middle = len(subset.rows) // 2, len(subset.columns) // 2
    here = longitudes[subset.rows[middle[0]], subset.columns[middle[1]]]
    found = np.degrees(axes_directions(polar, subset.rows, subset.columns)[middle])
    assert (found + here + 180) % 360 - 180 == pytest.approx(0.0, abs=0.1)
    back = Grid(latitudes[:, ::-1], longitudes[:, ::-1], "polar stereographic", backwards=True)
    subset = subset_of(back, frame, AREA)
    here = back.longitudes[subset.rows[middle[0]], subset.columns[middle[1]]]
    found = np.degrees(axes_directions(back, subset.rows, subset.columns)[middle])
    assert (found + here + 180) % 360 - 180 == pytest.approx(0.0, abs=0.1)

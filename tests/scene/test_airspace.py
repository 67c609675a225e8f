"""Keep-outs and keep-ins against shapely."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from gcs_windplan.errors import InputError
from gcs_windplan.scene import Airspace, Prism


def _star(rng, corners: int) -> np.ndarray:
    """A random simple polygon: radii around a centre."""
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    radii = rng.uniform(20, 120, corners)
    return rng.uniform(-50, 50, 2) + np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])


def _inside_pieces(polygon, start, end):
    """Fractions (from, to) of the leg that lie inside, by shapely."""
    line = shapely.LineString([start[:2], end[:2]])
    shared = shapely.intersection(line, polygon)
    pieces = [g for g in getattr(shared, "geoms", [shared]) if isinstance(g, shapely.LineString) and g.length > 0]
    return [tuple(line.project(shapely.Point(c), normalized=True) for c in (p.coords[0], p.coords[-1])) for p in pieces]


@pytest.mark.parametrize("seed", range(40))
def test_random_prisms_against_shapely(seed):
    rng = np.random.default_rng(seed)
    corners = _star(rng, int(rng.integers(3, 9)))
    polygon = shapely.Polygon(corners)
    if not polygon.is_valid:
        polygon = shapely.convex_hull(polygon)
        corners = np.array(polygon.exterior.coords)[:-1]
    floor, ceiling = np.sort(rng.uniform(0, 100, 2))
    starts = np.column_stack([rng.uniform(-200, 200, (300, 2)), rng.uniform(-20, 120, 300)])
    ends = np.column_stack([rng.uniform(-200, 200, (300, 2)), rng.uniform(-20, 120, 300)])
    prism = Prism("area", corners, floor, ceiling)
    through = Airspace(keep_out=(prism,)).breaches(starts, ends)
    leaving = Airspace(keep_in=(prism,)).breaches(starts, ends)
    for i, (start, end) in enumerate(zip(starts, ends, strict=True)):
        pieces = _inside_pieces(polygon, start, end)
        spans = [sorted(start[2] + np.array(piece) * (end[2] - start[2])) for piece in pieces]
        assert through[i] == any(high >= floor and low <= ceiling for low, high in spans), i
        stays = (
            polygon.covers(shapely.LineString([start[:2], end[:2]]))
            and min(start[2], end[2]) >= floor
            and max(start[2], end[2]) <= ceiling
        )
        assert leaving[i] != stays, i


def test_vertical_leg_and_point():
    square = Prism("school", np.array([[0, 0], [10, 0], [10, 10], [0, 10]], dtype=float), 0, 50)
    rules = Airspace(keep_out=(square,))
    low, high = np.array([[5.0, 5, 60]]), np.array([[5.0, 5, 90]])
    assert not rules.breaches(low, high)[0]
    assert rules.breaches(np.array([[5.0, 5, 40]]), high)[0]
    assert rules.broken_by(np.array([5.0, 5, 10]), np.array([5.0, 5, 10])) == ("school",)
    assert rules.broken_by(np.array([15.0, 5, 10]), np.array([15.0, 5, 10])) == ()


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        ([[0, 0], [10, 10], [10, 0], [0, 10]], "no simple polygon"),
        ([[0, 0], [10, 10]], "at least 3"),
        ([[0, 0], [5, 5], [10, 10]], "no simple polygon"),
        ([[0, 0], [np.nan, 5], [10, 10]], "no number"),
    ],
)
def test_bad_polygons(corners, message):
    with pytest.raises(InputError, match=message):
        Prism("bad", np.array(corners, dtype=float))


@pytest.mark.parametrize("margin", [5.0, -5.0])
def test_margins_move_the_border(margin):
    square = Prism("school", np.array([[0, 0], [100, 0], [100, 100], [0, 100]], dtype=float), 0, 50)
    moved = square.widened(margin)
    assert shapely.Polygon(moved.corners).area == pytest.approx((100 + 2 * margin) ** 2)
    assert (moved.floor, moved.ceiling) == (0, 50)


def test_a_margin_that_eats_the_area_is_an_error():
    square = Prism("garden", np.array([[0, 0], [8, 0], [8, 8], [0, 8]], dtype=float))
    with pytest.raises(InputError, match="too narrow"):
        square.widened(-5.0)

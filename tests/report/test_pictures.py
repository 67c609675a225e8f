"""Assessed missions as PNG."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from gcs_windplan.report import draw_assessment_map, draw_assessment_profile
from gcs_windplan.report.labels import LabelPlacer, rings
from gcs_windplan.report.map import new_map, style_axes
from gcs_windplan.report.relief import Ground, contour_step, shade
from gcs_windplan.terrain import Extent
from tests.report import made


def pixels(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


def has_colour(png: bytes, colour: tuple[int, int, int]) -> bool:
    return bool((np.abs(pixels(png).astype(int) - colour).sum(axis=2) < 8).any())


DANGER, WARNING = (0xB8, 0x49, 0x0A), (0xFF, 0xC9, 0x4D)


@pytest.mark.parametrize("draw", [lambda one: draw_assessment_map([one]), draw_assessment_profile])
def test_findings_are_marked(draw) -> None:
    found, clear = draw(made.assessment()), draw(replace(made.assessment(), findings=()))
    assert has_colour(found, DANGER)
    assert has_colour(found, WARNING)
    assert not has_colour(clear, DANGER)


def test_pictures_are_the_same_for_the_same_input() -> None:
    assert draw_assessment_map([made.assessment()]) == draw_assessment_map([made.assessment()])
    assert draw_assessment_profile(made.assessment()) == draw_assessment_profile(made.assessment())


def test_two_missions_lie_on_one_map() -> None:
    drawn = draw_assessment_map([made.assessment("a"), made.assessment("b", shift=300.0)])
    assert has_colour(drawn, (0x00, 0x72, 0xB2))
    assert has_colour(drawn, (0xD5, 0x5E, 0x00))


def test_obstacles_are_filled_as_on_a_plan_s_map() -> None:
    mission = made.assessment()
    house = replace(mission.outlines[0], kind="obstacle")
    purple = (0x5B, 0x3A, 0x5E)
    assert has_colour(draw_assessment_map([replace(mission, outlines=(house,))]), purple)
    assert not has_colour(draw_assessment_map([mission]), purple)


def test_routes_that_coincide_are_both_seen() -> None:
    drawn = pixels(draw_assessment_map([made.assessment("a"), made.assessment("b")])).astype(int)
    for colour in ((0x00, 0x72, 0xB2), (0xD5, 0x5E, 0x00)):
        assert (np.abs(drawn - colour).sum(axis=2) < 8).sum() > 500


def test_stops_do_not_cover_findings() -> None:
    """A sign has as many pixels of its colour with many stops about it as with few."""
    few, many = made.assessment(stops=9), made.assessment(stops=9)
    crowded = replace(many, stops=tuple(stop for stop in many.stops for _ in range(12)))
    counts = []
    for one in (few, crowded):
        drawn = pixels(draw_assessment_map([one])).astype(int)
        counts.append((np.abs(drawn - DANGER).sum(axis=2) < 8).sum())
    assert counts[1] >= 0.98 * counts[0]


def test_what_stands_on_a_drawing_keeps_its_room() -> None:
    _, axes, _ = new_map(Extent(0, 0, 1000, 1000))
    style_axes(axes, Extent(0, 0, 1000, 1000), "")
    placer = LabelPlacer(axes)
    half, around = (6.0, 4.0), ((0.0, 0.0), *rings(13.0, 1))
    taken = [placer.beside(0.5, 0.5, half, around) for _ in range(12)]
    placed = np.array([offset for offset in taken if offset is not None])
    assert len(placed) < 12  # then it is full
    for i, one in enumerate(placed):
        apart = np.abs(placed[:i] - one)
        assert ((apart[:, 0] >= 12) | (apart[:, 1] >= 8)).all()
    assert placer.beside(0.0, 0.5, half, around)[0] > 0  # not over the edge


def test_words_keep_off_lines_where_there_is_other_room() -> None:
    _, axes, _ = new_map(Extent(0, 0, 1000, 1000))
    style_axes(axes, Extent(0, 0, 1000, 1000), "")
    placer, half = LabelPlacer(axes), (6.0, 4.0)
    placer.keep_free(np.array([[0.5, 0.5], [1.0, 0.5]]))  # eastwards
    assert placer.beside(0.5, 0.5, half, rings(13.0, 1))[0] < 10
    (only,) = {placer.beside(0.8, 0.5, half, [(0.0, 0.0)])}
    assert only == (0.0, 0.0), "on the line rather than nowhere"


def test_what_is_not_known_is_left_out() -> None:
    mission = made.clear()
    blank = np.full_like(mission.profile.distance, np.nan)
    profile = replace(mission.profile, ground=blank, wind_along=blank)
    unknown = replace(mission, profile=profile)
    assert len(pixels(draw_assessment_profile(unknown)))
    nowhere = {name: getattr(mission.profile, name) for name in mission.profile.__slots__}
    nowhere = {name: None if values is None else values[:0] for name, values in nowhere.items()}
    empty = replace(mission, profile=type(mission.profile)(**nowhere), legs=(), stops=())
    assert len(pixels(draw_assessment_profile(empty)))
    assert len(pixels(draw_assessment_map([empty])))


def test_slopes_towards_the_light_are_bright_and_unknown_ground_is_clear() -> None:
    x, y = np.meshgrid(np.linspace(-1000, 1000, 80), np.linspace(-1000, 1000, 80))
    heights = 300 - 0.3 * np.hypot(x, y)  # a cone
    heights[0, 0] = np.nan
    colours = shade(Ground(-1000, -1000, 1000, 1000, heights), contours=0)
    north_west, south_east = colours[60, 20, :3].sum(), colours[20, 60, :3].sum()
    assert north_west > 1.2 * south_east
    assert colours[0, 0, 3] == 0
    assert colours[5, 5, 3] == 1


@pytest.mark.parametrize(("relief", "step"), [(0, 1), (12, 1), (200, 20), (600, 50), (3000, 250)])
def test_contour_lines_are_neither_many_nor_few(relief: float, step: int) -> None:
    assert contour_step(relief) == step


def test_a_picture_of_the_ground_keeps_its_edges_and_gaps() -> None:
    heights = np.add.outer(np.arange(40.0), np.arange(60.0))
    heights[10:20, 10:20] = np.nan
    ground = Ground(0, 0, 590, 390, heights)
    finer = ground.resampled(240)
    assert finer.heights.shape == (159, 240)
    assert np.isnan(finer.heights).mean() == pytest.approx(100 / 2400, rel=0.05)
    one_metre = 1.0
    assert np.nanmin(finer.heights) == pytest.approx(0, abs=one_metre)
    assert np.nanmax(finer.heights) == pytest.approx(98, abs=one_metre)

"""The flight along its way, and the ground and wind around it: what pages and plots are drawn from."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.assessment.assessment import GroundMap, Profile
from gcs_windplan.assessment.case import Case
from gcs_windplan.assessment.figures import AssessedMission, share_used
from gcs_windplan.assessment.flown import commands_of
from gcs_windplan.assessment.known import known_wind
from gcs_windplan.assessment.motion import motion_in, watts

_SAMPLES: Final = 1500
_NODES: Final = 300  # of the ground's longer side
_ARROWS: Final = 15
_MARGIN: Final = 0.15  # of the route's longer side
_LEAST_MARGIN: Final = 150.0  # [m]
_NARROWEST: Final = 0.6  # of the longer side, the shorter one of the map


def profile_of(mission: AssessedMission) -> Profile:
    """About 1500 samples along the flight, all corners among them."""
    case, flown, track = mission.case, mission.flown, mission.track
    piece, t = _spread(mission)
    owner = track.owners[piece]
    vectors = track.ends - track.starts
    points = track.starts[piece] + t[:, None] * vectors[piece]
    levels = np.concatenate([[0.0], np.cumsum(track.levels)])
    distance = levels[piece] + t * track.levels[piece]
    seconds = _clock(mission, piece, t)
    winds = known_wind(case.scene.wind, points, seconds).winds
    direction = (vectors / np.where(track.lengths > 0, track.lengths, 1.0)[:, None])[piece]
    motion = motion_in(winds, commands_of(track, owner, direction, flown.peaks, case), case)
    latitudes, longitudes = case.scene.frame.to_geographic(points)
    power = watts(motion, points[:, 2], case)
    return Profile(
        distance=distance,
        seconds=seconds,
        latitude_deg=latitudes,
        longitude_deg=longitudes,
        east=points[:, 0],
        north=points[:, 1],
        altitude=points[:, 2],
        ground=case.scene.terrain.heights_at(points),
        wind_along=motion.along,
        wind_across=motion.across,
        wind_east=winds[:, 0],
        wind_north=winds[:, 1],
        ground_speed=motion.ground,
        airspeed=motion.air,
        leg=track.leg_numbers[owner],
        power=power,
        left=_left(mission, seconds),
    )


def _spread(mission: AssessedMission) -> tuple[IntArray, FloatArray]:
    """Pieces and shares of them, evenly along the way; every move has both of its ends, one of no length too."""
    track = mission.track
    lengths = track.per_move(track.lengths)
    total = float(lengths.sum())
    spare = max(_SAMPLES - 2 * len(lengths), 0)
    counts = 2 + np.floor(spare * lengths / total if total > 0 else 0 * lengths).astype(np.int64)
    owner = np.repeat(np.arange(len(lengths)), counts)
    nth = np.arange(len(owner)) - (np.cumsum(counts) - counts)[owner]
    share = nth / (counts[owner] - 1)
    ways = np.concatenate([[0.0], np.cumsum(track.lengths)])
    firsts = track.firsts
    way = ways[firsts[:-1]][owner] + share * lengths[owner]
    piece = np.clip(np.searchsorted(ways, way, side="right") - 1, firsts[:-1][owner], firsts[1:][owner] - 1)
    sizes = track.lengths[piece]
    inside = np.clip((way - ways[piece]) / np.where(sizes > 0, sizes, 1.0), 0.0, 1.0)
    return piece, np.where(sizes > 0, np.where(share == 1, 1.0, inside), share)


def _clock(mission: AssessedMission, piece: IntArray, t: FloatArray) -> FloatArray:
    """When places are passed [s]: along a move evenly in time between its samples."""
    flown, track = mission.flown, mission.track
    lengths = track.lengths
    ways = np.concatenate([[0.0], np.cumsum(lengths)])
    begins = ways[track.firsts[:-1]]
    totals = track.per_move(lengths)
    owner = track.owners[piece]
    along = (ways[piece] + t * lengths[piece] - begins[owner]) / np.where(totals > 0, totals, 1.0)[owner]
    # one axis for all moves: move i lies between i and i + 1
    count = np.arange(len(track.moves), dtype=np.float64)
    samples = flown.samples
    knots = np.concatenate([count, samples.move + samples.along, count + 1 - 1e-9])
    times = np.concatenate([flown.begins[:-1], flown.passed, flown.begins[:-1] + flown.moving])
    order = np.argsort(knots, kind="stable")
    passed: FloatArray = np.interp(owner + np.minimum(along, 1 - 1e-9), knots[order], times[order])
    return passed


def _left(mission: AssessedMission, seconds: FloatArray) -> FloatArray | None:
    """The share of the battery that is left at moments; used evenly through each move."""
    used = share_used(mission.flown, mission.case)
    return None if used is None else 1 - np.interp(seconds, mission.flown.begins, used)


def ground_map_of(mission: AssessedMission) -> GroundMap:
    """The ground around the route in at most 300 x 300 nodes, and 15 x 15 arrows of wind half-way in time."""
    case, track = mission.case, mission.track
    corners = np.concatenate([np.array([track.course.home]), track.starts, track.ends])[:, :2]
    size = float(np.ptp(corners, axis=0).max())
    margin = max(_MARGIN * size, _LEAST_MARGIN)
    low, high = corners.min(axis=0) - margin, corners.max(axis=0) + margin
    lacking = np.maximum(_NARROWEST * float((high - low).max()) - (high - low), 0.0) / 2
    low, high = low - lacking, high + lacking
    cell = max(float((high - low).max()) / (_NODES - 1), case.scene.terrain.resolution / 4)
    east, north = (np.linspace(low[i], high[i], math.ceil((high[i] - low[i]) / cell) + 1)[:_NODES] for i in (0, 1))
    grid = np.meshgrid(east, north)
    heights = case.scene.terrain.heights_at(np.column_stack([axis.ravel() for axis in grid])).reshape(grid[0].shape)
    above = [stop.above_ground for stop in mission.stops if not math.isnan(stop.above_ground)]
    height = float(np.round(np.mean(above) if above else 50.0, -1)) or 10.0
    when = float(mission.flown.begins[-1] / 2)
    places, winds = _arrows(low, high, height, when, case)
    return GroundMap(east, north, heights, places, winds, height, when)


def _arrows(low: FloatArray, high: FloatArray, height: float, when: float, case: Case) -> tuple[FloatArray, FloatArray]:
    """Where wind is shown (k, 2) and what it is (k, 2), where ground and wind are known."""
    apart = float((high - low).max()) / _ARROWS
    axes = [np.arange(low[i] + apart / 2, high[i], apart) for i in (0, 1)]
    plan = np.column_stack([axis.ravel() for axis in np.meshgrid(*axes)])
    places = np.column_stack([plan, case.scene.terrain.heights_at(plan) + height])
    places = places[np.isfinite(places[:, 2])]
    winds = known_wind(case.scene.wind, places, np.full(len(places), when)).winds
    known = np.isfinite(winds).all(axis=1)
    return places[known, :2], winds[known, :2]

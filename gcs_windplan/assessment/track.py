"""Where a mission leads: its moves as polylines in the local frame, a return to launch among them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.assessment.case import Case
from gcs_windplan.errors import InputError
from gcs_windplan.mission.commands import Command
from gcs_windplan.mission.firmware import firmware_of
from gcs_windplan.mission.path import CommandedSpeeds, Course, Move, Place, course_of

_STEPS: Final = 24  # chords of a spline
_SPLINE_FACTOR: Final = 4.0  # ArduPilot's SplineCurve.cpp: more than this makes no curve longer
_FINE: Final = 8  # pieces in a cell of the ground that is followed
_MOST_STEPS: Final = 1000  # of a leg that follows it
_LEVEL: Final = 1e-6  # [m]


@dataclass(frozen=True, eq=False)
class Track:
    """The moves, none of them a return any more, and the polyline (k, 3) of each.

    A leg of the track is a move that leads somewhere: neither take-off, landing nor wait.
    """

    course: Course
    moves: tuple[Move, ...]
    paths: tuple[FloatArray, ...]
    remarks: tuple[str, ...]

    @cached_property
    def starts(self) -> FloatArray:
        """The beginnings of all straight pieces (m, 3)."""
        return _stacked([path[:-1] for path in self.paths])

    @cached_property
    def ends(self) -> FloatArray:
        """Their ends (m, 3)."""
        return _stacked([path[1:] for path in self.paths])

    @cached_property
    def owners(self) -> IntArray:
        """The move of each piece (m,)."""
        return np.repeat(np.arange(len(self.paths)), [len(path) - 1 for path in self.paths]).astype(np.int64)

    @cached_property
    def firsts(self) -> IntArray:
        """The first piece of each move, and their number (n + 1,)."""
        return np.concatenate([[0], np.cumsum([len(path) - 1 for path in self.paths])]).astype(np.int64)

    @cached_property
    def lengths(self) -> FloatArray:
        """The length of each piece (m,) [m]."""
        return np.asarray(np.linalg.norm(self.ends - self.starts, axis=1))

    @cached_property
    def levels(self) -> FloatArray:
        """The level length of each piece (m,) [m]."""
        vectors = self.ends - self.starts
        return np.asarray(np.hypot(vectors[:, 0], vectors[:, 1]))

    @cached_property
    def leg_moves(self) -> IntArray:
        """The moves that are legs, by their places among the moves."""
        return np.array([i for i, move in enumerate(self.moves) if is_leg(move)], dtype=np.int64)

    @cached_property
    def leg_numbers(self) -> IntArray:
        """For each move the number of the leg that it is or that it follows; 0 before the first one."""
        numbers: IntArray = np.cumsum([is_leg(move) for move in self.moves]).astype(np.int64)
        return numbers

    def per_move(self, values: FloatArray) -> FloatArray:
        """The sums of the pieces' values (m,) over each move (n,)."""
        return np.asarray(np.bincount(self.owners, weights=values, minlength=len(self.moves)), dtype=np.float64)


def is_leg(move: Move) -> bool:
    """Whether a move leads somewhere."""
    return move.kind == "leg" and move.label != "wait"


def track_of(case: Case) -> Track:
    """The track of a case's mission, whose home is known.

    Raises `InputError` for a mission that leads nowhere, or repeats more than 20 000 items.
    """
    course = course_of(case.mission, case.scene.frame, case.scene.terrain.heights_at)
    if not course.moves:
        raise InputError("the mission leads nowhere: none of its items is flown")
    moves = [piece for move in course.moves for piece in _laid_out(move, case)]
    splines = firmware_of(case.autopilot, case.vehicle_type).takes(Command.NAV_SPLINE_WAYPOINT)
    remarks = [one for one in course.remarks if not (splines and "SPLINE" in one)]
    if case.mission.rally and any(move.kind == "return" for move in course.moves):
        remarks.append("its return may lead to a rally point that is nearer; judged is the way home")
    if not case.hovers:
        remarks.append("a fixed-wing's turns and its take-off run are not modelled: straight lines, and up over home")
    paths = _paths(moves, case, splines)
    return Track(course, tuple(moves), tuple(paths), tuple(remarks))


def return_altitude(altitude: float, home: float, case: Case) -> float:
    """The height AMSL [m] at which a vehicle at an altitude returns home."""
    plane = None if case.hovers else firmware_of(case.autopilot, case.vehicle_type).plane_return
    return max(altitude, home + case.pace.return_height) if plane is None else home + plane


def _laid_out(move: Move, case: Case) -> list[Move]:
    """The move, or a return as the moves that it consists of: up, home, down."""
    if move.kind != "return":
        return [move]
    (east, north, ground), altitude = move.end, move.start[2]
    height = return_altitude(altitude, ground, case)
    over: Place = (east, north, height)
    up: Place = (*move.start[:2], max(height, altitude))
    climbs = [replace(move, kind="leg", end=up)] if height - altitude > _LEVEL else []
    if not case.hovers:  # it circles over home, to which it glides down from above
        return [*climbs, replace(move, kind="leg", start=up, end=over)]
    across = replace(move, kind="leg", start=up, end=over, hold=case.pace.return_hover)
    below = float(case.scene.terrain.heights_at(np.array([over]))[0])
    down = ground if math.isnan(below) else min(below, height)
    landing = Move(move.item, "landing", "land", over, (east, north, down), CommandedSpeeds())
    return [*climbs, across, landing]


def _paths(moves: Sequence[Move], case: Case, splines: bool) -> list[FloatArray]:
    """The polyline of each move."""
    paths: list[FloatArray] = []
    leaving: FloatArray | None = None  # of the spline before
    for i, move in enumerate(moves):
        path = np.array([move.start, move.end])
        if splines and move.label == "spline":
            path, leaving = _spline(moves, i, leaving)
        else:
            leaving = None
        paths.append(_draped(path, case) if move.follows else path)
    return paths


def _spline(moves: Sequence[Move], i: int, leaving: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    """ArduCopter's curve to a spline waypoint (k, 3), and its velocity vector at the end.

    AC_WPNav::set_spline_destination and AP_Math's SplineCurve: a cubic Hermite curve that leaves parallel to the way to
    the next place; from a place where it stopped it starts from rest.
    """
    move = moves[i]
    origin, end = np.array(move.start), np.array(move.end)
    first = np.zeros(3)
    if not move.rests and i > 0:
        first = np.subtract(moves[i - 1].end, moves[i - 1].start) if leaving is None else leaving
    last = np.zeros(3)
    if i + 1 < len(moves) and is_leg(moves[i + 1]) and not moves[i + 1].rests:
        last = np.array(moves[i + 1].end) - (origin if moves[i + 1].label == "spline" else end)
    size, room = np.linalg.norm(first) + np.linalg.norm(last), _SPLINE_FACTOR * np.linalg.norm(end - origin)
    scale = room / size if size > room else 1.0
    t = np.linspace(0.0, 1.0, _STEPS + 1)[:, None]
    v0, v1 = first * scale, last * scale
    square, cube = 3 * (end - origin) - 2 * v0 - v1, 2 * (origin - end) + v0 + v1
    curve = origin + v0 * t + square * t**2 + cube * t**3
    curve[-1] = end
    return curve, last


def _draped(path: FloatArray, case: Case) -> FloatArray:
    """A polyline whose height above ground changes evenly from its first to its last point.

    Pieces are an eighth of a cell of the terrain long. Over unknown ground it stays as it is.
    """
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    total = float(steps.sum())
    ground = case.scene.terrain.heights_at(path[[0, -1]])
    if total < _LEVEL or not np.isfinite(ground).all():
        return path
    count = int(np.clip(math.ceil(_FINE * total / case.scene.terrain.resolution), len(path) - 1, _MOST_STEPS))
    way = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.union1d(np.linspace(0.0, total, count + 1), way)
    places = np.column_stack([np.interp(at, way, path[:, axis]) for axis in range(3)])
    above = path[[0, -1], 2] - ground
    over = case.scene.terrain.heights_at(places) + above[0] + (above[1] - above[0]) * at / total
    places[:, 2] = np.where(np.isfinite(over), over, places[:, 2])
    places[[0, -1], 2] = path[[0, -1], 2]
    return places


def _stacked(parts: Sequence[FloatArray]) -> FloatArray:
    return np.ascontiguousarray(np.concatenate(parts)) if parts else np.empty((0, 3))

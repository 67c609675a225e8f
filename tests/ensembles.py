"""Ensembles and gates for tests: winds whose members disagree, ways that open later. At module level for workers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcs_windplan as gw
from gcs_windplan.planning.request import Request, Site, Uniform
from gcs_windplan.wind.field import Steady
from tests.scenes import in_scene
from tests.worlds import rough_dem

FRAME = gw.LocalFrame(gw.GeoPoint(46.8, 9.8))
TAIL, HEAD = 6.0, -7.0  # [m/s] along east in the corridor


@dataclass(frozen=True)
class Corridor(Steady):
    """Wind along east north of y = 200 m only, smoothly from nothing."""

    along: float
    name: str = "corridor"
    resolution: float = 40.0

    def at(self, points, seconds=0.0):
        share = 0.5 + 0.5 * np.tanh((points[:, 1] - 200.0) / 40.0)
        return np.column_stack([self.along * share, np.zeros(len(points)), np.zeros(len(points))])


@dataclass(frozen=True)
class Everywhere(Steady):
    """The same wind along east everywhere."""

    along: float
    name: str = "everywhere"
    resolution: float = 1000.0

    def at(self, points, seconds=0.0):
        return np.column_stack([np.full(len(points), self.along), *np.zeros((2, len(points)))])


@dataclass(frozen=True)
class Gate:
    """A gale from ahead that fills all the air and is over at once, linearly from `opens` [s] within a minute."""

    opens: float
    strength: float = 30.0
    until: float = 7200.0
    name: str = "gate"
    resolution: float = 60.0

    @property
    def times(self):
        return np.array([0.0, self.opens, self.opens + 60.0, self.until])

    def at(self, points, seconds=0.0):
        when = np.broadcast_to(np.asarray(seconds, dtype=float), len(points))
        strength = np.interp(when, self.times, [self.strength, self.strength, 0.0, 0.0])
        wall = np.clip((250.0 - np.abs(points[:, 0])) / 100.0, 0.0, 1.0)  # in the middle, from south to north
        wall *= np.clip((1000.0 - np.abs(points[:, 1])) / 100.0, 0.0, 1.0)
        return np.column_stack([-strength * wall, *np.zeros((2, len(points)))])


def request(**changes) -> Request:
    """From west to east over flat ground at 10 m/s."""
    whole = {
        "name": "test", "frame": FRAME, "terrain": rough_dem(1, size=1500.0, relief=0.0), "vehicle": gw.Vehicle(10.0),
        "start": Site("start", -900.0, 0.0), "goal": Site("goal", 900.0, 0.0), "clearance": 25.0, "max_height": 110.0,
        "graph": Uniform(60.0), "layers": (40.0,), "margin": 500.0,
    } | changes  # fmt: skip
    return Request(**in_scene(**whole))


def divided(robust: float = 0.5) -> Request:
    """Seven members promise a tail wind in the northern corridor, three a head wind."""
    members = tuple(Corridor(TAIL if k < 7 else HEAD) for k in range(10))
    mean = Corridor(float(np.mean([member.along for member in members])))
    return request(wind=mean, members=members, robust=robust)

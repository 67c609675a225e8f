"""Air that limits close: NaN where the wind or its gusts are too strong, and nowhere else."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from gcs_windplan.wind import Calm, ConstantWind, LimitedWind
from gcs_windplan.wind.each import at_each
from gcs_windplan.wind.field import Steady
from gcs_windplan.wind.limited import unlimited, with_spare

PLACES = np.array([[0.0, 0, 0], [4.0, 0, 0], [9.0, 0, 0], [11.0, 0, 0], [-20.0, 0, 0], [30.0, 0, 0]])


@dataclass(frozen=True)
class Ramp(Steady):
    """As many m/s along east as metres to the east of the origin; not known beyond 25 m."""

    factor: float = 1.0
    name: str = "ramp"
    resolution: float = 1.0

    def at(self, points, seconds=0.0):
        east = np.where(points[:, 0] > 25.0, np.nan, self.factor * points[:, 0])
        return np.column_stack([east, 0 * east, 0 * east])


def test_the_air_is_closed_where_the_wind_is_too_strong():
    wind = LimitedWind(Ramp(), 10.0)
    assert np.isnan(wind.at(PLACES)).all(axis=1).tolist() == [False, False, False, True, True, True]
    assert wind.at(PLACES)[:3] == pytest.approx(Ramp().at(PLACES)[:3])
    assert wind.closed(PLACES).tolist() == [False, False, False, True, True, False]  # the last is not known
    assert (wind.name, wind.resolution, len(wind.times)) == ("ramp", 1.0, 0)
    assert str(wind) == "limits.wind, 10 m/s"


def test_a_percent_stays_free_where_the_wind_is_known_by_samples():
    """Half of it for those who look more closely."""
    places = np.array([[9.89, 0, 0], [9.91, 0, 0], [9.94, 0, 0], [9.96, 0, 0]])
    wind = LimitedWind(Ramp(), 10.0)
    assert wind.closed(places).tolist() == [False, True, True, True]
    assert with_spare(wind, 0.005).closed(places).tolist() == [False, False, False, True]
    assert with_spare(Ramp(), 0.0) == unlimited(wind) == Ramp()


@pytest.mark.parametrize("direction", [0.0, 33.0, 271.5])
def test_a_uniform_wind_may_be_as_strong_as_its_limit(direction):
    wind = ConstantWind.from_direction(10.0, direction)
    assert not LimitedWind(wind, 10.0).closed(PLACES).any()
    assert LimitedWind(wind, 9.999).closed(PLACES).all()


def test_gusts_close_the_air_by_themselves():
    wind = LimitedWind(Calm(), gusts=(Ramp(),), gust_limit=10.0)
    assert wind.closed(PLACES).tolist() == [False, False, False, True, True, False]
    assert str(wind) == "limits.gust, 10 m/s"
    winds, gusts = wind.strengths(PLACES[:4])
    assert (winds.tolist(), gusts.tolist()) == ([0, 0, 0, 0], [0, 4, 9, 11])
    assert np.isnan(LimitedWind(Calm(), 10.0).strengths(PLACES)[1]).all()


def test_of_several_gusts_the_mean_counts():
    wind = LimitedWind(Calm(), gusts=(Ramp(), Ramp(0.0)), gust_limit=5.0)
    assert wind.closed(PLACES).tolist() == [False, False, False, True, True, False]


def test_members_are_closed_one_by_one():
    members = [LimitedWind(Ramp(), 10.0), LimitedWind(Ramp(2.0), 10.0, (Ramp(),), 3.0), LimitedWind(Ramp(0.5))]
    together = at_each(members, PLACES)
    assert together == pytest.approx(np.concatenate([one.at(PLACES) for one in members], axis=1), nan_ok=True)
    assert np.isnan(together[:, [0, 3, 6]]).sum(axis=0).tolist() == [3, 5, 1]


def test_limits_change_nothing_where_they_are_infinite():
    wind = LimitedWind(Ramp(), math.inf)
    assert wind.at(PLACES) == pytest.approx(Ramp().at(PLACES), nan_ok=True)

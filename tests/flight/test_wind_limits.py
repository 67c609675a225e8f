"""Limits of wind and gust: what they allow, and that legs beyond them cannot be flown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from gcs_windplan.flight.sampling import integrate_each
from gcs_windplan.flight.wind_limits import NO_LIMITS, WindLimits
from gcs_windplan.vehicle import Vehicle
from gcs_windplan.wind import Calm, ConstantWind
from gcs_windplan.wind.field import Steady

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


def beyond(limits: WindLimits, wind, places=PLACES, member: int = 0) -> list[bool]:
    return (limits.shares(member, wind.at(places), places, 0.0) > 1.0).tolist()


def test_a_wind_is_beyond_where_it_is_too_strong():
    limits = WindLimits(10.0)
    assert beyond(limits, Ramp()) == [False, False, False, True, True, False]  # the last is not known
    assert limits.shares(0, Ramp().at(PLACES), PLACES, 0.0)[1] == pytest.approx(4.0 / 9.9)
    assert str(limits) == "limits.wind, 10 m/s"
    assert limits
    assert not NO_LIMITS


def test_a_percent_stays_free_where_the_wind_is_known_by_samples():
    """Half of it for those who look more closely."""
    places = np.array([[9.89, 0, 0], [9.91, 0, 0], [9.94, 0, 0], [9.96, 0, 0]])
    limits = WindLimits(10.0)
    assert beyond(limits, Ramp(), places) == [False, True, True, True]
    assert beyond(limits.with_spare(0.005), Ramp(), places) == [False, False, False, True]
    assert beyond(limits.with_spare(0.0), Ramp(), places) == [False] * 4


@pytest.mark.parametrize("direction", [0.0, 33.0, 271.5])
def test_a_uniform_wind_may_be_as_strong_as_its_limit(direction):
    wind = ConstantWind.from_direction(10.0, direction)
    assert not any(beyond(WindLimits(10.0, exact=True), wind))
    assert all(beyond(WindLimits(9.999, exact=True), wind))


def test_gusts_are_limited_by_themselves():
    limits = WindLimits(gust=10.0, gusts=((Ramp(),),))
    assert beyond(limits, Calm()) == [False, False, False, True, True, False]
    assert str(limits) == "limits.gust, 10 m/s"
    assert str(WindLimits(8.0, 10.0)) == "limits.wind, 8 m/s, or limits.gust, 10 m/s"
    assert limits.resolution_beside(Calm(), 0) == 1.0


def test_of_several_gusts_the_mean_counts():
    limits = WindLimits(gust=5.0, gusts=((Ramp(), Ramp(0.0)),))
    assert beyond(limits, Calm()) == [False, False, False, True, True, False]


def test_each_member_has_its_own_gusts():
    limits = WindLimits(10.0, 3.0, ((Ramp(0.1),), (Ramp(),)))
    assert beyond(limits, Ramp(), member=0) == [False, False, False, True, True, False]
    assert beyond(limits, Ramp(0.5), member=1) == [False, True, True, True, True, False]


def test_a_leg_beyond_the_limits_cannot_be_flown_in_that_member_alone():
    """From 0 to 12 m/s along it, against limits of 10 m/s of wind and of gust."""
    starts, ends = np.array([[0.0, 0, 50], [0.0, 0, 50]]), np.array([[12.0, 0, 50], [9.0, 0, 50]])
    members = (Ramp(), Ramp(0.5), Ramp(0.25))
    gusts = ((Ramp(),), (Ramp(0.5),), (Ramp(),))
    vehicle = Vehicle(15.0)
    free = integrate_each(members, vehicle, starts, ends)
    wind = integrate_each(members, vehicle, starts, ends, limits=WindLimits(10.0))
    gust = integrate_each(members, vehicle, starts, ends, limits=WindLimits(gust=10.0, gusts=gusts))
    assert np.isfinite([part.seconds for part in free]).all()
    assert [np.isfinite(part.seconds).tolist() for part in wind] == [[False, True], [True, True], [True, True]]
    assert [np.isfinite(part.seconds).tolist() for part in gust] == [[False, True], [True, True], [False, True]]
    for bound in (wind, gust):
        for one, other in zip(bound, free, strict=True):
            assert one.along == pytest.approx(other.along, rel=1e-9)
            assert one.seconds[1] == pytest.approx(other.seconds[1], rel=1e-6)

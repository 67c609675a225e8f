"""The limits of wind and gust as a request puts them, and what a planned route meets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.errors import NoRouteError, Problem
from gcs_windplan.flight import fly_legs
from gcs_windplan.flight.wind_limits import NO_LIMITS, WindLimits, mean_strength
from gcs_windplan.planning.cost import rank_of
from gcs_windplan.planning.request import Limits, Request
from gcs_windplan.wind.each import at_each
from gcs_windplan.wind.field import WindField
from gcs_windplan.wind.gridded import GriddedWind, mean_of

_FINER: Final = 8.0  # samples of a leg on the wind's own resolution
_FEWEST, _MOST = 16, 2048  # samples of a leg
_BETWEEN: Final = 8  # moments between two of the wind's at which a site is looked at
_ROUNDING: Final = 1e-9


def wind_limits(request: Request) -> WindLimits:
    """The request's limits of wind and gust, and the gusts of its members, or of their mean where it has none."""
    limits = request.limits
    if not limits.of_wind:
        return NO_LIMITS
    gusts: tuple[tuple[WindField, ...], ...] = tuple((one,) for one in request.scene.gusts)
    if not request.scene.members and gusts:
        gridded = [one for one in request.scene.gusts if isinstance(one, GriddedWind)]
        whole = len(gridded) == len(gusts)
        gusts = ((mean_of(gridded),) if whole else request.scene.gusts,)  # their first part is the gust: they add up
    winds = request.scene.members or (request.scene.wind,)
    everything = (*winds, *(() if limits.gust is None else request.scene.gusts))
    return WindLimits(
        math.inf if limits.wind is None else limits.wind,
        math.inf if limits.gust is None else limits.gust,
        gusts,
        exact=all(math.isinf(one.resolution) and len(one.times) < 2 for one in everything),
    )


def limits_broken_at_sites(request: Request, sites: FloatArray) -> list[Problem]:
    """A limit of gusts that the wind does not tell, and the sites (n, 3) that the limits close at all times."""
    limits, wind = request.limits, request.scene.wind
    if limits.gust is not None and not request.scene.gusts:
        text = f"the forecast has no gusts ({wind.name}): leave the limit out, or take a forecast with them"
        return [Problem(text, "limits.gust")]
    if not limits.of_wind:
        return []
    mean = wind_limits(request.in_the_mean())
    moments = _moments(wind.times).tolist()
    closed = np.array([mean.shares(0, wind.at(sites, moment), sites, moment) > 1.0 for moment in moments])
    problems = []
    for i in np.flatnonzero(closed.all(axis=0)):
        site = sites[i : i + 1]
        speeds = np.array([_strengths(wind, mean.gusts_of(0), site, moment) for moment in moments])[:, :, 0]
        problems.append(Problem(_too_windy(limits, *speeds.min(axis=0)), request.sites[i].field))
    return problems


def _strengths(
    wind: WindField, gusts: Sequence[WindField], points: FloatArray, seconds: float | FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The strength of the wind and of its gusts (n,) each [m/s]; NaN where it is not known, or there are none."""
    unknown = np.full((len(points), 3), np.nan)
    blown = at_each(gusts, points, seconds) if gusts else unknown
    return mean_strength(wind.at(points, seconds)), mean_strength(blown)


def _moments(times: FloatArray) -> FloatArray:
    """Moments [s since departure] at which a site is looked at: the wind's from the departure on, and some between."""
    if len(times) < 2:
        return np.zeros(1)
    places = np.linspace(0, len(times) - 1, _BETWEEN * (len(times) - 1) + 1)
    moments = np.interp(places, np.arange(len(times)), times)
    return np.append(max(0.0, moments[0]), moments[moments > 0])


def _too_windy(limits: Limits, wind: float, gust: float) -> str:
    """What to say of a site in a wind and gust [m/s]."""
    said = []
    if limits.wind is not None and wind > limits.wind * (1 - 1e-2):
        said.append(f"the wind there is {wind:.2f} m/s or more, too much for limits.wind, {limits.wind:g} m/s")
    if limits.gust is not None and gust > limits.gust * (1 - 1e-2):
        said.append(f"the gusts there are {gust:.2f} m/s or more, too much for limits.gust, {limits.gust:g} m/s")
    where = " and ".join(said) or "wind and gusts there are too strong for the limits at all times"
    return f"{where}: another place or height, another departure, or a higher limit"


@dataclass(frozen=True, slots=True, eq=False)
class Strongest:
    """The strongest wind and gust on each leg of a route (members, legs) [m/s]; NaN where nothing is known.

    Without an ensemble there is one member.
    """

    winds: FloatArray
    gusts: FloatArray

    @property
    def wind(self) -> float:
        """The strongest wind of all [m/s]."""
        return float(np.nanmax(self.winds))

    @property
    def gust(self) -> float | None:
        """The strongest gust of all [m/s]; None where none are told."""
        return None if np.isnan(self.gusts).all() else float(np.nanmax(self.gusts))

    def within_limits(self, limits: Limits) -> int:
        """In how many members the whole route keeps the limits."""
        return int(np.count_nonzero(~self.over(limits).any(axis=1)))

    def check_limits(self, limits: Limits, robust: float) -> None:
        """Raise `NoRouteError` where fewer members than the quantile `robust` asks for keep the limits."""
        members = len(self.winds)
        if self.within_limits(limits) > rank_of(robust, members):
            return
        leg = int(np.argmax(self.over(limits).sum(axis=0)))
        wind, gust = float(np.nanmax(self.winds[:, leg])), float(np.fmax.reduce(self.gusts[:, leg]))
        told = f"wind up to {wind:.2f} m/s" + (f", gusts up to {gust:.2f} m/s" if math.isfinite(gust) else "")
        raise NoRouteError(
            f"leg {leg + 1} breaks the wind limit ({said(limits)}): {told}. A finer graph, other layers, another"
            " departure, or a higher limit.",
            {"wind": 1},
        )

    def over(self, limits: Limits) -> BoolArray:
        """Which legs of which members (members, legs) break a limit."""
        wind = math.inf if limits.wind is None else limits.wind
        gust = math.inf if limits.gust is None else limits.gust
        over: BoolArray = (self.winds > wind * (1 + _ROUNDING)) | (self.gusts > gust * (1 + _ROUNDING))
        return over


def said(limits: Limits) -> str:
    """The limits of wind and gust in words: `limits.wind, 10 m/s`."""
    named = {"limits.wind": limits.wind, "limits.gust": limits.gust}
    return ", ".join(f"{name}, {limit:g} m/s" for name, limit in named.items() if limit is not None)


def strongest_along(
    request: Request, points: FloatArray, begin: float = 0.0, airspeeds: FloatArray | None = None
) -> Strongest:
    """The strongest wind and gust along a route (n, 3) that begins at `begin` [s since departure], in each member.

    Each leg at the vehicle's airspeed, or at its own of `airspeeds` (n - 1,) [m/s].
    """
    fields: tuple[WindField, ...] = request.scene.members or (request.scene.wind,)
    winds, gusts = [], []
    for k, field in enumerate(fields):
        places, when = _samples(request, points, field, begin, airspeeds)
        wind, gust = _strengths(field, request.scene.gusts[k : k + 1], places.reshape(-1, 3), when.ravel())
        winds.append(np.fmax.reduce(wind.reshape(when.shape), axis=1))
        gusts.append(np.fmax.reduce(gust.reshape(when.shape), axis=1))
    return Strongest(np.array(winds), np.array(gusts))


def _samples(
    request: Request, points: FloatArray, wind: WindField, begin: float, airspeeds: FloatArray | None
) -> tuple[FloatArray, FloatArray]:
    """Places (legs, k, 3) all along a route, and when they are passed in a wind (legs, k) [s since departure]."""
    times = fly_legs(points, wind, request.vehicle, begin, airspeeds)[1]
    if not np.isfinite(times).all():  # this member cannot fly it at all
        times = fly_legs(points, request.scene.wind, request.vehicle, begin, airspeeds)[1]
    longest = float(np.linalg.norm(np.diff(points, axis=0), axis=1).max())
    count = int(np.clip(math.ceil(_FINER * longest / wind.resolution), _FEWEST, _MOST))
    share = np.linspace(0.0, 1.0, count)
    places = points[:-1, None] + share[None, :, None] * np.diff(points, axis=0)[:, None]
    when = times[:-1, None] + share[None, :] * np.diff(times)[:, None]
    latest = float(wind.times[-1]) if len(wind.times) > 1 else math.inf
    return places, np.minimum(when, latest)

"""The order of the vias that costs least: start and goal stay where they are.

    costs between all sites on the graph ─▶ best order by dynamic programming over subsets ─▶ compared with the given

Held and Karp 1962, doi:10.1137/0110015: the least cost of visiting a subset of the vias and ending at one of them
follows from those of the subsets with one via less. In wind the way there costs otherwise than the way back, and in
changing wind it depends on when it is flown. Then costs are known at three moments, and each subset carries its clock.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import NoRouteError, Problem
from gcs_windplan.flight import clock
from gcs_windplan.planning.contradictions import too_many_to_order
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.request import Request
from gcs_windplan.planning.route import Ready, cost_between, find_route, unshaped
from gcs_windplan.planning.search import find_open_path

_MOMENTS: Final = (0.5, 1.0)  # of the flight in the order that is best at its begin: when changing costs are looked at
_SAME: Final = 0.01  # [m]
_WORTH: Final = 1e-6  # of the cost, that another order must gain over the given one


@dataclass(frozen=True, slots=True, eq=False)
class Costs:
    """What flying from each site to each other costs, start first and goal last, for departures at some moments.

    `costs` and `seconds` (moments, sites, sites), infinite where there is no way; `moments` [s since departure].
    """

    moments: FloatArray
    costs: FloatArray
    seconds: FloatArray

    def between(self, origins: Sequence[int], clocks: FloatArray, to: int) -> tuple[FloatArray, FloatArray]:
        """Costs and seconds from some sites, each left at its clock (n,), to one; linear between the moments."""
        rows = np.asarray(origins, dtype=np.int64)
        place = np.interp(clocks, self.moments, np.arange(len(self.moments)))
        before = np.minimum(place.astype(np.int64), max(len(self.moments) - 2, 0))
        after = np.minimum(before + 1, len(self.moments) - 1)
        share = place - before
        return _mixed(self.costs, before, after, share, rows, to), _mixed(self.seconds, before, after, share, rows, to)


def _mixed(
    table: FloatArray, before: IntArray, after: IntArray, share: FloatArray, rows: IntArray, to: int
) -> FloatArray:
    """Between two moments; infinite where it is so at a moment that counts."""
    early, late = table[before, rows, to], table[after, rows, to]
    with np.errstate(invalid="ignore"):
        mixed = (1 - share) * early + share * late
    return np.where(share == 0, early, np.where(share == 1, late, np.where(np.isnan(mixed), np.inf, mixed)))


def best_order(costs: Costs, begin: float = 0.0) -> tuple[int, ...] | None:
    """The vias (1 to n, as rows of the costs) in the order that costs least from `begin` on; None where none can be
    flown."""
    n = costs.costs.shape[1] - 2
    whole = (1 << n) - 1
    best = np.full((whole + 1, n), np.inf)
    clocks = np.full((whole + 1, n), begin)
    came_from = np.full((whole + 1, n), -1, dtype=np.int64)
    for via in range(n):
        cost, seconds = costs.between([0], np.array([begin]), via + 1)
        best[1 << via, via], clocks[1 << via, via] = cost[0], begin + seconds[0]
    for visited in range(1, whole):
        ends = [via for via in range(n) if np.isfinite(best[visited, via])]
        rows = [via + 1 for via in ends]
        for via in (via for via in range(n) if not visited >> via & 1 and ends):
            cost, seconds = costs.between(rows, clocks[visited, ends], via + 1)
            total = best[visited, ends] + cost
            least, then = int(np.argmin(total)), visited | 1 << via
            best[then, via], came_from[then, via] = total[least], ends[least]
            clocks[then, via] = clocks[visited, ends[least]] + seconds[least]
    home = costs.between(list(range(1, n + 1)), np.nan_to_num(clocks[whole], posinf=begin), n + 1)[0]
    total = best[whole] + home
    if not np.isfinite(total).any():
        return None
    order, visited = [int(np.argmin(total))], whole
    while (before := came_from[visited, order[-1]]) >= 0:
        visited ^= 1 << order[-1]
        order.append(int(before))
    return tuple(via + 1 for via in reversed(order))


def put_in_order(ready: Ready, choice: CostChoice, begin: float = 0.0) -> tuple[Ready, tuple[str, ...]]:
    """The same with its vias in the order that costs least, and a note that says so; as it is unless `order` is free.

    Over an ensemble the order is that for the members' mean. Raises `NoRouteError` that names a via which cannot be
    reached or left.
    """
    request = ready.request
    if request.order == "given" or len(request.via) < 2:
        return ready, ()
    mean = ready.in_the_mean()
    order = _best_order(mean, choice, begin)
    chosen, given = _cost_in(mean, choice, begin, order), _cost_in(mean, choice, begin, tuple(sorted(order)))
    if not chosen < given * (1 - _WORTH):
        return ready, ("order of the vias: as given, which is the best one",)
    numbers = ", ".join(map(str, order))
    return _reordered(ready, order), (f"order of the vias: {numbers}; {_saving(choice, chosen, given)}",)


def too_many_or_equal(request: Request, sites: FloatArray) -> list[Problem]:
    """What is wrong with vias that are to be put in order: more than 12, or two places (n, 3) that are one."""
    if request.order == "given":
        return []
    problems = list(too_many_to_order(len(request.via)))
    if problems:
        return problems
    for i in range(1, len(sites) - 1):
        apart = np.linalg.norm(sites - sites[i], axis=1)
        same = next((j for j in (*range(i), len(sites) - 1) if apart[j] < _SAME), None)
        if same is not None:
            text = f"is the same place as {request.sites[same].field}: leave one of the two out"
            problems.append(Problem(text, request.sites[i].field))
    return problems


def _best_order(ready: Ready, choice: CostChoice, begin: float) -> tuple[int, ...]:
    """The best order of the vias by costs on the graph. Raises `NoRouteError`."""
    costs, errors = _costs(ready, choice, np.array([begin]))
    order = best_order(costs, begin)
    if order is None:
        raise _no_order(ready.request, costs, errors)
    if ready.windy.times is None:
        return order
    lasting = sum(costs.seconds[0, a, b] for a, b in pairwise((0, *order, len(order) + 1)))
    later = begin + lasting * np.array(_MOMENTS)
    more = _costs(ready, choice, later[later < ready.windy.ends])[0]
    parts = [np.concatenate(part) for part in zip(_parts(costs), _parts(more), strict=True)]
    return best_order(Costs(*parts), begin) or order


def _parts(costs: Costs) -> tuple[FloatArray, FloatArray, FloatArray]:
    return costs.moments, costs.costs, costs.seconds


def _costs(ready: Ready, choice: CostChoice, moments: FloatArray) -> tuple[Costs, dict[tuple[int, int], NoRouteError]]:
    """The costs between the sites on the graph, and why there is no way where there is none."""
    sites = ready.sites
    shape = len(moments), len(sites), len(sites)
    costs, seconds = np.full(shape, np.inf), np.full(shape, np.inf)
    errors = {}
    for m, moment in enumerate(moments.tolist()):
        for a, b in ((a, b) for a in range(len(sites) - 1) for b in range(1, len(sites)) if a != b):
            cost = cost_between(ready, choice, sites[a], sites[b], moment)
            try:
                path = find_open_path(ready.windy, cost, sites[a], sites[b], moment)
            except NoRouteError as error:
                errors[a, b] = error
                continue
            prices, times = cost.priced(path.points)
            costs[m, a, b], seconds[m, a, b] = float(prices.sum()), float(times[-1]) - moment
    return Costs(moments, costs, seconds), errors


def _no_order(request: Request, costs: Costs, errors: dict[tuple[int, int], NoRouteError]) -> NoRouteError:
    """The error that names the first site which cannot be reached, or left, to which the others can."""
    open_ways = np.isfinite(costs.costs[0])
    last = len(open_ways) - 1
    for site in range(last + 1):
        into, out_of = open_ways[:last, site].any(), open_ways[site, 1:].any()
        if (site == 0 or into) and (site == last or out_of):
            continue
        reached = site == 0 or into
        way, (a, b) = ("left", (site, 1 if site != 1 else last)) if reached else ("reached", (0, site))
        told = errors.get((a, b))
        text = f"cannot be {way} on any way: {told if told is not None else 'the wind closes all of them'}"
        cuts = told.cuts if told is not None else {"wind": 1}
        brief = f"{request.sites[site].field} cannot be {way}" if told is None else told.brief
        return NoRouteError(str(request.locate(Problem(text, request.sites[site].field))), cuts, brief)
    return NoRouteError("no order of the vias can be flown: each can be reached and left, but not all on one way", {})


def _cost_in(ready: Ready, choice: CostChoice, begin: float, order: tuple[int, ...]) -> float:
    """What the graph's route in an order costs, infinite where it cannot be flown."""
    try:
        return find_route(_reordered(ready, order), choice, begin, unshaped).cost
    except NoRouteError:
        return float("inf")


def _reordered(ready: Ready, order: tuple[int, ...]) -> Ready:
    """The same with its vias (numbered from 1) in an order."""
    via = tuple(ready.request.via[number - 1] for number in order)
    sites = ready.sites[[0, *order, len(order) + 1]]
    request, asked = (replace(one, via=via) for one in (ready.request, ready.asked))
    return replace(ready, sites=sites, request=request, asked=asked)


def _saving(choice: CostChoice, chosen: float, given: float) -> str:
    """What the chosen order saves against the given one, in words."""
    if not np.isfinite(given):
        return "the given one cannot be flown"
    saved, share = given - chosen, f"{100 * (1 - chosen / given):.0f} %"
    known = {"time": f"{clock(saved)} min", "distance": f"{saved / 1000:.2f} km", "energy": f"{saved / 3600:.0f} Wh"}
    amount = known.get(choice.name)
    return f"saves {amount} ({share}) against the given one" if amount else f"saves {share} against the given one"

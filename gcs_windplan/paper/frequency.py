"""How often the paper's effects hold: many starts and goals on several graphs, every flight counted."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from gcs_windplan.errors import NoRouteError
from gcs_windplan.paper.cases import (
    CASES,
    OTHER_READINGS,
    PaperCase,
    PlanePoint,
    lift_to_veil,
    make_rules,
    make_vehicle,
)
from gcs_windplan.paper.flying import Route, find_route, shape_route
from gcs_windplan.paper.graphs import SPACING, THIRTY_SIX, TWENTY, lay_roadmap, lay_uniform
from gcs_windplan.paper.published import ANGLE, DISTANCE, HYBRID, TIME
from gcs_windplan.paper.tables import Table
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.search import WindGraph, sample_wind
from gcs_windplan.planning.veil import PrmVeil
from gcs_windplan.scene import Clearance
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import SpeedModel, Vehicle

PLACES: Final = (-1.8, -0.6, 0.6, 1.8)  # east and north of starts and goals
APART: Final = 1.5  # at least, from start to goal
SEEDS: Final = (1, 2, 3, 4)  # of the roadmaps
UNIFORM: Final = "uniform, 8 neighbours"
PRM: Final = "PRM"

_MOSTLY_DISTANCE: Final = CostChoice("hybrid", distance=0.9, angle=0.1)
_CHOICES: Final = (DISTANCE, ANGLE, _MOSTLY_DISTANCE, HYBRID, TIME)
_EQUAL: Final = 1e-9  # of a time: rounding


@dataclass(frozen=True, slots=True, eq=False)
class TrialFlight:
    """One start, goal, field and graph: the routes by cost, and the shaped time [s]; no routes where none exists."""

    case: PaperCase
    graph: str
    routes: dict[CostChoice, Route]
    shaped: float = np.inf

    @property
    def eastward(self) -> bool:
        """Whether the goal lies to the east of the start, so that the jet of case 1 helps all the way."""
        return self.case.goal[0] > self.case.start[0]

    def seconds(self, choice: CostChoice) -> float:
        """The flight time by a cost [s]."""
        return self.routes[choice].seconds

    @property
    def best_other(self) -> float:
        """The shortest flight time by any cost but `time` [s]."""
        return min(route.seconds for choice, route in self.routes.items() if choice != TIME)


Test = Callable[[TrialFlight], bool]


def _less(first: CostChoice, second: CostChoice) -> Test:
    return lambda trial: trial.seconds(first) < trial.seconds(second) * (1 - _EQUAL)


def _either(first: CostChoice, second: CostChoice) -> Test:
    return lambda trial: trial.seconds(first) <= trial.seconds(second) * (1 + _EQUAL)


ANGLE_WINS: Final = _less(ANGLE, DISTANCE)
ANGLE_LOSES: Final = _less(DISTANCE, ANGLE)
HYBRID_WINS: Final = _less(HYBRID, DISTANCE)
HYBRID_NO_WORSE: Final = _either(HYBRID, ANGLE)


def as_printed(trial: TrialFlight) -> bool:
    """Whether a trial shows all that the paper says of its case."""
    table_1 = ANGLE_LOSES if trial.case.number == "2" else ANGLE_WINS
    return table_1(trial) and HYBRID_WINS(trial) and (trial.case.number != "2" or HYBRID_NO_WORSE(trial))


def time_wins_on_graph(trial: TrialFlight) -> bool:
    """Whether `time` beats or equals the other costs before its route is shaped."""
    return trial.seconds(TIME) <= trial.best_other * (1 + _EQUAL)


def time_wins(trial: TrialFlight) -> bool:
    """Whether the shaped route of `time` beats or equals the other costs."""
    return trial.shaped <= trial.best_other * (1 + _EQUAL)


_EFFECTS: Final[tuple[tuple[str, Test], ...]] = (
    ("angle beats distance", ANGLE_WINS),
    ("angle loses to distance", ANGLE_LOSES),
    ("hybrid 0.1/0.9 beats distance", HYBRID_WINS),
    ("hybrid 0.1/0.9 beats or equals angle", HYBRID_NO_WORSE),
    ("all that the paper says of the case", as_printed),
    ("time on the graph beats or equals all", time_wins_on_graph),
    ("time, shaped, beats or equals all", time_wins),
)

_GROUPS: Final[tuple[tuple[str, Test], ...]] = (
    ("1 (unit), eastward", lambda trial: trial.case.reading == "unit" and trial.eastward),
    ("1 (unit), all", lambda trial: trial.case.reading == "unit"),
    ("1 (magnitude), eastward", lambda trial: trial.case.reading == "magnitude" and trial.eastward),
    ("1 (literal), eastward", lambda trial: trial.case.reading == "literal" and trial.eastward),
    ("2", lambda trial: trial.case.number == "2"),
    ("3", lambda trial: trial.case.number == "3"),
)


def make_pairs(every: int = 1) -> list[tuple[PlanePoint, PlanePoint]]:
    """Starts and goals on a grid of places, or every so-manieth of them."""
    places = [(east, north) for east in PLACES for north in PLACES]
    pairs = [(a, b) for a in places for b in places if np.hypot(a[0] - b[0], a[1] - b[1]) >= APART]
    return pairs[::every]


def sweep(
    terrain: Dem, pairs: Sequence[tuple[PlanePoint, PlanePoint]], seeds: Sequence[int] = SEEDS
) -> list[TrialFlight]:
    """All trials."""
    exact = make_rules(terrain)
    sites = lift_to_veil(exact, np.array(sorted({place for pair in pairs for place in pair})))
    return [
        trial
        for name, veil, model in _graphs(exact, sites, seeds)
        for case in (*CASES, *OTHER_READINGS)
        for trial in _trials(name, sample_wind(veil, case.wind), case, make_vehicle(model), exact, pairs)
    ]


def _graphs(exact: Clearance, sites: np.ndarray, seeds: Sequence[int]) -> Iterator[tuple[str, PrmVeil, SpeedModel]]:
    uniform = lay_uniform(exact, sites)
    yield UNIFORM, uniform, "paper"
    yield "20 neighbours", lay_uniform(exact, sites, radius=TWENTY), "paper"
    yield "36 neighbours", lay_uniform(exact, sites, radius=THIRTY_SIX), "paper"
    yield "8, half the spacing", lay_uniform(exact, sites, spacing=SPACING / 2), "paper"
    yield "8, triangle", uniform, "triangle"
    for seed in seeds:
        yield PRM, lay_roadmap(exact, sites, seed), "paper"


def _trials(
    graph: str,
    wind_graph: WindGraph,
    case: PaperCase,
    vehicle: Vehicle,
    exact: Clearance,
    pairs: Sequence[tuple[PlanePoint, PlanePoint]],
) -> Iterator[TrialFlight]:
    for start, goal in pairs:
        flown = PaperCase(case.number, case.reading, case.wind, start, goal)
        try:
            routes = {choice: find_route(wind_graph, choice, flown, vehicle) for choice in _CHOICES}
        except NoRouteError:
            yield TrialFlight(flown, graph, {})
            continue
        trial = TrialFlight(flown, graph, routes, routes[TIME].seconds)
        if not time_wins_on_graph(trial):  # elsewhere shaping, which is never slower, cannot change the verdict
            trial = TrialFlight(flown, graph, routes, shape_route(routes[TIME], exact, case.wind, vehicle).seconds)
        yield trial


def frequency_table(trials: Sequence[TrialFlight]) -> Table:
    """In how many of the trials each effect holds, by case and graph."""
    graphs = tuple(dict.fromkeys(trial.graph for trial in trials))
    rows = []
    for group, belongs in _GROUPS:
        mine = [trial for trial in trials if belongs(trial) and trial.routes]
        for effect, holds in _EFFECTS:
            of = [[holds(trial) for trial in mine if trial.graph == graph] for graph in graphs]
            rows.append((group, effect, *(f"{sum(marks)}/{len(marks)}" for marks in of)))
            group = ""
    lost = sum(not trial.routes for trial in trials)
    return Table(
        "In how many flights each effect holds",
        ("case", "effect", *graphs),
        tuple(rows),
        f"{len(trials)} flights; {lost} of them, all on PRM graphs, have no route because the start or the goal has no"
        " neighbour."
        if lost
        else f"{len(trials)} flights.",
        words=2,
    )


def expansion_table(trials: Sequence[TrialFlight]) -> Table:
    """On how many of the flights the PRM graph needs fewer expansions than the uniform one, by cost."""
    uniform = {_flight(trial): trial for trial in trials if trial.graph == UNIFORM}
    both = [(trial, uniform[_flight(trial)]) for trial in trials if trial.graph == PRM and trial.routes]
    rows = []
    for choice in _CHOICES:
        counts = np.array([(a.routes[choice].expanded, b.routes[choice].expanded) for a, b in both])
        fewer = int(np.count_nonzero(counts[:, 0] < counts[:, 1]))
        share = np.median(counts[:, 0] / counts[:, 1])
        rows.append((str(choice), f"{fewer}/{len(both)}", f"{share:.2f}"))
    return Table(
        "Nodes expanded on PRM graphs, against the uniform graph",
        ("cost", "flights with fewer", "median ratio"),
        tuple(rows),
    )


def in_short(trials: Sequence[TrialFlight]) -> str:
    """In how many of all trials everything shows that the paper says of its case, in words."""
    parts = []
    for group, belongs in _GROUPS:
        marks = [as_printed(trial) for trial in trials if trial.routes and belongs(trial)]
        parts.append(f"{sum(marks)} of {len(marks)} in case {group}")
    return ", ".join(parts)


def defeats(trials: Sequence[TrialFlight]) -> list[str]:
    """Where the shaped route of `time` was beaten, in words."""
    return [
        f"{trial.case.title}, {trial.graph}, {trial.case.start} to {trial.case.goal}:"
        f" time {trial.shaped:.4f} s, best other {trial.best_other:.4f} s"
        for trial in trials
        if trial.routes and not time_wins(trial)
    ]


def _flight(trial: TrialFlight) -> tuple[str, PlanePoint, PlanePoint]:
    return trial.case.title, trial.case.start, trial.case.goal


def seed_table(terrain: Dem, seeds: Sequence[int]) -> Table:
    """On how many roadmaps the main choices show each effect."""
    exact, vehicle = make_rules(terrain), make_vehicle()
    sites = lift_to_veil(exact, np.array(sorted({place for case in CASES for place in (case.start, case.goal)})))
    trials: list[TrialFlight] = []
    for seed in seeds:
        veil = lay_roadmap(exact, sites, seed)
        for case in CASES:
            trials += _trials(PRM, sample_wind(veil, case.wind), case, vehicle, exact, [(case.start, case.goal)])
    rows = []
    for case in CASES:
        mine = [trial for trial in trials if trial.case == case and trial.routes]
        tests = (ANGLE_LOSES if case.number == "2" else ANGLE_WINS, HYBRID_WINS, as_printed, time_wins)
        rows.append((case.title, *(f"{sum(map(test, mine))}/{len(mine)}" for test in tests)))
    return Table(
        "The main starts and goals on other roadmaps",
        ("case", "Table 1's order", "hybrid beats distance", "all", "time, shaped, beats or equals all"),
        tuple(rows),
        f"Seeds {seeds[0]} to {seeds[-1]}; a start or goal without a neighbour leaves a roadmap out.",
    )

"""Tables 1 and 2: the flight times of the main choices beside the printed ones, on each graph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gcs_windplan.paper.cases import CASES, NEAR_THE_DIGITS, OTHER_READINGS, PaperCase, make_rules, make_vehicle
from gcs_windplan.paper.flying import SHAPED, Route, fly_case, seconds_on_the_slope, sites_of
from gcs_windplan.paper.graphs import lay_roadmap, lay_uniform
from gcs_windplan.paper.published import ANGLE, COSTS, DISTANCE, HYBRID, TABLE_1, TABLE_2, TIME, printed_seconds
from gcs_windplan.paper.sampled import SampledTest
from gcs_windplan.paper.tables import Table, in_seconds
from gcs_windplan.planning.cost import CostChoice
from gcs_windplan.planning.veil import PrmVeil
from gcs_windplan.terrain import Dem
from gcs_windplan.vehicle import SpeedModel

Routes = dict[str, Route]


@dataclass(frozen=True, slots=True, eq=False)
class Setup:
    """A way to fly the cases: graph, collision test and speed model, with the routes of each case by its title."""

    name: str
    veil: PrmVeil
    model: SpeedModel
    routes: dict[str, Routes]


def fly_setups(terrain: Dem) -> tuple[Setup, ...]:
    """The main setup first (uniform, exact test, the paper's speeds); then one thing changed at a time."""
    exact, sampled = make_rules(terrain), make_rules(terrain, SampledTest())
    cases = (*CASES, *OTHER_READINGS, *NEAR_THE_DIGITS)
    sites = sites_of(exact, CASES)
    uniform = lay_uniform(exact, sites)
    ways: tuple[tuple[str, PrmVeil, SpeedModel], ...] = (
        ("uniform", uniform, "paper"),
        ("uniform, sampled test", lay_uniform(sampled, sites), "paper"),
        ("uniform, triangle", uniform, "triangle"),
        ("PRM", lay_roadmap(exact, sites), "paper"),
        ("PRM, sampled test", lay_roadmap(sampled, sites), "paper"),
        ("PRM, triangle", lay_roadmap(exact, sites), "triangle"),
    )
    setups = []
    for name, veil, model in ways:
        chosen = cases if name == "uniform" else CASES
        routes = {}
        for case in chosen:
            on = lay_uniform(exact, sites_of(exact, [case])) if case in NEAR_THE_DIGITS else veil
            routes[key_of(case)] = fly_case(case, on, make_vehicle(model), exact)
        setups.append(Setup(name, veil, model, routes))
    return tuple(setups)


def key_of(case: PaperCase) -> str:
    """A case with its way, as several cases share a title."""
    return f"{case.title}, ({case.start[0]:g}, {case.start[1]:g}) to ({case.goal[0]:g}, {case.goal[1]:g})"


def table_1(setups: Sequence[Setup]) -> Table:
    """Least distance and least angle by case, as printed and on each setup."""
    rows = []
    for case in CASES:
        printed = TABLE_1[case.number]
        rows.append((key_of(case), "the paper", f"{printed[0]:.2f}", f"{printed[1]:.2f}", _change(*printed), "–", "–"))
        rows += [("", setup.name, *_row_of(setup.routes[key_of(case)])) for setup in setups]
    return Table(
        "Table 1. Flight time [s] of the paths of least distance and of least angle",
        ("case", "graph, test, speeds", "distance", "angle", "angle against distance", "time", "time, shaped"),
        tuple(rows),
        "`time` is the cost of this package, `time, shaped` its route after its waypoints have moved off the graph.",
        words=2,
    )


def table_1_other(main: Setup) -> Table:
    """Case 1 with the other readings of (14), and where it comes near the printed digits."""
    rows = [("the paper", *(f"{t:.2f}" for t in TABLE_1["1"]), "2.15", _change(*TABLE_1["1"]), "–")]
    for case in (*OTHER_READINGS, *NEAR_THE_DIGITS):
        routes = main.routes[key_of(case)]
        distance, angle, change, _, shaped = _row_of(routes)
        rows.append((key_of(case), distance, angle, in_seconds(routes[str(HYBRID)].seconds), change, shaped))
    return Table(
        "Case 1 read otherwise, and where it comes near the digits [s]",
        ("case", "distance", "angle", "hybrid 0.1/0.9", "angle against distance", "time, shaped"),
        tuple(rows),
        "The last two were found by a sweep over starts and goals.",
    )


def table_2(setups: Sequence[Setup]) -> Table:
    """Every row of Table 2 on each setup."""
    rows = []
    for number, distance, angle, printed in TABLE_2:
        case = next(case for case in CASES if case.number == number)
        name = str(CostChoice("hybrid", distance, angle))
        times = [in_seconds(setup.routes[key_of(case)][name].seconds) for setup in setups]
        rows.append((number, f"{distance:g}", f"{angle:g}", f"{printed:.2f}", *times))
    return Table(
        "Table 2. Flight time [s] of the hybrid cost",
        ("case", "distance weight", "angle weight", "the paper", *(setup.name for setup in setups)),
        tuple(rows),
    )


def digits(main: Setup) -> str:
    """By how much the main choices differ from the printed numbers, in words."""
    apart = [
        (abs(main.routes[key_of(case)][str(choice)].seconds / printed - 1), case)
        for case in CASES
        for choice in COSTS
        if (printed := printed_seconds(case.number, choice)) is not None
    ]
    worst = {case.title: max(off for off, other in apart if other is case) for case in CASES}
    return ", ".join(f"{title} by up to {100 * off:.0f} %" for title, off in worst.items())


def slope_effect(setups: Sequence[Setup]) -> float:
    """By how much the flight times grow at most if each leg is as long as its slope."""
    ratios = [
        seconds_on_the_slope(route.points, case.wind, make_vehicle(setup.model)) / route.seconds
        for setup in setups
        for case in CASES
        for route in setup.routes[key_of(case)].values()
    ]
    return max(ratios) - 1


def order_holds(case: PaperCase, routes: Routes) -> dict[str, bool]:
    """Which of the paper's effects the routes of a case show."""
    seconds = {name: route.seconds for name, route in routes.items()}
    angle, distance, hybrid = (seconds[str(choice)] for choice in (ANGLE, DISTANCE, HYBRID))
    best = seconds.get(SHAPED, seconds[str(TIME)])
    others = [value for name, value in seconds.items() if name not in (SHAPED, str(TIME))]
    return {
        "angle": angle > distance if case.number == "2" else angle < distance,
        "hybrid": hybrid < distance,
        "time": best <= min(others) * (1 + 1e-9),
    }


def _row_of(routes: Routes) -> tuple[str, str, str, str, str]:
    distance, angle = routes[str(DISTANCE)].seconds, routes[str(ANGLE)].seconds
    return (
        in_seconds(distance),
        in_seconds(angle),
        _change(distance, angle),
        in_seconds(routes[str(TIME)].seconds),
        in_seconds(routes[SHAPED].seconds),
    )


def _change(before: float, after: float) -> str:
    return f"{100 * (after / before - 1):+.0f} %"

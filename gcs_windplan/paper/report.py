"""The summary in Markdown: choices, tables, figures, what agrees with the paper and what does not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gcs_windplan.paper.cases import AIRSPEED, CASES, HILLS, VEIL_HEIGHT, make_rules
from gcs_windplan.paper.comparison import Setup, digits, key_of, order_holds, slope_effect
from gcs_windplan.paper.flying import sites_of
from gcs_windplan.paper.frequency import APART, PLACES, TrialFlight, defeats, in_short
from gcs_windplan.paper.graphs import EIGHT, ROADMAP, SEED, SPACING, lay_uniform
from gcs_windplan.paper.published import PAPER
from gcs_windplan.paper.sampled import SampledTest
from gcs_windplan.paper.tables import Table
from gcs_windplan.terrain import Dem

FIGURES: Final = ("figure_3.png", "figure_6.png", "figure_7.png")

_HEAD: Final = f"""\
# The paper, reproduced

*{PAPER}*: A* over a veil of nodes above the ground, in three artificial wind fields on the plane x, y in [-2, 2], with
airspeed {AIRSPEED:g} and wind 1. Lengths are in the paper's mesh resolutions (mr), times in s. Everything here is
simulated, as it is there.

What the paper does not publish cannot be reproduced to the digit: terrain, starts, goals, the radius of neighbours and
the number of nodes are chosen here. What can be compared is the order and the size of the effects.
"""

_ODDITIES: Final = """\
## Oddities of the print, and how they are read

- (4) compares a squared distance with r_s; read r_s².
- (5) selects triangles inside of the box of the two nodes, assumes that the first one has the smaller coordinates, and
  misses triangles larger than the box; read: boxes that overlap. (8) compares areas at sampled points; equality of
  floating-point areas needs a tolerance, and a leg can pass through a surface between two samples.
- (10) takes an arctan, which cannot tell an angle from its supplement; read atan2. It is counted once an edge, so
  long edges are cheap. Its heuristic, a mean angle, is no lower bound of a sum of angles: A* with it is not optimal. In
  still air there is no angle; it is taken as 90°, which neither helps nor hinders.
- (11) divides by min(h_d, d(start, goal)), but only the max keeps the term in [0, 1] as the text wants. The sum of
  angles divided by π does not stay in [0, 1] either; it is taken as printed, so that over many edges the angle
  outweighs the distance at nearly all weights. In (11) w1 belongs to the angle and w2 to the distance, while the
  text on Table 2 takes them the other way round (w2 = 1 is the minimum angle there); here the weights are named.
- (12) counters cross wind for free. The exact wind triangle stands beside it.
- (14) as printed is a unit wind where |y| < 1, while the text speaks of a varied magnitude; both are flown, and so is
  the formula taken literally on the whole plane, where it blows backwards outside of |y| < 1.
- The caption of Figure 6 names case 3 twice; its middle panel is case 2 here.
"""

_OFTEN: Final = f"""\
## How often

One picked example proves little, so here are all starts and goals on a grid (x and y one of
{", ".join(f"{place:g}" for place in PLACES)}) that lie at least {APART:g} mr apart, flown by distance, angle, hybrid
with distance 0.9 and angle 0.1 and with 0.1 and 0.9, and time, on graphs with different neighbours. Where paths tie in
distance, and on a square grid most do, their flight times differ; which one the search returns is chance.
"""

_PROCESSING: Final = """\
## Processing time

With the same radius of neighbours the PRM graph is searched faster, about as much as it has fewer nodes. The paper's
factor of 3.5 does not show, and against a uniform graph with 8 neighbours, which random places cannot do with, little
is left of it but in `angle`. Least angle takes several times as long as least distance, as in the paper: it expands
nearly all nodes, and its heuristic samples the wind on the way to the goal.
"""


def write_report(terrain: Dem, setups: Sequence[Setup], tables: dict[str, Table], trials: Sequence[TrialFlight]) -> str:
    """The whole report. `tables` by name: table_1, table_1_other, table_2, processing, frequency, seeds, expansion."""
    parts = [
        _HEAD,
        _choices(terrain),
        f"![Terrain with uniform and random nodes]({FIGURES[0]})\n\n*Figure 3. The terrain, the nodes of both graphs,"
        " start and goal of case 1.*\n",
        "## Flight times\n",
        tables["table_1"].markdown(),
        f"![Routes in the three cases]({FIGURES[1]})\n\n*Figure 6. Least distance (orange) and least angle (green,"
        " dashed) on the uniform graph, and least time after shaping (blue, dotted).*\n",
        tables["table_1_other"].markdown(),
        tables["table_2"].markdown(),
        f"![Hybrid routes]({FIGURES[2]})\n\n*Figure 7. The hybrid cost in case 2 with either weight the larger one.*\n",
        _verdict(setups),
        _OFTEN,
        tables["frequency"].markdown(),
        _counted(trials),
        tables["seeds"].markdown(),
        _PROCESSING,
        tables["processing"].markdown(),
        tables["expansion"].markdown(),
        _ODDITIES,
    ]
    return "\n".join(parts)


def _choices(terrain: Dem) -> str:
    """What was chosen."""
    rules = make_rules(terrain)
    uniform = lay_uniform(rules, sites_of(rules, CASES))
    starts, ends = uniform.points[uniform.pairs[:, 0]], uniform.points[uniform.pairs[:, 1]]
    exact = uniform.flags != 0
    sampled = make_rules(terrain, SampledTest()).breaches(starts, ends) != 0
    ways = "; ".join(key_of(case) for case in CASES)
    return f"""\
## Choices

- **Terrain**: {len(HILLS)} Gaussian hills up to {max(hill.height for hill in HILLS):g} mr high, four of them steep; the
  veil lies {VEIL_HEIGHT:g} mr above it.
- **Ways**: {ways}. Case 1 begins in the jet and flies east, so that the wind never hinders; those of cases 2 and 3 come
  from a sweep for the paper's effects near its digits.
- **Graphs**: uniform with a spacing of {SPACING:g} mr and r_s of {EIGHT * SPACING:.2f} mr (the 8 nodes around); PRM
  with three quarters of the nodes and r_s of {ROADMAP * SPACING:.2f} mr, as random places need more neighbours to be
  connected. Its seed, {SEED}, was picked among 160 for showing Table 1's order in all cases; other seeds stand below.
- **Collision**: a leg must not touch the ground. Of {len(uniform.pairs)} legs of the uniform graph the exact test
  rejects {int(exact.sum())}, the paper's sampled test {int(sampled.sum())}: {int((exact & ~sampled).sum())} pass
  through the ground unseen.
- **Times** follow (13) with the wind integrated along each leg, in (12), the paper's speed model, unless `triangle` is
  named. The paper shapes no path, so neither is any here but that of `time`, where it says so. Speeds are level: a leg
  is as long as its plan, and climbs no faster than {AIRSPEED:g} mr/s.
"""


def _verdict(setups: Sequence[Setup]) -> str:
    """What agrees and what does not, said from the numbers."""
    lines = ["## What agrees, and what does not\n"]
    for setup in setups:
        held = {case.title: order_holds(case, setup.routes[key_of(case)]) for case in CASES}
        missed = [f"{title}: {effect}" for title, effects in held.items() for effect, ok in effects.items() if not ok]
        lines.append(
            f"- {setup.name}: " + ("every effect shows." if not missed else "missing " + ", ".join(missed) + ".")
        )
    lines += [
        "",
        "Effects: *angle* beats distance in cases 1 and 3 and loses in case 2; *hybrid* 0.1/0.9 beats distance; *time*,"
        f" shaped, beats or equals all. Starts and goals were chosen so that the effects show on the uniform graph;"
        f" the counts below were not chosen. On the uniform graph the flight times differ from the printed ones:"
        f" {digits(setups[0])}.",
        "",
        "The digits of case 1 do not fit an eastward flight in a jet with still air beside it: still air is the slowest"
        " there, 3.11 s in it are 6.2 mr, and the plane's diagonal is 5.7. They fit (14) taken literally, with head"
        " wind outside of |y| < 1, or a flight against the jet; see the table of other readings.",
        "",
        f"With each leg as long as its slope, as (13) has it, the times grow by at most"
        f" {100 * slope_effect(setups):.1f} %.",
        "",
    ]
    return "\n".join(lines)


def _counted(trials: Sequence[TrialFlight]) -> str:
    """What the counts say, and where `time` was beaten, if anywhere."""
    found = defeats(trials)
    beaten = "is beaten in none of these flights." if not found else "is beaten in:\n"
    lines = [
        f"All that the paper says of its case shows in {in_short(trials)}, on all graphs together. So the paper's"
        " examples are no rule: a path of least angle often goes a long way round, and least distance is the faster"
        " one.",
        "",
        "On the graph `time` can lose where the wind jumps: an edge's time there is the mean of those in the winds at"
        f" its two ends, and the jump may lie anywhere between. The shaped route {beaten}",
        *(f"- {line}" for line in found),
        "",
    ]
    return "\n".join(lines)

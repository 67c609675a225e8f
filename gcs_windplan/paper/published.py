"""The numbers printed in the paper: "A spatially wind aware quadcopter (UAV) path planning approach", Tables 1 to 4."""

from __future__ import annotations

from typing import Final

from gcs_windplan.planning.cost import CostChoice

PAPER: Final = "A spatially wind aware quadcopter (UAV) path planning approach"

#: Table 1: flight time [s] of least distance and of least angle, by case.
TABLE_1: Final = {"1": (3.11, 2.30), "2": (3.06, 3.63), "3": (4.16, 2.51)}

#: Table 2: case, distance weight, angle weight, flight time [s], in the printed order.
TABLE_2: Final = (
    ("2", 0.9, 0.1, 3.06),
    ("2", 0.6, 0.4, 3.02),
    ("2", 0.4, 0.6, 2.95),
    ("2", 0.1, 0.9, 2.95),
    ("1", 0.1, 0.9, 2.15),
    ("3", 0.1, 0.9, 2.56),
)

#: Tables 3 and 4: processing time [s] on the uniform graph and on the PRM graph, by cost (MATLAB, one core, 3.5 GHz).
TABLES_3_4: Final = {"distance": (0.51, 0.15), "angle": (1.07, 0.30)}

DISTANCE: Final = CostChoice("distance")
ANGLE: Final = CostChoice("angle")
TIME: Final = CostChoice("time")
HYBRID: Final = CostChoice("hybrid", distance=0.1, angle=0.9)

#: Every cost that the paper flies, and `time`.
COSTS: Final = (
    DISTANCE,
    ANGLE,
    CostChoice("hybrid", distance=0.9, angle=0.1),
    CostChoice("hybrid", distance=0.6, angle=0.4),
    CostChoice("hybrid", distance=0.4, angle=0.6),
    HYBRID,
    TIME,
)


def printed_seconds(case: str, choice: CostChoice) -> float | None:
    """The flight time [s] that the paper prints for a case and a cost, if it does."""
    if choice == DISTANCE:
        return TABLE_1[case][0]
    if choice == ANGLE:
        return TABLE_1[case][1]
    for row, distance, angle, seconds in TABLE_2:
        if choice == CostChoice("hybrid", distance, angle) and row == case:
            return seconds
    return None

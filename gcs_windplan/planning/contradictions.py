"""What a mission's numbers say against each other, as far as no terrain is needed to tell.

Asked twice: of a mission file's values, with line and column, and of the planner's request. A number that is None is
not known, and nothing is said of it. Nothing heavy is imported here: a mission file's errors must not wait.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

from gcs_windplan.errors import Problem

MOST_TO_ORDER: Final = 12  # vias; each more takes twice as long, and as much memory
_SLACK: Final = 1e-6  # [m]


def height_problems(
    clearance: float | None, max_height: float | None, layers: Sequence[float | None]
) -> Iterator[Problem]:
    """Clearance, height limit and layers above ground [m] that do not go together."""
    if clearance is not None and max_height is not None and clearance > max_height:
        text = f"{max_height:g} m is below the clearance of {clearance:g} m; raise one, lower the other"
        yield Problem(text, "limits.max_height")
    else:
        for i, layer in enumerate(layers):
            if layer is not None and (complaint := outside_limits(layer, clearance, max_height)):
                yield Problem(complaint, f"graph.layers.{i}")
    for i, (below, above) in enumerate(pairwise(layers), start=1):
        if below is not None and above is not None and above <= below:
            yield Problem(f"layers go upwards: {above:g} m is not above {below:g} m", f"graph.layers.{i}")


def outside_limits(height: float, clearance: float | None, max_height: float | None) -> str | None:
    """What to say of a height above ground [m] that no leg may have."""
    if clearance is not None and height < clearance - _SLACK:
        return f"{height:g} m is below the clearance of {clearance:g} m that every leg keeps"
    if max_height is not None and height > max_height + _SLACK:
        return f"{height:g} m is above limits.max_height, {max_height:g} m"
    return None


def too_many_to_order(count: int) -> Iterator[Problem]:
    """More vias than can be put in order."""
    if count > MOST_TO_ORDER:
        text = f"{count} places are more than the {MOST_TO_ORDER} that can be put in order; give the order"
        yield Problem(text, "order")


def limits_without_airframe(*, battery: bool, reserve: bool, airframe: bool) -> Iterator[Problem]:
    """Limits of a battery of which nothing is known."""
    text = "needs vehicle.airframe, which says what the battery holds and what flying takes"
    for name, given in (("battery", battery), ("reserve", reserve)):
        if given and not airframe:
            yield Problem(text, f"limits.{name}")

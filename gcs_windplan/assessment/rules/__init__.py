"""The rules that a mission is held against; each yields what breaks it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.rules.areas import areas
from gcs_windplan.assessment.rules.battery import battery
from gcs_windplan.assessment.rules.ends import ending, first_leg, home, landing
from gcs_windplan.assessment.rules.firmware import firmware
from gcs_windplan.assessment.rules.ground import circles, clearance, ground, height, obstacles
from gcs_windplan.assessment.rules.places import Found
from gcs_windplan.assessment.rules.returns import returns
from gcs_windplan.assessment.rules.speeds import airspeed, flyable, flyable_in_members, gradient, stall
from gcs_windplan.assessment.rules.wind import forecast, gust, wind

RULES: tuple[Callable[[AssessedMission], Iterator[Found]], ...] = (
    home,
    first_leg,
    ground,
    clearance,
    circles,
    height,
    obstacles,
    areas,
    forecast,
    wind,
    gust,
    flyable,
    flyable_in_members,
    airspeed,
    stall,
    gradient,
    landing,
    ending,
    battery,
    returns,
    firmware,
)

__all__ = ["RULES"]

"""A judged mission's legs as CSV (RFC 4180): a header with units, a row for each leg."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from gcs_windplan.formats.geojson import on_earth

if TYPE_CHECKING:
    from gcs_windplan.assessment import AssessedLeg, Assessment, Stop

_Cell: TypeAlias = "Callable[[AssessedLeg, Stop], float | int | str | None]"

_COLUMNS: Final[tuple[tuple[str, int, _Cell], ...]] = (
    ("leg", 0, lambda leg, to: leg.number),
    ("to item", 0, lambda leg, to: leg.item),
    ("to", 0, lambda leg, to: to.label),
    ("to latitude [deg]", 7, lambda leg, to: on_earth(to.longitude_deg, to.latitude_deg)[1]),
    ("to longitude [deg]", 7, lambda leg, to: on_earth(to.longitude_deg, to.latitude_deg)[0]),
    ("to altitude [m AMSL]", 2, lambda leg, to: to.altitude),
    ("to height [m AGL]", 2, lambda leg, to: to.above_ground),
    ("arrival [s]", 1, lambda leg, to: to.seconds),
    ("hold [s]", 1, lambda leg, to: to.hold),
    ("track [deg true]", 1, lambda leg, to: leg.track_deg),
    ("heading [deg true]", 1, lambda leg, to: leg.heading_deg),
    ("level length [m]", 1, lambda leg, to: leg.distance),
    ("length [m]", 1, lambda leg, to: leg.length),
    ("climb [m]", 2, lambda leg, to: leg.climb),
    ("gradient [%]", 1, lambda leg, to: 100 * leg.gradient),
    ("ground speed [m/s]", 2, lambda leg, to: leg.ground_speed),
    ("airspeed [m/s]", 2, lambda leg, to: leg.airspeed),
    ("wind from behind [m/s]", 2, lambda leg, to: leg.wind_along),
    ("wind from the left [m/s]", 2, lambda leg, to: leg.wind_across),
    ("time [s]", 1, lambda leg, to: leg.seconds),
    ("lowest [m AGL]", 2, lambda leg, to: leg.clearance),
    ("highest [m AGL]", 2, lambda leg, to: leg.height),
    ("energy [Wh]", 3, lambda leg, to: None if leg.energy is None else leg.energy / 3600),
    ("battery left [%]", 1, lambda leg, to: None if to.left is None else 100 * to.left),
)


def format_legs_csv(assessment: Assessment) -> str:
    """The legs, lines ended by CR LF; a cell is empty where its figure is not known, `never` where it is infinite."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow([name for name, _, _ in _COLUMNS])
    for leg in assessment.legs:
        to = assessment.stops[leg.number]
        writer.writerow([_written(cell(leg, to), digits) for _, digits, cell in _COLUMNS])
    return text.getvalue()


def _written(value: float | str | None, digits: int) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if isinstance(value, float):
        return f"{value:.{digits}f}" if math.isfinite(value) else "never"
    return str(value)

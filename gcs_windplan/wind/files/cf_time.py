"""When the values of a NetCDF file hold: CF times, leads of forecasts, the times that WRF writes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import netCDF4
import numpy as np
import numpy.typing as npt

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.units import PERIOD, unit_factor

_CALENDARS = ("", "standard", "gregorian", "proleptic_gregorian")


@dataclass(frozen=True, slots=True, eq=False)
class Coordinate:
    """Values along dimensions; without any, one value for all."""

    dimensions: tuple[str, ...]
    values: FloatArray

    def at(self, place: dict[str, int]) -> float:
        """The value at a place, a number for each dimension."""
        return float(self.values[tuple(place[dimension] for dimension in self.dimensions)])


def moments(variable: Variable, values: FloatArray) -> FloatArray:
    """UTC seconds since 1970 of the values of a time coordinate, to the millisecond.

    Raises `WindError` for calendars other than ours, and units that cannot be read.
    """
    calendar, units = variable.text("calendar"), _padded(variable)
    if calendar not in _CALENDARS:
        raise WindError(
            f"the times {variable.name} are in the calendar {calendar}, which is no calendar of real days: such a file"
            " is a climate model's and no forecast; if it is one, convert it with `cdo setcalendar,standard`"
        )
    try:
        dates: Any = netCDF4.num2date(values.ravel(), units, calendar or "standard")
    except (ValueError, OverflowError) as error:
        raise WindError(f"the times {variable.name} ({units}) cannot be read: {error}") from error
    seconds = np.array([_seconds(date) for date in dates])
    return np.round(seconds, 3).reshape(values.shape)


def spans(variable: Variable, values: FloatArray) -> FloatArray:
    """Seconds since the run began of the values of a forecast period. Raises `WindError` for unknown units."""
    return np.round(values * unit_factor(variable.name, variable.raw_text("units"), PERIOD), 3)


def written(characters: npt.NDArray[np.bytes_]) -> FloatArray:
    """UTC seconds since 1970 of WRF's `Times`, (n, 19) letters. Raises `WindError` if they are none."""
    texts = [b"".join(row).decode("latin-1").strip("\0 ") for row in characters.reshape(-1, characters.shape[-1])]
    try:
        moments = [datetime.strptime(text, "%Y-%m-%d_%H:%M:%S").replace(tzinfo=UTC) for text in texts]
    except ValueError as error:
        raise WindError(f"its `Times` cannot be read: {error}") from error
    return np.array([moment.timestamp() for moment in moments])


def _padded(variable: Variable) -> str:
    """The units with a time zone of two digits: cftime passes over the ` -6:00` of CF section 4.4 as if it were UTC.

    Raises `WindError` for a zone by any name but UTC.
    """
    units = re.sub(r"([ :0-9][+-])(\d)(:\d\d)?$", r"\g<1>0\2\3", variable.raw_text("units"))
    zone = re.search(r"since.*\d\s*([a-z][a-z/_]*)$", units, re.IGNORECASE)
    if zone and zone[1].upper() not in ("Z", "UTC", "GMT"):
        raise WindError(f"the times {variable.name} ({units}) are in the zone {zone[1]!r}: convert them to UTC")
    return units


def _seconds(date: Any) -> float:
    """Seconds since 1970 of what `num2date` makes, which is no datetime for every year."""
    day, clock = (date.year, date.month, date.day), (date.hour, date.minute, date.second, date.microsecond)
    return datetime(*day, *clock, tzinfo=UTC).timestamp()

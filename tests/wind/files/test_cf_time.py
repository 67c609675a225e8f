"""Times of NetCDF files."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import netCDF4
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.cf_time import Coordinate, moments, spans, written

ONE_MILLISECOND = 1e-3


def _time(units: str, calendar: str = "") -> Variable:
    return Variable("time", ("time",), (1,), {"units": units, "calendar": calendar})


def _moment(units: str, value: float, calendar: str = "") -> datetime:
    return datetime.fromtimestamp(moments(_time(units, calendar), np.array([value]))[0], UTC)


@pytest.mark.parametrize(
    ("units", "value", "expected"),
    [
        ("hours since 1900-01-01 00:00:00.0", 1052712, "2020-02-04T00:00:00"),
        ("seconds since 1970-01-01", 1582473600, "2020-02-23T16:00:00"),
        ("Hour since 2017-05-21T00:00:00Z", 330, "2017-06-03T18:00:00"),
        ("days since 2026-05-01 12:00:00 UTC", 0.5, "2026-05-02T00:00:00"),
        ("minutes since 2026-05-01 12:00:00 GMT", 30, "2026-05-01T12:30:00"),
        ("hours since 2026-05-01 12:00:00 +02:00", 1, "2026-05-01T11:00:00"),
        ("hours since 2026-05-01 12:00 -6:00", 1, "2026-05-01T19:00:00"),
        ("seconds since 1992-10-8 15:15:42.5 -6:00", 0.5, "1992-10-08T21:15:43"),
        ("hours since 2026-05-01 12:00 -6", 1, "2026-05-01T19:00:00"),
        ("hours since 1-1-1 00:00:00", 17756400, "2026-08-21T00:00:00"),
    ],
)
def test_times_become_utc(units: str, value: float, expected: str) -> None:
    """The one with -6:00 is CF's own example (section 4.4): cftime by itself takes it for UTC.

    The last one counts as the standard calendar does, with Julian days before 1582.
    """
    assert _moment(units, value).replace(tzinfo=None).isoformat() == expected


@given(st.datetimes(datetime(1950, 1, 1), datetime(2100, 1, 1)), st.sampled_from(["days", "hours", "seconds"]))
def test_what_netcdf4_writes_is_read_to_the_millisecond(moment: datetime, unit: str) -> None:
    units = f"{unit} since 1900-01-01"
    value = float(netCDF4.date2num(moment, units))
    assert abs(_moment(units, value) - moment.replace(tzinfo=UTC)) <= timedelta(milliseconds=1)


@pytest.mark.parametrize("calendar", ["standard", "gregorian", "proleptic_gregorian", "GREGORIAN", ""])
def test_real_calendars(calendar: str) -> None:
    assert _moment("hours since 2026-05-01", 0, calendar) == datetime(2026, 5, 1, tzinfo=UTC)


@pytest.mark.parametrize(
    ("units", "calendar", "message"),
    [
        ("hours since 2026-05-01", "noleap", "calendar noleap, which is no calendar of real days"),
        ("hours since 2026-05-01", "360_day", "calendar 360_day"),
        ("hours since 2026-05-01 00:00 CEST", "", "in the zone 'CEST': convert them to UTC"),
        ("months since 2026-05-01", "", r"the times time \(months since 2026-05-01\) cannot be read"),
        ("hours since yesterday", "", "cannot be read"),
        ("hours", "", "cannot be read"),
    ],
)
def test_times_that_cannot_be_told_are_errors(units: str, calendar: str, message: str) -> None:
    with pytest.raises(WindError, match=message):
        _moment(units, 1, calendar)


@pytest.mark.parametrize(("units", "seconds"), [("hours", 3600), ("h", 3600), ("minutes", 60), ("days", 86400)])
def test_leads_become_seconds(units: str, seconds: float) -> None:
    assert spans(_time(units), np.array([2.0])) == [2 * seconds]
    with pytest.raises(WindError, match="is not a span of time"):
        spans(_time("km"), np.array([2.0]))


def test_text_that_is_no_time_is_an_error() -> None:
    with pytest.raises(WindError, match="its `Times` cannot be read"):
        written(np.array([list("noon")], dtype="S1"))


def test_a_coordinate_without_dimensions_is_one_value_for_all() -> None:
    assert Coordinate((), np.array(3.0)).at({"x": 7}) == 3.0
    assert Coordinate(("b", "a"), np.arange(6.0).reshape(2, 3)).at({"a": 2, "b": 1, "x": 7}) == 5.0

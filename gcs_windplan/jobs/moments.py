"""Times and steps as people write them: `2026-05-01T06:00Z`, `06:00` on a known day, `30min`."""

from __future__ import annotations

import re
from datetime import datetime, timedelta
from typing import Final

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.jobs.missionfile.values import Moment
from gcs_windplan.jobs.words import Naming, read_as
from gcs_windplan.planning.departures import moments_between

_DAY: Final = 24 * 3600.0  # [s]
_LONGEST_STEP: Final = 30 * _DAY
_CLOCK: Final = re.compile(r"([01]?\d|2[0-3]):([0-5]\d)Z?")
_STEPS: Final = {"s": 1.0, "sec": 1.0, "min": 60.0, "m": 60.0, "h": 3600.0}


def moments_of(
    first: datetime | str, last: datetime | str, every: timedelta | str, day: datetime | None, named: Naming = str
) -> list[datetime]:
    """The departures from the first to the last; a time of day is on `day`, the last perhaps on the next one.

    Raises `InputError`.
    """
    begin = read_as(named("first"), lambda: read_moment(first, day))
    end = read_as(named("last"), lambda: read_moment(last, day if day is None else begin))
    step = every if isinstance(every, timedelta) else read_as(named("every"), lambda: read_step(every))
    if end < begin and isinstance(last, str) and _CLOCK.fullmatch(last.strip()) and end.year < 9999:
        end += timedelta(days=1)
    if end < begin:
        text = f"{end:%Y-%m-%d %H:%M} UTC lies before {named('first')}, {begin:%Y-%m-%d %H:%M} UTC"
        raise InputError(Problem(text, named("last")))
    return moments_between(begin, end, step)


def read_moment(text: datetime | str, day: datetime | None) -> datetime:
    """A time of day in UTC on a day, or a date and time with its offset. Raises `ValueError`."""
    clock = _CLOCK.fullmatch(text.strip()) if isinstance(text, str) else None
    if clock is not None:
        if day is None:
            raise ValueError("the mission has no departure, so the day is not known; write 2026-05-01T06:00Z")
        return day.replace(hour=int(clock[1]), minute=int(clock[2]), second=0, microsecond=0)
    try:
        return Moment().read(text)
    except ValueError as error:
        raise ValueError(f"{error}, or a time of day in UTC such as 06:00") from None


def read_step(text: str) -> timedelta:
    """The time between two departures, at least 1 s and at most 30 days. Raises `ValueError`."""
    found = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([a-z]+)", text.strip().lower())
    seconds = float(found[1]) * _STEPS[found[2]] if found is not None and found[2] in _STEPS else 0.0
    if not 1.0 <= seconds <= _LONGEST_STEP:
        raise ValueError(f"{text!r} is no step; write for example 30min, 1h or 600s")
    return timedelta(seconds=seconds)

"""What every grammar of words shares: names that may be written, and errors with the name of what was asked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal, TypeAlias, TypeVar

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.mission.firmware import autopilots

_T = TypeVar("_T")

#: The kinds of vehicles: `vehicle.VehicleType`, here without what is heavy beside that.
VehicleKind: TypeAlias = Literal["multicopter", "fixed-wing"]

#: The names of the firmwares that there are, which a file more beside theirs makes one more.
if TYPE_CHECKING:
    AutopilotName: TypeAlias = str
else:
    AutopilotName = Literal[autopilots()]

#: What of a mission travels.
Kinds: TypeAlias = Literal["mission", "fence", "rally", "all"]

#: How a face calls what it is asked: `max_gust` in Python, `--max-gust` on the command line.
Naming: TypeAlias = Callable[[str], str]


def read_as(field: str | None, read: Callable[[], _T]) -> _T:
    """What `read` gives; its `ValueError` becomes an `InputError` of the field."""
    try:
        return read()
    except ValueError as error:
        raise InputError(Problem(str(error), field)) from None

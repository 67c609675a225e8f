"""The tree of errors. Each message says what happened, where, and what to do next.

WindplanError
├── InputError            something handed in cannot be used: exit code 2
│   ├── MissionFileError  the YAML mission file, every problem at once
│   ├── TerrainError      a DEM or mesh that cannot be read or does not cover the place
│   ├── WindError         a wind that cannot be read, has gaps or does not cover the place
│   ├── FormatError       a .waypoints or .plan file
│   ├── AddressError      a link's address that is wrong or in use
│   └── RequestError      sites, limits and terrain contradict each other, every problem at once
├── NoRouteError          all input is fine and yet no route exists: exit code 1
│   └── BatteryError      the best route takes more than the battery may give
├── LinkError             the link is dead or nobody answers, so that what the vehicle holds is unknown: exit code 4
│   └── RefusedError      the vehicle said no: exit code 3
└── CancelledError        whoever started the work told it to stop
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, Self, TypeAlias

#: Why a wind is not known.
WindReason: TypeAlias = Literal["area", "time", "members"]


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong, and where.

    `field` is the dotted path of the mission file's field (`vehicle.airspeed`, `via.0`); `file`, `line` and `column`
    (both counted from 1) say where it stands, as far as that is known.

    >>> import gcs_windplan as gw
    >>> print(gw.Problem("is missing", "vehicle.airspeed", line=4))
    4: vehicle.airspeed: is missing
    """

    message: str
    field: str | None = None
    file: Path | None = None
    line: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        place = [str(part) for part in (self.file, self.line, self.column) if part is not None]
        head = ":".join(place)
        return ": ".join(part for part in (head, self.field, self.message) if part)


class WindplanError(Exception):
    """Anything that this package raises on purpose."""


class InputError(WindplanError):
    """Something handed in cannot be used.

    Holds `problems`, one or more; the message lists them, a line each.
    """

    def __init__(self, problems: str | Problem | Sequence[Problem]) -> None:
        if isinstance(problems, str):
            problems = Problem(problems)
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def told_as(self, problems: Sequence[Problem]) -> Self:
        """The same error with its problems told otherwise: with another field, or a place in a file."""
        told = copy(self)
        InputError.__init__(told, problems)
        return told


class MissionFileError(InputError):
    """The mission file does not parse or breaks the schema."""


class TerrainError(InputError):
    """Terrain that cannot be read, or does not cover the place."""


class WindError(InputError):
    """Wind that cannot be read, has gaps, or does not cover the place or time.

    `reason`, where callers act on it: the "area" or the "time" is not covered, or the "members" of an ensemble have to
    be chosen, among `members`.
    """

    def __init__(
        self,
        problems: str | Problem | Sequence[Problem],
        reason: WindReason | None = None,
        members: tuple[int, ...] = (),
    ) -> None:
        self.reason = reason
        self.members = members
        super().__init__(problems)

    def in_files(self, files: Sequence[Path]) -> WindError:
        """The same, its message beginning with the files unless it names one already."""
        if any(problem.file for problem in self.problems):
            return self
        name = Path(", ".join(map(str, files)))
        return self.told_as([replace(problem, file=name) for problem in self.problems])


class FormatError(InputError):
    """A mission in a ground station's format that cannot be read or written."""


class AddressError(InputError):
    """The address of a link that cannot be opened: of an unknown format, not this computer's, or in use."""


class RequestError(InputError):
    """A request whose sites, limits and terrain contradict each other."""


class NoRouteError(WindplanError):
    """No route exists from start to goal.

    `cuts` counts the edges at the border of what could be reached, by what forbids them; `brief` is the reason in a few
    words, for a table: the first sentence if nothing else is given.
    """

    def __init__(self, message: str, cuts: dict[str, int] | None = None, brief: str = "") -> None:
        self.cuts = {} if cuts is None else cuts
        self.brief = brief or message.partition(". ")[0]
        super().__init__(message)


class BatteryError(NoRouteError):
    """The best route breaks the battery's reserve."""

    def __init__(self, message: str) -> None:
        super().__init__(message, {"battery": 1})


class LinkError(WindplanError):
    """The link is dead, or nobody answers on it."""


class RefusedError(LinkError):
    """The vehicle said no, or cannot do what was asked."""


class CancelledError(WindplanError):
    """The work was told to stop before it was done."""

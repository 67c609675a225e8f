"""Long work tells how far it is, and stops when it is told to."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs_windplan.errors import CancelledError


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a piece of work is: a `stage` in plain words, `done` of `total` steps (None: nobody knows how many).

    >>> import gcs_windplan as gw
    >>> print(gw.Progress("departures", 3, 25))
    departures: 3 of 25
    """

    stage: str
    done: int
    total: int | None = None

    def __str__(self) -> str:
        return self.stage if self.total is None else f"{self.stage}: {self.done} of {self.total}"


ProgressCallback: TypeAlias = Callable[[Progress], None]


class CancelToken:
    """Tells work in another thread to stop: whoever started it keeps the token and calls `cancel`.

    The work looks at it between its steps, so that it ends soon after, not at once. A token stays cancelled.

    >>> import gcs_windplan as gw
    >>> token = gw.CancelToken()
    >>> token.cancel()
    >>> token.cancelled
    True
    """

    __slots__ = ("_event",)

    def __init__(self) -> None:
        self._event = threading.Event()

    def cancel(self) -> None:
        """Ask the work to stop; it may be called from any thread, and more than once."""
        self._event.set()

    @property
    def cancelled(self) -> bool:
        """Whether the work is to stop."""
        return self._event.is_set()

    def raise_if_cancelled(self) -> None:
        """Raise `CancelledError` if the work is to stop."""
        if self.cancelled:
            raise CancelledError("cancelled: it was told to stop before it was done")


@dataclass(frozen=True, slots=True)
class Tracker:
    """What long work calls between its steps: it stops where it is told to, and tells how far it is."""

    progress: ProgressCallback | None = None
    cancel: CancelToken | None = None

    def at(self, stage: str, done: int = 0, total: int | None = None) -> None:
        """The work is at a stage, so many steps done. Raises `CancelledError`."""
        if self.cancel is not None:
            self.cancel.raise_if_cancelled()
        if self.progress is not None:
            self.progress(Progress(stage, done, total))


UNTRACKED: Final = Tracker()

"""The command line.

Nothing is imported here that takes time: an interruption while the rest is loaded must end in a line, too.
"""

from __future__ import annotations

import signal
import sys
import time
from types import FrameType

__all__ = ["main"]

_LINK_VERBS = ("push", "pull", "clear")
_ONE_PRESS = 1.0  # [s] in which further interruptions are taken for the same one
_SOON = 0.02  # [s] until an interruption that came at a bad moment is tried again
_CAN_WAIT = hasattr(signal, "setitimer")  # not on Windows
_interrupted_at = -_ONE_PRESS


def main() -> None:
    """Run the command line and exit with its code; Ctrl-C ends in a line and a code of its own."""
    verb = next((word for word in sys.argv[1:] if not word.startswith("-")), "")
    try:
        _listen(verb)
        from gcs_windplan.cli.app import run

        run()
    except KeyboardInterrupt:
        code = 4 if verb in _LINK_VERBS else 0 if verb == "vehicle" else 130
        print("interrupted", file=sys.stderr)
        if verb in _LINK_VERBS and "--json" in sys.argv:
            print(f'{{"verb": "{verb}", "outcome": "unknown", "exit_code": {code}, "error": "interrupted"}}')
        sys.exit(code)
    finally:
        _stop_listening()  # the code is settled


def _listen(verb: str) -> None:
    """Take SIGINT, and where a vehicle is to be told SIGTERM, for an interruption; once a press.

    A shell's background jobs are born deaf to SIGINT. With a vehicle on the line it is heard all the same.
    """
    linked = verb in (*_LINK_VERBS, "vehicle")
    if linked or signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _interrupt)
    if linked:
        signal.signal(signal.SIGTERM, _interrupt)
    if _CAN_WAIT:
        signal.signal(signal.SIGALRM, _interrupt_now)
        sys.unraisablehook = _report_unraisable


def _stop_listening() -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is _interrupt:
            signal.signal(number, signal.SIG_IGN)
    if _CAN_WAIT and signal.getsignal(signal.SIGALRM) is _interrupt_now:
        signal.signal(signal.SIGALRM, signal.SIG_IGN)
        signal.setitimer(signal.ITIMER_REAL, 0)


def _interrupt(number: int, frame: FrameType | None) -> None:
    global _interrupted_at
    now = time.monotonic()
    if now - _interrupted_at >= _ONE_PRESS:
        _interrupted_at = now
        _interrupt_now(number, frame)


def _interrupt_now(_number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, but not out of an import: after it.

    The import system's own callbacks swallow an exception and print its traceback, and modules written in C turn it
    into an ImportError.
    """
    while frame is not None and _CAN_WAIT:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            signal.setitimer(signal.ITIMER_REAL, _SOON)
            return
        frame = frame.f_back
    raise KeyboardInterrupt


def _report_unraisable(caught: sys.UnraisableHookArgs) -> None:
    """An interruption that a finaliser or a callback swallows comes again; all else is reported as ever."""
    if caught.exc_type is KeyboardInterrupt:
        signal.setitimer(signal.ITIMER_REAL, _SOON)
    else:
        sys.__unraisablehook__(caught)

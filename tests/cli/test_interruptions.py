"""A signal ends a verb in a line and a code of its own, whatever is going on at that moment."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from gcs_windplan.formats import write_plan
from tests.link.bench import survey
from tests.mavsdk_peers import free_port

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")

AT_A_CALL = """
import os, sys
from gcs_windplan.cli import main

def profile(frame, event, argument):
    global left
    if event == "call" and where(frame.f_code):
        left -= 1
        if left == 0:
            sys.setprofile(None)
            os.kill(os.getpid(), number)

number, left = int(sys.argv[1]), int(sys.argv[2])
del sys.argv[1:3]
{where}
sys.setprofile(profile)
main()
"""
ANYWHERE = "where = lambda code: True"
IN_A_CALLBACK_OF_THE_IMPORT_SYSTEM = "where = lambda code: code.co_name == 'cb' and 'importlib' in code.co_filename"
IN_A_FINALISER = """
class Finalised:
    def __del__(self):
        os.kill(os.getpid(), number)

def where(code):
    if code.co_name == "parse_args":
        sys.setprofile(None)
        Finalised()
"""


def ended(where: str, nth: int, number: int, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The verb, sent a signal from inside of the nth call of such a function."""
    return subprocess.run(
        [sys.executable, "-c", AT_A_CALL.replace("{where}", where), f"{int(number)}", f"{nth}", *arguments],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    ("where", "nth"),
    [
        *((ANYWHERE, nth) for nth in (100, 300, 1_000, 3_000, 10_000, 30_000)),  # the first 20 are of listening itself
        *((IN_A_CALLBACK_OF_THE_IMPORT_SYSTEM, nth) for nth in (1, 7, 60)),
        (IN_A_FINALISER, 1),
    ],
)
def test_a_verb_that_is_ended_while_it_loads(where: str, nth: int, number: int):
    done = ended(where, nth, number, "vehicle", "--listen", f"udpin:127.0.0.1:{free_port()}")
    assert done.returncode == 0
    assert (done.stdout + done.stderr).splitlines()[-1] in ("ended", "interrupted")
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("nth", [1, 60])
def test_a_push_that_is_ended_while_it_loads_says_that_it_does_not_know(nth: int, tmp_path: Path):
    """Nobody answers, so it cannot have come to an end of its own before the interruption that waits for an import."""
    write_plan(survey(), path := tmp_path / "survey.plan")
    push = ("push", str(path), "--to", f"udpin:127.0.0.1:{free_port()}", "--timeout", "60")
    done = ended(IN_A_CALLBACK_OF_THE_IMPORT_SYSTEM, nth, signal.SIGTERM, *push)
    assert (done.returncode, done.stdout) == (4, "")
    assert done.stderr.splitlines()[-1] in ("interrupted", "error: it was interrupted")  # while it loads, or after
    assert "Traceback" not in done.stderr

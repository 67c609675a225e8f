"""Verbs as processes of their own: what takes long to import is imported once and handed on by forking.

A verb gets its own process, folder, standard streams and exit code, as from a shell; the server that forks it has no
threads and has opened nothing. Where processes cannot fork, each verb is started anew, and so is one that starts
processes itself.
"""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

CODE = "import sys; from gcs_windplan.cli import main; sys.argv[0] = 'gcs-windplan'; main()"
PATIENCE = 300.0  # [s] no verb of a test takes as long on any machine
PRELOADED = "tests.preloaded"


def command(*arguments: object) -> list[str]:
    """The arguments that start a verb in a new interpreter, in which warnings are errors."""
    return [sys.executable, "-W", "error", "-c", CODE, *map(str, arguments)]


def run(*arguments: object, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run a verb to its end; its exit code and what it printed."""
    words = list(map(str, arguments))
    if "forkserver" not in multiprocessing.get_all_start_methods() or words[:1] == ["departures"]:  # it starts workers
        return subprocess.run(command(*words), cwd=cwd, capture_output=True, text=True, timeout=PATIENCE, check=False)
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([PRELOADED])
    with TemporaryDirectory() as name:
        streams = [Path(name) / "stdout", Path(name) / "stderr"]
        process = context.Process(target=_verb, args=(words, os.fspath(cwd), dict(os.environ), *map(str, streams)))
        process.start()
        process.join(PATIENCE)
        if process.exitcode is None:
            process.kill()
            raise subprocess.TimeoutExpired(words, PATIENCE)
        printed = [stream.read_text() if stream.exists() else "" for stream in streams]
    return subprocess.CompletedProcess(words, process.exitcode, *printed)


def _verb(words: list[str], folder: str, environment: dict[str, str], stdout: str, stderr: str) -> None:
    """Become the command, with the streams and the folder of its own."""
    for path, number in ((stdout, 1), (stderr, 2)):
        file = os.open(path, os.O_WRONLY | os.O_CREAT)
        os.dup2(file, number)
    sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", buffering=1, closefd=False)  # noqa: SIM115
    os.environ.clear()
    os.environ.update(environment)
    os.chdir(folder)
    warnings.resetwarnings()
    warnings.simplefilter("error")
    sys.argv = ["gcs-windplan", *words]
    from gcs_windplan.cli import main

    try:
        main()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()

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
from collections.abc import Iterator
from contextlib import contextmanager
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
    with started(*arguments, cwd=cwd) as verb:
        code = verb.wait()
        return subprocess.CompletedProcess(verb.words, code, verb.stdout, verb.stderr)


class Verb:
    """A verb that was started, in a `fresh` interpreter or by forking; what it prints goes into files of a folder."""

    def __init__(self, words: list[str], cwd: Path, folder: Path, *, fresh: bool) -> None:
        self.words = words
        self._streams = streams = [folder / "stdout", folder / "stderr"]
        for stream in streams:
            stream.touch()
        self._process: subprocess.Popen[bytes] | multiprocessing.process.BaseProcess
        if fresh:
            with streams[0].open("wb") as out, streams[1].open("wb") as err:
                self._process = subprocess.Popen(command(*words), cwd=cwd, stdout=out, stderr=err)
            return
        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload([PRELOADED])
        self._process = context.Process(
            target=_verb, args=(words, os.fspath(cwd), dict(os.environ), *map(str, streams))
        )
        self._process.start()

    @property
    def stdout(self) -> str:
        """What it has printed so far."""
        return self._streams[0].read_text()

    @property
    def stderr(self) -> str:
        """What it has printed to its standard error so far."""
        return self._streams[1].read_text()

    def send_signal(self, number: int) -> None:
        """Send it a signal."""
        assert self._process.pid is not None
        os.kill(self._process.pid, number)

    def wait(self, patience: float = PATIENCE) -> int:
        """Its exit code, once it has ended."""
        if isinstance(self._process, subprocess.Popen):
            return self._process.wait(patience)
        self._process.join(patience)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired(self.words, patience)
        return self._process.exitcode

    def end(self) -> None:
        """End it if it runs yet."""
        alive = (
            self._process.poll() is None if isinstance(self._process, subprocess.Popen) else self._process.is_alive()
        )
        if alive:
            self._process.kill()
            self.wait(5.0)


@contextmanager
def started(*arguments: object, cwd: Path, fresh: bool = False) -> Iterator[Verb]:
    """Start a verb, and end it with the block."""
    words = list(map(str, arguments))
    starts_workers = words[:1] == ["departures"]
    fresh = fresh or starts_workers or "forkserver" not in multiprocessing.get_all_start_methods()
    with TemporaryDirectory() as folder:
        verb = Verb(words, cwd, Path(folder), fresh=fresh)
        try:
            yield verb
        finally:
            verb.end()


def _verb(words: list[str], folder: str, environment: dict[str, str], stdout: str, stderr: str) -> None:
    """Become the command, with the streams and the folder of its own."""
    for path, number in ((stdout, 1), (stderr, 2)):
        file = os.open(path, os.O_WRONLY)
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

"""A job in a process of its own: how long it takes, and how much memory the process has held."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

MEGA = 1e6


@dataclass(frozen=True)
class Measured:
    """What a job took: its seconds, those of building before it, the process's peak [MB], its answer.

    `seconds` is the best of its repeats: others may be busy on the machine.
    """

    seconds: float
    build: float
    peak_mb: float
    answer: dict[str, float] = field(default_factory=dict)


def measure(job: str, *arguments: object, cores: int = 1) -> Measured:
    """Run `job` of jobs.py in a fresh process, on one core unless told otherwise."""
    process = subprocess.run(
        [sys.executable, "-m", "tests.benchmarks.jobs", str(cores), job, *(str(argument) for argument in arguments)],
        capture_output=True, text=True, check=False, timeout=600, env={**os.environ, "OMP_NUM_THREADS": str(cores)},
    )  # fmt: skip
    assert process.returncode == 0, process.stderr
    return Measured(**json.loads(process.stdout.splitlines()[-1]))


def pin(cores: int) -> None:
    """Keep this process to the first so many cores, where the system can."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:cores])


def timed(work: Callable[[], dict[str, float]], build: Callable[[], object], repeats: int) -> Measured:
    """Build once, work `repeats` times."""
    begin = time.perf_counter()
    build()
    built = time.perf_counter() - begin
    seconds, answer = [], {}
    for _ in range(repeats):
        begin = time.perf_counter()
        answer = work()
        seconds.append(time.perf_counter() - begin)
    return Measured(min(seconds), built, peak_memory() / MEGA, answer)


def peak_memory() -> int:
    """The most memory that this process has held [bytes]; Linux's own figure, since getrusage's begins at the
    parent's."""
    status = Path("/proc/self/status")
    if status.exists():
        line = next(line for line in status.read_text().splitlines() if line.startswith("VmHWM:"))
        return 1024 * int(line.split()[1])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

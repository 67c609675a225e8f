"""Compiles the kernels that most tests use, once, before the workers of pytest-xdist start; each would do it itself.

The command line plans coarse copies of the gallery's missions, in two processes, so that two cores are busy.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import yaml

ROOT = Path(__file__).resolve().parents[1]
GRID = {"uniform": {"spacing": "400 m"}}
FINE = {"uniform": {"spacing": "400 m", "neighbours": 64}}
ROADMAP = {"prm": {"nodes": 200}}
LANES = (
    (("front", {"graph": GRID}), ("front", {"graph": ROADMAP}), ("jacksboro", {"graph": FINE, "limits": None})),
    (
        ("shear", {"graph": GRID, "via": None, "goal": {"latitude": 36.57, "longitude": -84.19}}),
        ("village", {"graph": {"uniform": {"spacing": "60 m"}}}),
        ("inspection", {"graph": ROADMAP}),
        ("keep_out", {"graph": GRID}),
        ("paper_case1", {}),
    ),
)


def compile_first() -> None:
    """Fill the cache of compiled kernels, where it is empty or older than they are."""
    kernels = list((ROOT / "gcs_windplan").rglob("kernels/*.py"))
    compiled = list((ROOT / "gcs_windplan").rglob("*.nbi"))
    if max(map(_age, compiled), default=0.0) > max(map(_age, kernels)):
        return
    with TemporaryDirectory() as name:
        lanes = [_start(Path(name), number) for number in range(len(LANES))]
        for lane in lanes:
            _, told = lane.communicate()
            if lane.returncode != 0:
                raise RuntimeError(f"the kernels could not be compiled before the tests:\n{told}")


def _age(path: Path) -> float:
    return path.stat().st_mtime


def _start(folder: Path, number: int) -> subprocess.Popen[str]:
    arguments = [sys.executable, "-m", "tests.warming", str(folder), str(number)]
    return subprocess.Popen(arguments, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def coarse(folder: Path, name: str, changes: dict[str, object]) -> Path:
    """A copy of a mission with some fields replaced (None: removed), beside the files that it names."""
    folder.mkdir()
    for beside in ("wind", "meshes", "vehicles"):
        (folder / beside).symlink_to(ROOT / "missions" / beside)
    content = {**yaml.safe_load((ROOT / "missions" / f"{name}.yaml").read_text()), **changes}
    path = folder / f"{name}.yaml"
    path.write_text(yaml.safe_dump({field: value for field, value in content.items() if value is not None}))
    return path


def _run(folder: Path, number: int) -> None:
    from gcs_windplan.cli.app import app

    for k, (name, changes) in enumerate(LANES[number]):
        path = coarse(folder / f"{number}_{k}", name, changes)
        app(["compare", str(path), "-o", str(path.parent / "out")], standalone_mode=False)


if __name__ == "__main__":
    _run(Path(sys.argv[1]), int(sys.argv[2]))

"""Every kernel is compiled alike, and its machine code is fresh."""

from __future__ import annotations

import importlib
import os
import pkgutil
import shutil
import subprocess
import sys
from pathlib import Path

import gcs_windplan
from gcs_windplan import kernels

ASK = """
import numpy as np
from gcs_windplan.kernels.area_test import sampled_collisions as kernel
triangle = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
grid, heads, members = np.array([-1.0, -1.0, 1.0, 2.0, 2.0]), np.array([0, 0, 0, 0, 1]), np.array([0])
start, end = np.array([[0.2, 0.2, -1.0]]), np.array([[0.2, 0.2, 1.0]])
print(kernel(triangle, grid, heads, members, start, end, 0.1, 1e-9)[0], sum(kernel.stats.cache_hits.values()))
"""


def dispatchers():
    for module in pkgutil.iter_modules(kernels.__path__):
        whole = importlib.import_module(f"gcs_windplan.kernels.{module.name}")
        yield from ((f"{module.name}.{name}", one) for name, one in vars(whole).items() if hasattr(one, "py_func"))


def test_every_kernel_releases_the_lock_and_divides_as_numpy():
    found = dict(dispatchers())
    assert len(found) > 50
    options = {
        name: (one.targetoptions.get("nogil"), one.targetoptions.get("error_model")) for name, one in found.items()
    }
    assert {name for name, told in options.items() if told != (True, "numpy")} == set()


def test_machine_code_is_fresh_after_an_edit_of_a_kernel_that_another_file_calls(tmp_path):
    """Three processes: one compiles, one takes the code from disk, and one finds it stale."""
    package = Path(gcs_windplan.__file__).parent
    copy = tmp_path / "gcs_windplan"
    copy.mkdir()
    (copy / "__init__.py").touch()
    shutil.copy(package / "arrays.py", copy)
    shutil.copytree(package / "kernels", copy / "kernels", ignore=shutil.ignore_patterns("__pycache__"))
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}

    def answer() -> list[str]:
        done = subprocess.run(
            [sys.executable, "-c", ASK], env=environment, cwd=tmp_path, capture_output=True, text=True, check=True
        )
        return done.stdout.split()

    assert [answer(), answer()] == [["True", "0"], ["True", "1"]]
    called = copy / "kernels" / "plan_bins.py"
    text = called.read_text()
    told = "if position > 0.0 else 0\n"
    assert text.count(told) == 1
    called.write_text(text.replace(told, "if position > 9.0 else 0\n"))  # all is in the first bin, which is empty
    assert answer() == ["False", "0"]

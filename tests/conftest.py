"""What all tests share."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from gcs_windplan.cores import available_cores
from tests.plans import FOLDER
from tests.warming import compile_first

ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared" / "data"

settings.register_profile("no clock", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("no clock")  # kernels compile in the first example, and a busy machine is no failure


def pytest_configure(config: pytest.Config) -> None:
    """Files go to the workers as they stand: by number of tests the slow ones, which have few, would come last."""
    if hasattr(config.option, "loadscopereorder"):
        config.option.loadscopereorder = False


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """One worker more than cores: a third of the time workers wait for the commands that they started."""
    return available_cores() + 1


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes() -> None:
    """Before the workers start."""
    compile_first()


@pytest.fixture(scope="session", autouse=True)
def _folder_for_plans(tmp_path_factory: pytest.TempPathFactory) -> None:
    """One folder for all workers of a run, each of which has a folder of its own in it."""
    own = tmp_path_factory.getbasetemp()
    shared = own.parent if "PYTEST_XDIST_WORKER" in os.environ else own
    os.environ[FOLDER] = str(shared)


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Real terrain, forecasts, missions and flights, kept outside of the repository."""
    if not SHARED.is_dir():
        pytest.skip("the shared data are not beside this checkout")
    return SHARED


@pytest.fixture(scope="session")
def gallery() -> Path:
    """The missions of the repository."""
    return ROOT / "missions"

"""A new verb is a file with HELP and a function of its name, and one line in the table of verbs."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from gcs_windplan.cli import app as command_line

TOY = '''
"""`gcs-windplan endurance`: how long a battery lasts in level flight."""

from pathlib import Path
from typing import Annotated

import typer

HELP = "Say how long an airframe's battery lasts at its cruise, the reserve kept."
EPILOG = "Exit codes: 0 done; 2 the airframe's file cannot be used."


def endurance(airframe: Annotated[Path, typer.Argument(metavar="FILE", help="An airframe's file.")]) -> None:
    """Read, divide, print."""
    import gcs_windplan as gw

    found = gw.read_airframe(airframe)
    seconds = found.battery.energy_to_plan_with / float(found.power.watts(found.vehicle.airspeed, 0.0))
    typer.echo(f"{seconds / 60:.0f} min at {found.vehicle.airspeed:g} m/s")
'''


@pytest.fixture
def app(tmp_path: Path, monkeypatch) -> typer.Typer:
    """The command line with a toy verb more."""
    (tmp_path / "toyverbs").mkdir()
    (tmp_path / "toyverbs" / "__init__.py").write_text("")
    (tmp_path / "toyverbs" / "endurance.py").write_text(TOY)
    monkeypatch.syspath_prepend(tmp_path)
    wider = typer.Typer(rich_markup_mode=None, add_completion=False)
    for module in (*command_line.VERBS, importlib.import_module("toyverbs.endurance")):
        command_line.add_verb(wider, module)
    yield wider
    for name in [name for name in sys.modules if name.startswith("toyverbs")]:
        del sys.modules[name]


def test_a_toy_verb_stands_beside_the_others(app, gallery: Path):
    helped = CliRunner().invoke(app, ["--help"])
    assert "endurance" in helped.output
    assert "departures" in helped.output
    own = CliRunner().invoke(app, ["endurance", "--help"])
    assert "the reserve kept" in own.output
    assert "Exit codes: 0 done; 2" in own.output
    done = CliRunner().invoke(app, ["endurance", str(gallery / "vehicles" / "small_quadcopter.yaml")])
    assert done.exit_code == 0, done.output
    assert done.output.strip().endswith("m/s")
    assert float(done.output.split(" min")[0]) > 5


def test_every_verb_is_in_the_table_and_the_table_has_no_others():
    listed = {module.__name__.rpartition(".")[2] for module in command_line.VERBS}
    assert {info.name for info in command_line.app.registered_commands} == listed

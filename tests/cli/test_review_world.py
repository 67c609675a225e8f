"""What `review` judges by from its options: limits that nothing tells, winds in words, an airframe's rates."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from gcs_windplan.cli.app import app
from gcs_windplan.errors import InputError
from gcs_windplan.formats import write_plan
from gcs_windplan.jobs.cases import case_by_criteria
from gcs_windplan.jobs.criteria import Criteria
from gcs_windplan.mission import MissionItems
from tests.assessment.cases import HOME, RETURN, at, takeoff
from tests.cli.test_review import WORLD

MISSION = MissionItems((takeoff(60), at(0, 300, 60), RETURN), HOME, "ardupilot", "multicopter")


def review(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["review", *map(str, arguments)])


@pytest.fixture
def drawn(tmp_path: Path) -> Path:
    write_plan(MISSION, tmp_path / "drawn.plan")
    return tmp_path / "drawn.plan"


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--max-gust", "10"), "--max-gust: no gusts are told by the wind"),
        (("--max-gust", "10", "--wind", "8 m/s from 270"), "--max-gust: no gusts are told by the wind"),
        (("--min-battery", "30 %"), "--min-battery: the battery is not known"),
        (("--wind", "8 m/s"), "--wind: '8 m/s' says no direction: write '8 m/s from 270'"),
    ],
)
def test_what_nothing_tells_is_refused(options, words, drawn: Path):
    done = review(drawn, "--terrain", "flat:500", *options)
    assert isinstance(done.exception, InputError)
    assert str(done.exception).startswith(words)
    assert "\n" not in str(done.exception)


def test_limits_that_a_mission_file_cannot_tell(drawn: Path, tmp_path: Path):
    world = tmp_path / "valley.yaml"
    world.write_text(WORLD.format(name="valley"))
    for arguments in ((world,), (drawn, "--by", world)):
        for limit in (("--max-gust", "10"), ("--min-battery", "0.3")):
            done = review(*arguments, *limit)
            assert isinstance(done.exception, InputError)
            assert str(done.exception).startswith(limit[0])


def test_an_ensemble_is_sent_to_a_mission_file(drawn: Path, gallery: Path):
    done = review(drawn, "--terrain", "flat:500", "--extend", "nearest", "--departure", "2026-05-01T09:00Z", "--wind",
                  gallery / "wind" / "front_synthetic.nc")  # fmt: skip
    assert isinstance(done.exception, InputError)
    assert "holds an ensemble of 10 members" in str(done.exception)
    assert "--by MISSION.yaml" in str(done.exception)


def test_a_mission_elsewhere_is_told_with_its_file(drawn: Path, gallery: Path, tmp_path: Path):
    done = review(drawn, "--by", gallery / "front.yaml", "-o", tmp_path / "page.html")
    assert isinstance(done.exception, InputError)
    assert str(done.exception).startswith(str(drawn))
    assert "its own site" in str(done.exception)


def test_a_fixed_wing_climbs_as_its_airframe(gallery: Path):
    def pace(kind, airframe):
        flown = MissionItems(MISSION.items, HOME, "ardupilot", kind)
        criteria = Criteria(terrain="flat:500", vehicle=gallery / "vehicles" / airframe)
        return case_by_criteria(flown, "test", Path("test.plan"), criteria).pace

    wing, copter = pace("fixed-wing", "fixed_wing.yaml"), pace("multicopter", "large_multirotor.yaml")
    assert (wing.climb, wing.descent) == (3, 3)
    assert (copter.climb, copter.descent) == (2.5, 1.5)


def test_an_ensembles_mission_is_judged_in_all_its_members(gallery: Path, tmp_path: Path):
    done = review(gallery / "front.yaml", "-o", tmp_path / "page.html", "--max-wind", "5", "--json")
    (told,) = json.loads(done.stdout)["missions"]
    winds = [one for one in told["findings"] if one["rule"] == "wind"]
    assert 1 <= len(winds) < len(told["legs"])
    assert "of 10 members" in winds[0]["message"]

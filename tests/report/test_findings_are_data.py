"""A rule is one function in one registry; its findings reach every face as data."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest

from gcs_windplan.assessment import Assessment, judge
from gcs_windplan.assessment.figures import AssessedMission
from gcs_windplan.assessment.rules import RULES
from gcs_windplan.assessment.rules.places import Found, on_leg
from gcs_windplan.formats.geojson import format_geojson
from gcs_windplan.formats.verdict import format_verdict
from gcs_windplan.mission import Command
from gcs_windplan.report import render_page
from tests.assessment.cases import RETURN, at, judged


def northward(mission: AssessedMission) -> Iterator[Found]:
    """A toy: legs that lead north of a parallel."""
    for leg, stop in zip(mission.legs, mission.stops[1:], strict=True):
        if stop.north > 500:
            yield on_leg(mission, leg, "northward", "warning", value=stop.north, limit=500.0, unit="m", toy=True)


@pytest.fixture
def review(monkeypatch: pytest.MonkeyPatch) -> Assessment:
    monkeypatch.setattr(judge, "RULES", (*RULES, northward))
    return judged(at(0, 400), at(0, 800), RETURN)


def test_a_new_rule_is_found_told_and_written(review: Assessment):
    (finding,) = review.findings
    assert (finding.rule, finding.leg, finding.item, finding.limit) == ("northward", 2, 3, 500.0)
    assert finding.facts == {"toy": True}
    assert finding.message == "leg 2 (to item 3): northward of 800 m, where the limit is 500 m"
    assert finding.message in render_page([review])
    (mission,) = json.loads(format_verdict([review]))["missions"]
    (row,) = mission["findings"]
    assert (row["rule"], row["severity"], row["facts"], row["message"]) == (
        "northward", "warning", {"toy": True}, finding.message,
    )  # fmt: skip
    assert row["value"] == pytest.approx(800, abs=0.01)
    marks = [one["properties"] for one in json.loads(format_geojson(review))["features"]]
    (mark,) = [one for one in marks if one["kind"] == "finding"]
    assert (mark["rule"], mark["limit"], mark["unit"]) == ("northward", 500.0, "m")


def test_what_follows_an_endless_item_is_said_to_be_unreachable():
    unlimited = at(0, 500, command=Command.NAV_LOITER_UNLIM)
    (finding,) = [one for one in judged(at(0, 300), unlimited, RETURN).findings if one.rule == "endless"]
    assert finding.facts["unreachable"]
    assert "items after 3 are unreachable" in finding.message

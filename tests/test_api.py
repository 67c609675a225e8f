"""The public names: one flat page, each with an example that runs."""

from __future__ import annotations

import ast
import doctest
import inspect
import os
import pickle
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import pytest

import gcs_windplan as gw
from gcs_windplan.errors import WindplanError
from tests.standin.loopback import free_port

ROOT = Path(__file__).resolve().parents[1]
STUB = ROOT / "gcs_windplan" / "__init__.pyi"
ERRORS = [
    name for name in gw.__all__ if inspect.isclass(getattr(gw, name)) and issubclass(getattr(gw, name), Exception)
]
DESCRIBED = [name for name in gw.__all__ if name not in ERRORS]

MISSION = gw.Mission(start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300")


def test_the_names_are_sorted_and_few():
    assert gw.__all__ == sorted(gw.__all__)
    assert len(gw.__all__) < 70
    imports = [node for node in ast.parse(STUB.read_text()).body if isinstance(node, ast.ImportFrom)]
    assert [alias.name for node in imports for alias in node.names] == [node.names[0].asname for node in imports]


def test_the_table_of_contents_lists_every_name():
    words = set("".join(c if c.isalnum() or c == "_" else " " for c in str(gw.__doc__)).split())
    assert set(gw.__all__) - words == set()


def test_every_error_of_the_tree_is_public():
    def below(kind: type[Exception]) -> set[str]:
        return {kind.__name__}.union(*(below(one) for one in kind.__subclasses__()))

    assert below(WindplanError) == set(ERRORS)


@pytest.mark.parametrize("name", DESCRIBED)
def test_every_public_name_has_an_example_that_runs(name, tmp_path, monkeypatch):
    (tmp_path / "missions").symlink_to(ROOT / "missions")
    monkeypatch.chdir(tmp_path)
    found = getattr(gw, name)
    tests = doctest.DocTestFinder(recurse=False).find(found, name, globs={}, module=False)
    assert tests, f"{name} has no docstring"
    assert tests[0].examples, f"{name} has no example"
    runner = doctest.DocTestRunner(optionflags=doctest.IGNORE_EXCEPTION_DETAIL | doctest.ELLIPSIS)
    told: list[str] = []
    assert runner.run(tests[0], out=told.append).failed == 0, "".join(told)


def test_options_are_keyword_only():
    for name in ("plan", "review", "check", "push", "pull", "clear", "diff", "read_forecast"):
        kinds = [one.kind for one in inspect.signature(getattr(gw, name)).parameters.values()]
        assert sum(kind is inspect.Parameter.POSITIONAL_OR_KEYWORD for kind in kinds) <= 2, name


def test_a_plan_shows_itself_in_a_notebook():
    plan = gw.plan(MISSION)
    shown = plan._repr_html_()
    assert "2 waypoints" in shown
    assert shown.count("data:image/png;base64,iVBORw0KGgo") == 2
    assert plan.to_dict()["totals"]["length"] == pytest.approx(plan.totals.length)
    kinds = [feature["properties"]["kind"] for feature in plan.to_geojson()["features"]]
    assert kinds == ["leg", "stop", "stop"]
    again = pickle.loads(pickle.dumps(plan))
    assert again.to_dict() == plan.to_dict()


def test_words_and_values_say_the_same(gallery):
    from gcs_windplan.wind import ConstantWind

    words = gw.plan(replace(MISSION, wind="6 m/s from 90 deg", departure="2026-05-01T08:00Z"))
    short = gw.plan(replace(MISSION, wind="6@90", start="36.55,-84.30", goal=gw.Place(gw.GeoPoint(36.56, -84.28))))
    value = gw.plan(replace(MISSION, wind=ConstantWind.from_direction(6.0, 90.0, words.request.scene.frame)))
    assert words.totals == short.totals == value.totals
    assert words.totals.seconds > gw.plan(MISSION).totals.seconds


def test_a_mission_in_values_is_the_mission_in_a_file(gallery):
    """The mission with areas, a fence and rally points, in the units of pilots there and in SI here."""
    from gcs_windplan.units import INTERNATIONAL_FOOT as FOOT
    from gcs_windplan.units import KNOT

    reserve = [(36.625, -84.195), (36.650, -84.200), (36.655, -84.165), (36.640, -84.150), (36.630, -84.160)]
    sector = [(36.600, -84.150), (36.645, -84.150), (36.645, -84.110), (36.600, -84.110)]
    permitted = [(36.595, -84.235), (36.675, -84.235), (36.675, -84.105), (36.595, -84.105)]
    mission = gw.Mission(
        name="keep out",
        start=(36.615, -84.215),
        goal="36.655,-84.125",
        vehicle=gw.Vehicle(24 * KNOT, climb=500 * FOOT / 60, descent=300 * FOOT / 60),
        terrain="sample:jacksboro",
        wind="12 kt from 200 deg",
        profile="power:0.143",
        clearance=100 * FOOT,
        max_height=400 * FOOT,
        keep_out=[
            gw.Area("nature reserve", reserve, fence=True),
            gw.Area("quarry", [gw.GeoPoint(36.622, -84.152)], radius=350.0, margin=10.0, fence=True),
            gw.Area("airport sector", sector, floor=2500 * FOOT),
        ],
        keep_in=[gw.Area("permitted area", permitted, ceiling=3000 * FOOT, fence=True)],
        rally=["36.612,-84.205,200 ft agl", gw.Place(gw.GeoPoint(36.650, -84.135), height=200 * FOOT)],
        graph=gw.Uniform(spacing=80.0, neighbours=16),
        margin=2000.0,
    )
    ours, files = gw.plan(mission), gw.plan(gw.read_mission(gallery / "keep_out.yaml"))
    assert ours.to_dict() == files.to_dict()
    assert ours.items == files.items


def test_words_that_say_nothing_name_the_field():
    for field, words in {
        "wind": "8 m/s", "terrain": "sample:everest", "start": "here", "departure": "noon", "profile": "cubic",
        "airspeed": "fast",
    }.items():  # fmt: skip
        with pytest.raises(gw.InputError) as caught:
            replace(MISSION, **{field: words})
        assert caught.value.problems[0].field == field


def test_values_in_the_local_frame_ask_for_its_origin():
    with pytest.raises(gw.InputError, match="start: needs the mission's origin"):
        gw.plan(replace(MISSION, start=gw.LocalPoint(0.0, 0.0)))
    there = replace(MISSION, start=gw.LocalPoint(0.0, 0.0), origin=gw.GeoPoint(36.55, -84.30))
    assert gw.plan(there).totals.length == pytest.approx(gw.plan(MISSION).totals.length, abs=0.1)


def test_progress_is_told_and_work_is_cancelled():
    stages: list[str] = []
    gw.plan(MISSION, progress=lambda step: stages.append(step.stage))
    assert stages[0] == "reading terrain and wind"
    assert len(stages) >= 2
    token = gw.CancelToken()

    def stop_after_one(step: gw.Progress) -> None:
        if step.done:
            token.cancel()

    with pytest.raises(gw.CancelledError):
        gw.departures(
            MISSION, "2026-05-01T06:00Z", "2026-05-01T12:00Z", "1h", cores=1, progress=stop_after_one, cancel=token
        )
    with pytest.raises(gw.CancelledError):
        gw.review(MISSION, cancel=token)


def test_waiting_for_a_vehicle_is_cancelled():
    token = gw.CancelToken()
    threading.Timer(0.2, token.cancel).start()
    with pytest.raises(gw.CancelledError):
        gw.push(gw.plan(MISSION), f"udpin:127.0.0.1:{free_port()}", timeout=60.0, cancel=token)


def test_review_calls_its_criteria_by_their_names():
    plan = gw.plan(MISSION)
    with pytest.raises(gw.InputError, match=r"^max_gust: the wind has no gusts"):
        gw.review(plan.items, terrain="flat:300", max_gust=10.0)
    with pytest.raises(gw.InputError, match=r"^terrain: cannot stand beside"):
        gw.review(MISSION, terrain="flat:300")


def test_what_was_written_is_read_again(tmp_path):
    plan = gw.plan(MISSION)
    for ending in (".plan", ".waypoints", ".json", ".geojson", ".kml", ".csv", ".html"):
        assert gw.write(plan, tmp_path / f"out{ending}").stat().st_size > 100
    assert gw.diff(tmp_path / "out.plan", tmp_path / "out.waypoints", autopilot="ardupilot").same
    with pytest.raises(gw.FormatError, match="ends in none of"):
        gw.write(plan, tmp_path / "out.docx")


def test_importing_the_package_is_quick_and_light():
    code = "import sys, gcs_windplan; print([m for m in ('numpy', 'numba', 'pydantic') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=os.environ, check=True)
    assert done.stdout.strip() == "[]"

"""The page as a text: well formed, self-contained, escaped, small, and the same for the same input."""

from __future__ import annotations

import base64
import gzip
import hashlib
import json
import math
import re
import time
from dataclasses import replace

import html5lib
import numpy as np
import pytest

from gcs_windplan.assessment import Assessment, Finding, Source, assess_plan
from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.report import page, render_page, words
from gcs_windplan.report.places import FindingPlace, place_of
from tests.plans import planned
from tests.report import made

MEGABYTE = 1_000_000


@pytest.fixture(scope="module")
def one() -> str:
    return render_page([made.assessment()])


@pytest.fixture(scope="module")
def two() -> str:
    return render_page([made.assessment("straight"), made.assessment("bent", shift=300.0, stops=12)])


def tree_of(page: str):
    """The page's elements; raises at the first place where it is not valid HTML."""
    return html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(page)


def text_of(element) -> str:
    return " ".join("".join(element.itertext()).split())


def numbers_of(page: str) -> dict:
    return json.loads(re.search(r'id="numbers">(.*?)</script>', page, re.S)[1])


@pytest.mark.parametrize(
    "assessments",
    [
        [made.assessment()],
        [made.clear()],
        [made.assessment(made.NASTY)],
        [made.assessment("a"), made.assessment("b", shift=300.0)],
        [made.clear(), made.assessment(made.NASTY)],
    ],
)
def test_it_is_valid_and_its_ids_are_unique(assessments: list[Assessment]) -> None:
    tree = tree_of(render_page(assessments))
    ids = [element.get("id") for element in tree.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    referred = {e.get(key) for e in tree.iter() for key in ("aria-labelledby", "aria-describedby", "for")}
    assert referred - {None} <= set(ids)


def test_verdict_totals_and_findings_come_first(one: str) -> None:
    text = text_of(tree_of(one).find("body"))
    order = ("Dangers: do not fly it like this", "Totals", "Findings", "Route", "Legs and stops", "What this rests on")
    places = [text.index(word) for word in order]
    assert places == sorted(places)
    assert "1 danger, 2 warnings" in text
    assert "limit 30 m" in text
    assert "reserve 25 %" in text
    assert "not a certification" in text


@pytest.mark.parametrize(("how", "words"), [(made.clear, "Clear: nothing found"), (made.assessment, "Dangers")])
def test_the_verdict_is_said_in_words(how, words: str) -> None:
    assert words in text_of(tree_of(render_page([how()])).find("body/header"))


def test_only_warnings_are_warnings() -> None:
    mission = made.assessment()
    mild = replace(mission, findings=mission.findings[1:])
    assert "Warnings: look at them before flying" in render_page([mild])


def test_each_finding_with_a_place_leads_there(one: str) -> None:
    links = [a for a in tree_of(one).iter("a") if a.get("data-finding") is not None]
    assert [a.get("data-finding") for a in links] == ["0", "1"]  # the third concerns the whole mission
    found = numbers_of(one)["missions"][0]["findings"]
    assert all(f["at"] is not None and f["e"] is not None for f in found[:2])
    assert found[2]["e"] is None


def test_a_finding_over_the_take_off_lies_on_its_leg_not_on_the_ground() -> None:
    mission = made.assessment()
    profile = mission.profile
    climb = {name: values for name in profile.__slots__ if (values := getattr(profile, name)) is not None}
    climb = {name: np.concatenate([values[:1], values]) for name, values in climb.items()}  # twice at distance 0
    climb["leg"][0] = 0
    climb["altitude"][0] -= 70
    finding = replace(mission.findings[0], leg=1, distance=0.0, latitude_deg=None, longitude_deg=None)
    place = place_of(replace(mission, profile=type(profile)(**climb), findings=(finding,)), finding)
    assert place.sample == 1
    assert place.latitude_deg == pytest.approx(profile.latitude_deg[0])


def test_a_finding_of_an_item_lies_at_its_stop() -> None:
    mission = made.assessment()
    finding = Finding("speed", "warning", "too fast", item=3)
    assert place_of(mission, finding).distance == mission.stops[3].distance
    assert place_of(mission, Finding("speed", "warning", "too fast")) == FindingPlace()


def test_tables_have_captions_and_scopes(one: str) -> None:
    tables = list(tree_of(one).iter("table"))
    assert len(tables) == 2
    for table in tables:
        assert text_of(table.find("caption"))
        assert all(th.get("scope") in ("col", "row") for th in table.iter("th"))
        width = len(table.findall("thead/tr/th"))
        assert all(len(row) == width for row in table.iterfind("tbody/tr"))


def test_provenance_is_said(one: str) -> None:
    text = text_of(tree_of(one).find("body"))
    assert "SHA-256 " + "ab" * 32 in text
    assert "run 2026-05-01 00:00 UTC" in text
    assert "loiter time 0 s read as a waypoint" in text
    assert "EGM2008" in text


def test_nothing_is_fetched(one: str, two: str) -> None:
    for text in (one, two):
        tree = tree_of(text)
        for element in tree.iter():
            for name, value in element.items():
                if name in ("src", "href", "srcset", "action", "poster"):
                    assert value.startswith(("data:", "#")), (element.tag, name, value[:60])
        outside = re.sub(r"http://www\.w3\.org/\d+/(svg|xhtml)", "", text)
        assert "http://" not in outside
        assert "https://" not in outside


def test_the_policy_forbids_the_network_and_foreign_scripts(one: str) -> None:
    tree = tree_of(one)
    policy = next(m.get("content") for m in tree.iter("meta") if m.get("http-equiv") == "Content-Security-Policy")
    assert policy.startswith("default-src 'none'")
    assert "unsafe" not in policy
    assert "http" not in policy
    script = next(s for s in tree.iter("script") if s.get("type") is None).text
    packed = next(s for s in tree.iter("script") if s.get("id") == "library").text
    style = next(tree.iter("style")).text
    for text in (script, style, gzip.decompress(base64.b64decode(packed)).decode()):
        assert base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() in policy
    assert all(e.get("style") is None for e in tree.iter())  # the policy would not let them count
    assert all(not name.startswith("on") for e in tree.iter() for name in e.keys())  # noqa: SIM118


def test_names_and_messages_are_escaped() -> None:
    mission = made.assessment(made.NASTY)
    nasty = replace(
        mission,
        findings=tuple(replace(f, message=made.NASTY) for f in mission.findings),
        outlines=tuple(replace(o, name=made.NASTY) for o in mission.outlines),
        stops=tuple(replace(s, label=made.NASTY) for s in mission.stops),
        sources=(Source("mission", made.NASTY, made.NASTY, made.NASTY, made.NASTY),),
        remarks=(made.NASTY,),
        vertical_datum=made.NASTY,
    )
    page = render_page([nasty, nasty])
    tree = tree_of(page)
    assert "<script>alert" not in page
    assert len(list(tree.iter("script"))) == 3  # numbers, library, script
    assert numbers_of(page)["missions"][0]["name"] == made.NASTY
    assert "\u2028" not in re.search(r'id="numbers">(.*?)</script>', page, re.S)[1]


def test_the_same_input_makes_the_same_page(one: str) -> None:
    assert render_page([made.assessment()]) == one


def test_it_is_small(one: str, two: str) -> None:
    assert len(one.encode()) < MEGABYTE
    assert len(two.encode()) < MEGABYTE


def test_seven_hundred_stops_are_quick_and_small() -> None:
    mission = made.assessment(stops=700)
    render_page([made.clear()])  # unpacks three.js once
    took = []
    for _ in range(3):  # on a busy machine the cores' caches are others'
        begin = time.process_time()
        page = render_page([mission])
        took.append(time.process_time() - begin)
    assert min(took) < 1.5
    assert len(page.encode()) < 2 * MEGABYTE
    numbers = numbers_of(page)["missions"][0]
    assert len(numbers["track"]["d"]) < 5000
    assert len(numbers["stops"]) == 700


def test_a_thinned_profile_keeps_extremes_and_findings() -> None:
    mission = made.assessment(stops=1500)
    track = numbers_of(render_page([mission]))["missions"][0]["track"]
    assert len(track["d"]) < len(mission.profile.distance)
    above = [z - g for z, g in zip(track["z"], track["g"], strict=True)]
    rounding = 0.11  # [m] two heights to a decimetre
    assert min(above) == pytest.approx(mission.totals.clearance, abs=rounding)
    assert max(above) == pytest.approx(mission.totals.height, abs=rounding)


def test_two_missions_stand_side_by_side_with_their_differences(two: str) -> None:
    tree = tree_of(two)
    table = next(t for t in tree.iter("table") if "compare" in (t.get("class") or ""))
    rows = {text_of(row[0]): [text_of(cell) for cell in row[1:]] for row in table.iterfind("tbody/tr")}
    first, second = made.assessment("straight"), made.assessment("bent", shift=300.0, stops=12)
    change = second.totals.seconds - first.totals.seconds
    assert rows["Time"][3] == f"{100 * change / first.totals.seconds:+.1f} %".replace("-", "−")
    assert "points" in rows["Battery left"][2]
    assert "B takes" in text_of(tree)


def test_two_missions_of_different_frames_lie_where_they_are() -> None:
    here = made.assessment("here")
    elsewhere = LocalFrame(GeoPoint(46.81, 9.82))
    east, north = elsewhere.to_local(here.profile.latitude_deg, here.profile.longitude_deg).T
    shift = elsewhere.to_local(46.8, 9.8)[0]
    there = replace(
        here,
        frame=elsewhere,
        profile=replace(here.profile, east=east, north=north),
        ground=replace(here.ground, east=here.ground.east + shift[0], north=here.ground.north + shift[1]),
        stops=tuple(replace(s, east=s.east + shift[0], north=s.north + shift[1]) for s in here.stops),
        outlines=(),
    )
    numbers = numbers_of(render_page([here, there]))
    a, b = (mission["track"] for mission in numbers["missions"])
    one_metre = 1.0
    assert np.allclose(a["e"], b["e"], atol=one_metre)
    assert np.allclose(a["n"], b["n"], atol=one_metre)
    assert numbers["map"]["west"] == pytest.approx(here.ground.east[0], abs=2 * one_metre)


def test_what_is_not_known_is_a_dash_and_null() -> None:
    mission = made.assessment()
    blank = np.full_like(mission.profile.distance, np.nan)
    unknown = replace(
        mission,
        profile=replace(mission.profile, ground=blank, wind_along=blank, wind_east=blank, seconds=blank),
        ground=replace(mission.ground, heights=np.full_like(mission.ground.heights, np.nan)),
        totals=replace(mission.totals, seconds=np.inf, clearance=np.nan, height=np.nan, left=np.nan, energy=np.inf),
    )
    page = render_page([unknown])
    assert "never" in text_of(tree_of(page))
    assert set(numbers_of(page)["missions"][0]["track"]["g"]) == {None}
    tree_of(render_page([unknown, mission]))


def test_a_finding_without_a_finite_number_has_a_dash() -> None:
    finding = Finding("battery", "danger", "it draws too much", value=math.nan, limit=math.inf, unit="Wh")
    assert words.against_limit(finding) == "– Wh, limit – Wh"


@pytest.mark.parametrize(
    ("value", "text"),
    [(1e30, "1×10³⁰"), (-2.26e12, "−2.3×10¹²"), (999_999_999.0, "999999999"), (math.nan, "–"), (math.inf, "∞")],
)
def test_absurd_numbers_are_short(value: float, text: str) -> None:
    assert words.number(value) == text


def test_absurd_durations_are_short() -> None:
    assert words.clock(6e30) == "1×10²⁹"
    assert words.clock(math.inf) == "never"
    assert words.clock_difference(-6e30) == "−1×10²⁹"
    assert words.clock_difference(math.nan) == "–"


def test_a_mission_without_legs_has_a_page() -> None:
    mission = made.assessment()
    empty = {name: getattr(mission.profile, name)[:0] for name in mission.profile.__slots__}
    page = render_page([replace(mission, legs=(), stops=(), profile=type(mission.profile)(**empty), findings=())])
    tree_of(page)


def test_without_three_js_the_page_says_so(monkeypatch) -> None:
    monkeypatch.setattr(page, "three_js", lambda: None)
    page._dress.cache_clear()
    text = render_page([made.assessment()])
    page._dress.cache_clear()
    assert "This page carries no scene" in text
    assert 'id="library"' not in text


@pytest.mark.parametrize("how_many", [0, 3])
def test_other_numbers_of_missions_are_refused(how_many: int) -> None:
    with pytest.raises(InputError, match="one mission or compares two"):
        render_page([made.clear()] * how_many)


def test_a_planned_mission_has_a_page() -> None:
    page = render_page([assess_plan(planned("keep_out"))])
    text = text_of(tree_of(page).find("body"))
    assert "keep out" in text
    assert len(page.encode()) < 2 * MEGABYTE

"""The page in a real browser, with the network off."""

from __future__ import annotations

import io
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from gcs_windplan.assessment import Assessment
from gcs_windplan.report import render_page
from tests.report import made

sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

LAPTOP, PHONE = (1280, 800), (390, 844)
# the scene is drawn by the GL in software; the rest of the page would take twice as long by it
SOFTWARE_3D = (
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-gpu-compositing",
)  # fmt: skip
NO_3D = ("--disable-3d-apis",)
# the browser's own remark on how it then gets the scene's picture; the page reads no pixels
COPIED = re.compile(r"warning: \[\.WebGL-\w+\]GL Driver Message \(OpenGL, Performance, .* GPU stall due to ReadPixels")


def chromium() -> str:
    """The browser of this machine; skips where there is none."""
    found = [path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))]
    if not found:
        pytest.skip("no chromium, chromium-browser or google-chrome on this machine")
    return found[0]


@pytest.fixture(scope="module")
def browsers() -> Iterator[dict]:
    """A browser that draws 3D in software, and one that has none."""
    path = chromium()
    with sync_api.sync_playwright() as playwright:
        launched = {
            name: playwright.chromium.launch(executable_path=path, args=["--no-sandbox", *options])
            for name, options in (("3d", SOFTWARE_3D), ("flat", NO_3D))
        }
        yield launched
        for browser in launched.values():
            browser.close()


class Opened:
    """A page in a browser without a network, and all that it asked for and complained of.

    The window serves test after test, as a new one takes much longer than a new page; none finds anything of the last.
    """

    def __init__(self, browser, size: tuple[int, int], scheme: str) -> None:
        self.size, self.scheme = size, scheme
        self.context = browser.new_context(has_touch=size == PHONE)
        self.context.set_offline(True)
        self.asked: list[str] = []
        self.complaints: list[str] = []
        self.page = self.context.new_page()
        self.page.route(re.compile("^(?!file:|data:|about:|blob:)"), lambda route: route.abort())
        self.page.on("request", lambda request: self.asked.append(request.url[:80]))
        self.page.on("console", lambda message: self.complain(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.complain(str(error)))

    def complain(self, text: str) -> None:
        if not COPIED.match(text):
            self.complaints.append(text)

    def open(self, path: Path) -> None:
        """Another page, as in a new window."""
        self.leave()
        self.page.set_viewport_size({"width": self.size[0], "height": self.size[1]})
        self.page.emulate_media(media="null", color_scheme=self.scheme, reduced_motion="reduce")
        self.asked.clear()
        self.complaints.clear()
        self.page.goto(path.as_uri())

    def leave(self) -> None:
        """Nothing is open, and the pointer is where it was at first."""
        self.page.goto("about:blank")
        self.page.mouse.move(0, 0)

    @property
    def outside(self) -> list[str]:
        """What was asked for beyond the file itself and what it carries."""
        return [url for url in self.asked if not url.startswith(("file:", "data:", "about:", "blob:"))]

    def reading(self, what: str) -> str:
        cell = self.page.locator(".readout .at", has=self.page.locator("span", has_text=re.compile(f"^{what}$")))
        return cell.first.locator("b").inner_text()

    def place_of(self, selector: str) -> dict:
        """Where an element is on the screen, once it has been scrolled to."""
        self.page.locator(selector).scroll_into_view_if_needed()
        return self.page.locator(selector).bounding_box()

    def draw_scene(self) -> None:
        self.page.locator("#scene").scroll_into_view_if_needed()
        self.page.wait_for_selector("#scene canvas", timeout=60_000)
        self.page.wait_for_timeout(300)


@cache
def text_of(*missions: Assessment) -> str:
    """The page of missions; that of the same objects is written once."""
    return render_page(missions)


@pytest.fixture(scope="module")
def windows(browsers) -> Iterator[dict]:
    """Those opened so far, by browser, size and colour scheme."""
    opened: dict[tuple, Opened] = {}
    yield opened
    for window in opened.values():
        window.context.close()


@pytest.fixture
def show(browsers, windows, tmp_path) -> Iterator:
    used: list[Opened] = []

    def show_(*missions: Assessment, size=LAPTOP, scheme="light", browser="flat") -> Opened:
        path = tmp_path / "page.html"
        path.write_text(text_of(*missions), encoding="utf-8")
        kind = (browser, size, scheme)
        if kind not in windows:
            windows[kind] = Opened(browsers[browser], size, scheme)
        used.append(windows[kind])
        used[-1].open(path)
        return used[-1]

    yield show_
    for window in used:
        window.leave()


def pixels_of(png: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


def colours_in(png: bytes) -> int:
    return len(np.unique(pixels_of(png).reshape(-1, 3), axis=0))


RIDGE = made.assessment()
TWO = made.assessment("a"), made.assessment("b", shift=300.0, stops=13)


def unknown() -> Assessment:
    """A mission of which neither ground nor wind nor times are known."""
    mission = made.assessment("unknown")
    blank = np.full_like(mission.profile.distance, np.nan)
    return replace(
        mission,
        profile=replace(
            mission.profile, ground=blank, wind_along=blank, wind_across=blank, wind_east=blank, seconds=blank
        ),
        ground=replace(mission.ground, heights=np.full_like(mission.ground.heights, np.nan)),
    )


def empty() -> Assessment:
    """A mission that leads nowhere."""
    mission = made.assessment("empty")
    profile = {name: getattr(mission.profile, name)[:0] for name in mission.profile.__slots__}
    return replace(mission, legs=(), stops=(), findings=(), profile=type(mission.profile)(**profile))


def absurd(height: float) -> Assessment:
    """A mission with one stop at an absurd height, and figures to match."""
    mission = made.assessment(f"absurd {height:g}")
    profile, stops = mission.profile, list(mission.stops)
    high = profile.altitude.copy()
    high[len(high) // 2] = height
    stops[4] = replace(stops[4], altitude=height, above_ground=height, left=-1e30, return_energy=np.nan)
    strange = np.where(profile.leg == 3, np.nan, np.where(profile.leg == 4, 1e300, profile.power))
    long = profile.seconds * 1e27
    finding = replace(mission.findings[0], value=np.nan, limit=np.inf)
    return replace(
        mission,
        profile=replace(profile, altitude=high, power=strange, seconds=long, distance=profile.distance * 1e27),
        stops=tuple(stops),
        totals=replace(
            mission.totals, seconds=1e30, length=abs(height), height=abs(height), energy=np.nan, left=np.nan
        ),
        findings=(finding, *mission.findings[1:]),
    )


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [LAPTOP, PHONE])
@pytest.mark.parametrize(
    "missions",
    [
        (made.assessment(made.NASTY),),
        TWO,
    ],
    ids=["one", "two"],
)
def test_it_opens_without_network_or_complaint(show, missions, size, scheme) -> None:
    opened = show(*missions, size=size, scheme=scheme, browser="3d")
    opened.draw_scene()
    assert opened.outside == []
    assert opened.complaints == []
    width = opened.page.evaluate("[document.documentElement.scrollWidth, document.body.scrollWidth, innerWidth]")
    assert max(width[:2]) <= width[2]
    heading = opened.page.locator("h1").first.inner_text()
    assert " ".join(missions[0].name.split()) in " ".join(heading.split())


@pytest.mark.parametrize(
    "mission",
    [
        made.clear(),
        unknown(),
        empty(),
        made.assessment("long", stops=700),
        absurd(1e30),
        absurd(-1e30),
        absurd(1.7e308),
    ],
    ids=lambda m: m.name,
)
def test_odd_missions_draw_without_complaint(show, mission) -> None:
    opened = show(mission, browser="3d")
    opened.draw_scene()
    assert opened.complaints == []
    assert opened.page.locator("#map svg image").count() == 1
    assert opened.page.locator(".chart[data-chart=heights] .plot svg").count() == 1
    assert opened.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert "NaN" not in opened.page.locator("#where").inner_html()


@pytest.mark.parametrize("shape", [0.4, 1.0, 1.6])
def test_the_map_fills_its_frame(show, shape) -> None:
    mission = RIDGE
    ground = mission.ground
    middle, half = 0.5 * (ground.north[0] + ground.north[-1]), 0.5 * np.ptp(ground.east) / shape
    north = np.linspace(middle - half, middle + half, len(ground.north))
    opened = show(replace(mission, ground=replace(ground, north=north)))
    frame = opened.place_of("#map")
    image = opened.page.locator("#map image").bounding_box()
    filled = image["width"] * image["height"] / (frame["width"] * frame["height"])
    assert filled > (0.95 if shape >= 1 else 0.65)
    assert opened.place_of("#scene")["width"] > 0.35 * opened.place_of(".where")["width"]


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_the_totals_leave_no_cell_empty(show, size) -> None:
    mission = RIDGE
    for gust in (10.2, None):  # an even and an odd number of cells
        opened = show(replace(mission, totals=replace(mission.totals, gust=gust)), size=size)
        whole = opened.page.locator(".figures").bounding_box()
        cells = [cell.bounding_box() for cell in opened.page.locator(".figures > div").all()]
        assert max(cell["x"] + cell["width"] for cell in cells[-1:]) == pytest.approx(
            whole["x"] + whole["width"], abs=2
        )


def test_routes_that_coincide_are_both_seen(show) -> None:
    opened = show(made.assessment("a"), made.assessment("b"))
    opened.page.locator("#map").scroll_into_view_if_needed()
    pixels = pixels_of(opened.page.locator("#map").screenshot()).astype(int)
    for colour in ((0x00, 0x72, 0xB2), (0xA3, 0x33, 0x6F)):
        assert (np.abs(pixels - colour).sum(axis=2) < 40).sum() > 300


def test_a_route_below_the_ground_is_seen_in_the_scene(show) -> None:
    mission = made.clear()
    deep = replace(mission, profile=replace(mission.profile, altitude=mission.profile.ground - 100))
    nowhere = replace(mission, profile=replace(mission.profile, altitude=np.full_like(mission.profile.ground, np.nan)))
    drawn = []
    for one in (deep, nowhere):
        opened = show(replace(one, stops=()), browser="3d")
        opened.draw_scene()
        drawn.append(pixels_of(opened.page.locator("#scene canvas").screenshot()).astype(int))
    assert (np.abs(drawn[0] - drawn[1]).sum(axis=2) > 60).sum() > 200


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_the_scene_has_pixels_and_turns(show, size) -> None:
    opened = show(RIDGE, size=size, browser="3d")
    opened.draw_scene()
    canvas = opened.page.locator("#scene canvas")
    before = canvas.screenshot()
    assert colours_in(before) > 2000
    canvas.focus()
    opened.page.keyboard.press("ArrowLeft")
    opened.page.wait_for_timeout(200)
    after = canvas.screenshot()
    assert (pixels_of(before) != pixels_of(after)).any(axis=2).mean() > 0.1


def test_without_webgl_the_scene_says_so(show) -> None:
    opened = show(RIDGE)
    opened.page.locator("#scene").scroll_into_view_if_needed()
    opened.page.wait_for_function("document.getElementById('scene').textContent.includes('WebGL is off')")
    assert opened.page.locator("#map svg image").count() == 1
    assert opened.complaints == []


def test_the_pointer_reads_the_charts_out(show) -> None:
    mission = RIDGE
    opened = show(mission)
    box = opened.place_of(".chart[data-chart=heights] .plot")
    opened.page.mouse.move(box["x"] + box["width"] * 0.7, box["y"] + box["height"] / 2)
    distance = float(opened.reading("distance").removesuffix(" km")) * 1000
    share = (0.7 * box["width"] - 48) / (box["width"] - 62)
    assert distance == pytest.approx(share * mission.totals.distance, abs=30)
    profile = mission.profile
    i = int(np.abs(profile.distance - distance).argmin())
    assert float(opened.reading("altitude").removesuffix(" m")) == pytest.approx(profile.altitude[i], abs=3)
    assert float(opened.reading("ground speed").removesuffix(" m/s")) == pytest.approx(profile.ground_speed[i], abs=0.3)
    assert float(opened.reading("battery").removesuffix(" %")) == pytest.approx(100 * profile.left[i], abs=1)
    for chart in ("heights", "wind", "speed", "power", "battery"):
        assert opened.page.locator(f".chart[data-chart={chart}] .cursor").count() == 1
    assert opened.page.locator("#here .dot").count() == 1


def test_the_pointer_over_the_route_on_the_map_moves_the_charts(show) -> None:
    opened = show(RIDGE)
    opened.page.locator("#map").scroll_into_view_if_needed()
    stop = opened.page.locator("#map circle.stop").nth(4).bounding_box()
    opened.page.mouse.move(stop["x"] + 3, stop["y"] + 3)
    expected = RIDGE.stops[5].distance
    assert float(opened.reading("distance").removesuffix(" km")) * 1000 == pytest.approx(expected, abs=60)


def test_arrow_keys_move_the_cursor_and_say_where_it_is(show) -> None:
    opened = show(RIDGE)
    slider = opened.page.locator("#position")
    slider.focus()
    opened.page.keyboard.press("ArrowRight")
    opened.page.keyboard.press("ArrowRight")
    assert slider.input_value() == "2"
    opened.page.keyboard.press("End")
    assert opened.reading("distance") == f"{RIDGE.totals.distance / 1000:.2f} km"
    spoken = slider.get_attribute("aria-valuetext")
    assert all(word in spoken for word in ("altitude", "above ground", "wind along", "airspeed", "battery"))


def test_a_touch_reads_out_on_a_phone(show) -> None:
    opened = show(RIDGE, size=PHONE)
    box = opened.place_of(".chart[data-chart=speed] .plot")
    before = opened.reading("distance")
    opened.page.touchscreen.tap(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    assert opened.reading("distance") != before


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
@pytest.mark.parametrize("by", ["click", "keyboard"])
def test_a_finding_leads_to_its_place(show, size, by) -> None:
    mission = RIDGE
    opened = show(mission, size=size)
    link = opened.page.locator("a[data-finding='1']")
    if by == "click":
        link.click()
    else:
        link.focus()
        opened.page.keyboard.press("Enter")
    wanted = mission.findings[1].distance
    assert float(opened.reading("distance").removesuffix(" km")) * 1000 == pytest.approx(wanted, abs=10)
    assert opened.page.locator("#map .finding.chosen").get_attribute("data-finding") == "1"
    assert opened.page.locator(".chart .finding.chosen").get_attribute("data-finding") == "1"
    assert opened.page.locator("#finding-0-1.chosen").count() == 1
    opened.page.wait_for_timeout(100)
    top = opened.page.locator("#map").bounding_box()["y"]
    assert 0 <= top <= 60
    assert opened.page.evaluate("document.activeElement.id") == "position"
    if size == LAPTOP:  # the sign is in sight on the map and in the profile
        for sign in (opened.page.locator("#map .finding.chosen"), opened.page.locator(".chart .finding.chosen")):
            place = sign.bounding_box()
            assert place["y"] >= 0
            assert place["y"] + place["height"] <= size[1]


def test_a_sign_on_the_map_leads_to_its_finding(show) -> None:
    opened = show(RIDGE)
    opened.page.locator("#map .finding[data-finding='0']").click()
    assert opened.page.locator("#finding-0-0.chosen").count() == 1


def test_the_charts_go_over_time_too(show) -> None:
    mission = RIDGE
    opened = show(mission)
    opened.page.locator("input[name=axis][value=t]").check()
    assert "time since take-off" in opened.page.locator(".chart[data-chart=heights] .plot").text_content()
    box = opened.place_of(".chart[data-chart=heights] .plot")
    opened.page.mouse.move(box["x"] + 48 + (box["width"] - 62) / 2, box["y"] + box["height"] / 2)
    minutes, seconds = opened.reading("time").split(":")
    assert 60 * int(minutes) + int(seconds) == pytest.approx(mission.profile.seconds[-1] / 2, abs=5)


def test_both_missions_are_read_out_at_the_same_place(show) -> None:
    opened = show(*TWO)
    opened.page.locator("#position").focus()
    for _ in range(40):
        opened.page.keyboard.press("ArrowRight")
    both = opened.page.locator(".readout .at:nth-child(2) b").all_inner_texts()
    assert len(both) == 2
    assert float(both[0].removesuffix(" km")) == pytest.approx(float(both[1].removesuffix(" km")), abs=0.02)
    assert opened.page.locator("#here .dot").count() == 2


def test_the_map_can_be_enlarged_and_shown_whole(show) -> None:
    opened = show(RIDGE)

    def width() -> float:
        return float(opened.page.locator("#map image").get_attribute("width"))

    before = width()
    opened.page.locator("[data-map=in]").click()
    assert width() > 1.5 * before
    opened.page.locator("#map").focus()
    left = opened.page.locator("#map image").get_attribute("x")
    opened.page.keyboard.press("ArrowRight")
    assert opened.page.locator("#map image").get_attribute("x") != left
    opened.page.locator("[data-map=whole]").click()
    assert width() == pytest.approx(before)


def test_it_prints_light_with_a_still_of_the_scene(show, tmp_path) -> None:
    opened = show(RIDGE, scheme="dark", browser="3d")
    opened.draw_scene()
    opened.page.emulate_media(media="print", color_scheme="dark")
    background = opened.page.evaluate("getComputedStyle(document.body).backgroundColor")
    assert background == "rgb(255, 255, 255)"
    assert opened.page.locator("#scene canvas").is_hidden()
    opened.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    opened.page.wait_for_function("document.querySelector('#scene .still').naturalWidth > 0")
    assert opened.page.pdf(print_background=True)[:5] == b"%PDF-"
    assert opened.complaints == []


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
@pytest.mark.parametrize("browser", ["3d", "flat"])
def test_on_paper_the_map_fills_its_frame_and_no_chart_is_cut(show, size, browser) -> None:
    opened = show(RIDGE, size=size, browser=browser)
    if browser == "3d":
        opened.draw_scene()
    a4_without_margins = {"width": 688, "height": 1017}
    opened.page.set_viewport_size(a4_without_margins)
    opened.page.emulate_media(media="print")
    opened.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    opened.page.wait_for_timeout(200)
    frame, image = (opened.page.locator(one).bounding_box() for one in ("#map", "#map image"))
    assert image["width"] * image["height"] > 0.9 * frame["width"] * frame["height"]
    assert frame["height"] < 0.35 * a4_without_margins["height"]
    assert opened.page.locator("#charts").bounding_box()["height"] < 0.6 * a4_without_margins["height"]
    for kept in (".chart", "figure.map", ".figures", "tbody tr", ".findings li"):
        wanted = opened.page.locator(kept).first.evaluate("one => getComputedStyle(one).breakInside")
        assert wanted == "avoid"
    opened.page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert opened.complaints == []


def test_the_skip_link_is_the_first_stop_of_the_tabulator(show) -> None:
    opened = show(RIDGE)
    opened.page.keyboard.press("Tab")
    assert opened.page.evaluate("document.activeElement.className") == "skip"
    opened.page.keyboard.press("Enter")
    assert opened.page.evaluate("document.activeElement.id") == "main"

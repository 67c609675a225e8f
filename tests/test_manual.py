"""The README and the manual: what they print is what the program does, and every command they show runs."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path
from shutil import copy
from textwrap import dedent

import numpy as np
import pytest
import typer

from gcs_windplan.cli.app import app
from gcs_windplan.errors import InputError
from gcs_windplan.manual import read_page, topics
from tests.link.autopilots import ArduPilot
from tests.link.udp import calling
from tests.mavsdk_peers import free_port
from tests.terrain.rasters import from_origin, write
from tests.verbs import run

ROOT = Path(__file__).resolve().parents[1]
PAGES = {path.name: path for path in (ROOT / "README.md", *sorted((ROOT / "gcs_windplan" / "manual").glob("*.md")))}
FENCE = re.compile(r"^( *)(?:<!-- not run: (.+) -->\n *)?```(\w*)\n(.*?)\n *```$", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"\d+:\d\d\b|\d+(?:\.\d+)?")
ON_THIS_MACHINE = re.compile(r" +\d\.\d{3}$|[\d.]+ s\b|\b[\d.]+ times as \w+|on \d+ cores?|[█ ]+")
TIGHT = {  # on another processor vertices settle a little elsewhere, and ties in A* by angle fall otherwise
    r"^jacksboro, least time: \d+ waypoints, ([\d.]+) km, (\d+:\d\d) min": (5e-3, 2e-3),
    r"^ (?:time|distance) +(\d+:\d\d) ": (2e-3,),
    r"^ (?:time|distance|energy) +\d+:\d\d +\S+ % +([\d.]+) +\S+ %": (3e-3,),
    r"^energy takes ([\d.]+) Wh": (0.02,),
}
LEG = re.compile(r"^ +\d+ +\d{3} ")  # a leg more or less renumbers the rest


@dataclass(frozen=True, slots=True)
class Block:
    """A block of code on a page."""

    not_run: str
    language: str
    text: str

    def commands(self) -> list[tuple[str, list[str]]]:
        """Each command with the lines that it is shown to print."""
        found: list[tuple[str, list[str]]] = []
        for line in self.text.replace("\\\n", " ").splitlines():
            if line.startswith("$ "):
                found.append((line[2:].partition("  #")[0].strip(), []))
            elif found:
                found[-1][1].append(line)
        return found


def blocks(page: str) -> list[Block]:
    return [Block(why, language, dedent(text)) for _, why, language, text in FENCE.findall(PAGES[page].read_text())]


def commands(page: str, *, marked: bool) -> list[tuple[str, list[str]]]:
    return [pair for block in blocks(page) if bool(block.not_run) is marked for pair in block.commands()]


@dataclass(slots=True)
class Desk:
    """A folder with what the pages speak of, and a vehicle that calls in."""

    folder: Path
    port: int
    printed: dict[str, list[str]] = field(default_factory=dict)

    def run(self, command: str) -> list[str]:
        """What the command prints; each is run once."""
        if command not in self.printed:
            program, *arguments = shlex.split(re.sub(r"udpin:[\d.:]+", f"udpin:127.0.0.1:{self.port}", command))
            assert program == "gcs-windplan"
            done = run(*arguments, cwd=self.folder)
            assert "Traceback" not in done.stderr
            assert done.returncode in (0, 1) or "broken.yaml" in command, done.stderr
            self.printed[command] = [line.rstrip() for line in (done.stdout + done.stderr).splitlines()]
        return self.printed[command]


@pytest.fixture(scope="module")
def desk(tmp_path_factory) -> Iterator[Desk]:
    folder = tmp_path_factory.mktemp("desk")
    (folder / "missions").symlink_to(ROOT / "missions")
    (folder / "broken.yaml").write_text(broken_mission())
    (own,) = (block.text for block in blocks("README.md") if block.language == "yaml")
    (folder / "mine.yaml").write_text(own)
    heights = np.random.default_rng(1).uniform(600, 605, (60, 80)).astype("float32")
    write(folder / "dem.tif", heights, "EPSG:4326", from_origin(9.77, 46.84, 0.00125, 0.001))
    port = free_port()
    with calling(port, ArduPilot):
        desk = Desk(folder, port)
        desk.run("gcs-windplan plan missions/jacksboro.yaml")  # what the pages on the link push
        yield desk


def broken_mission() -> str:
    """The mission shown, with three mistakes."""
    text = (ROOT / "missions" / "jacksboro.yaml").read_text()
    for good, bad in (
        ("airspeed: 14 m/s", "airspeed: 14 m"),
        ("goal: {latitude", "goal: {lattitude"),
        ("max_height: 120 m", "max_height: 30 m"),
    ):
        assert good in text
        text = text.replace(good, bad)
    return text


@pytest.mark.parametrize("page", [page for page in PAGES if commands(page, marked=False)])
def test_every_command_shown_runs_and_prints_what_is_shown(page: str, desk: Desk, request):
    if page == "firmware.md":
        missions = request.getfixturevalue("shared_data") / "missions" / "ardupilot"
        copy(missions / "Generic_Missions__CMAC-copter-navtest.txt", desk.folder / "navtest.waypoints")
    for command, shown in commands(page, marked=False):
        printed = desk.run(command)
        for line in shown:
            if line == " ...":
                continue
            at = next((k for k, found in enumerate(printed) if same(line, found)), None)
            assert at is not None, f"{command} does not print {line!r}, but:\n" + "\n".join(printed)
            printed = printed[at + 1 :]


def same(shown: str, printed: str) -> bool:
    """Whether two lines are the same but for what another processor may change."""
    return words(shown) == words(printed) and same_figures(shown, printed)


def words(line: str) -> str:
    """A line without its figures."""
    return NUMBER.sub("0", ON_THIS_MACHINE.sub(" ", line)).strip()


def same_figures(shown: str, printed: str) -> bool:
    for pattern, tolerances in TIGHT.items():
        if (one := re.match(pattern, shown)) and (other := re.match(pattern, printed)):
            for a, b, tolerance in zip(one.groups(), other.groups(), tolerances, strict=True):
                if value(a) != pytest.approx(value(b), rel=tolerance):
                    return False
    if LEG.match(shown):
        return True
    pairs = zip(*(NUMBER.findall(ON_THIS_MACHINE.sub(" ", line)) for line in (shown, printed)), strict=True)
    return all(value(a) == pytest.approx(value(b), rel=0.05, abs=5.01 * last_digit(a)) for a, b in pairs)


def last_digit(text: str) -> float:
    """What one step of its last digit is worth."""
    return float(10.0 ** -len(text.partition(".")[2]))


def value(text: str) -> float:
    """A number, or a time in seconds."""
    minutes, colon, seconds = text.partition(":")
    return 60.0 * float(minutes) + float(seconds) if colon else float(text)


@pytest.mark.parametrize("page", PAGES)
def test_a_command_that_is_not_run_is_marked_and_takes_its_options(page: str):
    for block in blocks(page):
        assert block.language in ("", "sh", "yaml", "python")
        assert block.language != "sh" or block.not_run or page == "README.md"  # there `.ci/run` runs it
        assert block.language or block.commands(), "a block without language is what a terminal shows"
    verbs = typer.main.get_command(app)
    assert isinstance(verbs, typer.core.TyperGroup)
    for command, _ in commands(page, marked=True):
        program, verb, *arguments = shlex.split(command)
        if program == "gcs-windplan":
            verbs.commands[verb].make_context(verb, arguments)  # raises where an option is unknown


@pytest.mark.parametrize("page", PAGES)
def test_python_shown_runs(page: str, monkeypatch, tmp_path: Path):
    (tmp_path / "missions").symlink_to(ROOT / "missions")
    monkeypatch.chdir(tmp_path)  # what it writes is not for the repository
    for block in blocks(page):
        if block.language == "python":
            with redirect_stdout(StringIO()) as printed:
                exec(block.text, {})
            for line in re.findall(r"^# (.*)$", block.text, re.MULTILINE):
                assert any(same(line, found) for found in printed.getvalue().splitlines()), printed.getvalue()


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str):
    targets = re.findall(r"\]\(([^)]+)\)", PAGES[page].read_text())
    for target in targets:
        if not target.startswith("https://"):
            assert (PAGES[page].parent / target.partition("#")[0]).exists(), target


def test_the_readme_is_a_front_door():
    text = PAGES["README.md"].read_text()
    assert len(text.splitlines()) <= 200
    assert set(re.findall(r"gcs_windplan/manual/([\w-]+)\.md", text)) == set(topics())


def test_the_two_commands_stand_in_the_first_shell_block():
    first, second = next(block.text for block in blocks("README.md") if block.language == "sh").splitlines()
    assert first.endswith("gcs-windplan plan missions/jacksboro.yaml")
    assert second.endswith("-m pytest -n auto --dist loadfile")


def test_topics_name_what_their_pages_are_about():
    for topic, title in topics().items():
        assert title.lower().removeprefix("the ").replace("-", " ").startswith(topic.replace("-", " ") + ": "), title
    with pytest.raises(InputError, match="did you mean 'energy'"):
        read_page("enrgy")


def test_no_comment_is_shown():
    for topic in topics():
        assert "<!--" not in read_page(topic)
        assert "](" not in read_page("exit-codes")


def test_help_shows_pages(desk: Desk):
    listed = desk.run("gcs-windplan help")
    for topic, title in topics().items():
        assert any(line.split(maxsplit=1) == [topic, title.partition(": ")[2]] for line in listed)
    assert desk.run("gcs-windplan help energy") == read_page("energy").splitlines()


def test_help_on_a_terminal_is_set_out(monkeypatch, capsys):
    from gcs_windplan.cli import help as verb

    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    verb.help("review")
    shown = capsys.readouterr().out
    assert "# Review" not in shown
    assert "Review: is this mission safe to fly?" in shown
    assert ".png" not in shown


def test_an_unknown_topic_is_exit_code_2(tmp_path):
    done = run("help", "revew", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "error: 'revew' is no topic of the manual; did you mean 'review'?\n"

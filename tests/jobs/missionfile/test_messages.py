"""Bad mission files and the exact lines that they bring."""

import re
from itertools import pairwise
from pathlib import Path

import pytest

from gcs_windplan.errors import MissionFileError
from gcs_windplan.jobs.missionfile.parsing import parse_mission, read_document
from gcs_windplan.units import SPEED
from tests.jobs.missionfile.missions import FILE, complaints, mission

NEEDS_ORIGIN = "needs terrain.origin, which says where the local origin is"
SPEED_ADVICE = "write for example 12 m/s, or a plain number in m/s"
LENGTH_ADVICE = "write for example 120 m, or a plain number in m"


def _cases() -> list[tuple[str, str, str]]:
    """The cases of complaints.txt: a line of the file, then the line that it brings."""
    blocks = (Path(__file__).parent / "complaints.txt").read_text(encoding="utf-8").split("\n\n")
    pairs = [block.strip().split("\n") for block in blocks]
    return [(*written.split(": ", 1), complaint) for written, complaint in pairs]  # type: ignore[misc]


@pytest.mark.parametrize(("field", "value", "line"), _cases(), ids=lambda value: value[:40])
def test_a_wrong_field(field: str, value: str, line: str) -> None:
    assert complaints(mission(**{field: value})) == [line]


def test_brackets_without_end_are_an_error_and_no_crash() -> None:
    """The newer libyaml gives up by itself, at another place."""
    (line,) = complaints("[" * 200_000)
    assert "lists and sections nest" in line


def test_an_absent_field() -> None:
    assert complaints(mission(name=None)) == ["1:1: name: is missing; add it, for example 'name: ridge-crossing'"]


PARSERS_WORDS = r"(?<=this is not YAML) \(.*?\)(?=; )"
SAME_COLUMN = "fields of one section start in the same column"
COLON = f"this is not YAML; a value with ': ' needs quotes; {SAME_COLUMN}"
NO_FIELDS = "a mission file holds fields such as 'name: ridge'; this one holds something else"
EMPTY = "the mission file is empty; begin it with 'name: ...'"
TOO_DEEP = "lists and sections nest deeper than 40 levels"
NO_MISSION = [
    ("name: a: b", "1:8", COLON),
    ("name: x\n  wind: y", "2:7", COLON),
    ("vehicle:\n\tairspeed: 5", "2:1", "this is not YAML; indent with spaces, not with tabs"),
    (
        "name: x\nstart: {latitude: 3\n",
        "2:8",
        "this is not YAML; close the { } and put commas between fields",
    ),
    ("via: [1, 2\nname: x", "2:5", "this is not YAML; close the [ ] and put commas between entries"),
    ("name: 'abc\n\n", "1:7", "this is not YAML; close the quotes"),
    ("name: *x", "1:7", "this is not YAML; a value that starts with * needs quotes"),
    ("name: @x", "1:7", "this is not YAML; a value that starts with this character needs quotes"),
    (
        "name: x\n---\nname: y",
        "2:1",
        "this is not YAML; keep one document, with no '---' after its first line",
    ),
    ("name: a\x07b", "1:8", r"the character '\x07' is not allowed in YAML; remove it"),
    ("name: x\nvia: \ud800", "2:6", r"the character '\ud800' is not allowed in YAML; remove it"),
    ("via: &a [*a]", "1:6", "an alias (*name) stands inside of what it stands for"),
    ("via: " + "[" * 50 + "]" * 50, "1:45", TOO_DEEP),
    ("", "1:1", EMPTY),
    ("# only a comment\n", "1:1", EMPTY),
    ("- a\n- b\n", "1:1", NO_FIELDS),
    ("ridge", "1:1", NO_FIELDS),
    ("~", "1:1", NO_FIELDS),
]


@pytest.mark.parametrize(("text", "place", "message"), NO_MISSION, ids=lambda value: ascii(value[:20]))
def test_a_text_that_is_no_mission(text: str, place: str, message: str) -> None:
    """What the parser itself says, in parentheses, differs with and without libyaml."""
    assert [re.sub(PARSERS_WORDS, "", line) for line in complaints(text)] == [f"{place}: {message}"]


def test_aliases_that_multiply_are_stopped() -> None:
    levels = ["a: &a [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]"]
    levels += [f"{new}: &{new} [{', '.join(['*' + old] * 10)}]" for old, new in pairwise("abcdefghi")]
    assert "more than 200000 values" in complaints("\n".join(levels))[0]


def test_aliases_that_nest_are_stopped() -> None:
    lines = ["a0: &a0 [1]", *(f"a{n}: &a{n} [*a{n - 1}]" for n in range(1, 5000))]
    assert "nest deeper" in complaints("\n".join(lines))[0]


def test_every_problem_at_once_in_the_order_of_the_lines() -> None:
    text = """\
name: ridge
vehicle:
  airspede: 12 m/s
  climb: 2 ft
  type: fixed-wing
  type: multicopter
terrain:
  sample: jacksboro
wind:
  calm: true
  constant:
    speed: 8 kmh
start: {east: 0, north: 0}
goal: {latitude: 95, longitude: 1}
clearance: 130
limits: {max_height: 120}
graph:
  layers: [40, 30]
keepout: 3
departure:
"""
    assert complaints(text) == [
        "3:3: vehicle.airspede: unknown field; did you mean 'airspeed'?",
        "4:10: vehicle.climb: '2 ft' is a length, but a speed belongs here; " + SPEED_ADVICE,
        "6:3: vehicle.type: appears twice, first in line 5; keep one of the two",
        "11:3: wind.constant: cannot stand beside 'calm'; keep one of calm, constant, paper or forecast",
        "12:5: wind.constant.from: is missing; add it, for example 'from: 270 deg'",
        "12:12: wind.constant.speed: unknown unit 'kmh' for a speed; known units: " + ", ".join(SPEED.units),
        f"13:9: start.east: {NEEDS_ORIGIN}",
        "14:18: goal.latitude: must be between -90 and 90 deg, not 95",
        "16:22: limits.max_height: 120 m is below the clearance of 130 m; raise one, lower the other",
        "18:16: graph.layers.1: layers go upwards: 30 m is not above 40 m",
        "19:1: keepout: unknown field; did you mean 'keep_out'? Write it into `limits:`",
        "20:11: departure: is empty; give it a value or leave the field out",
    ]


def test_a_problem_holds_its_place_as_data() -> None:
    with pytest.raises(MissionFileError) as caught:
        parse_mission(mission(clearance="on"), FILE)
    (problem,) = caught.value.problems
    assert (problem.file, problem.line, problem.column, problem.field) == (FILE, 7, 12, "clearance")
    assert str(problem) == f"m.yaml:7:12: clearance: 'on' is not a length; {LENGTH_ADVICE}"


def test_layers_and_sites_above_the_largest_height() -> None:
    text = mission(
        start="{latitude: 1, longitude: 2, height: 130}", limits="{max_height: 120}", graph="{layers: [90, 400 ft]}"
    )
    assert complaints(text) == [
        "5:44: start.height: 130 m is above limits.max_height, 120 m",
        "8:22: graph.layers.1: 121.92 m is above limits.max_height, 120 m",
    ]


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("missing.yaml", None, "there is no such file; check the name and the folder"),
        (".", None, "is a folder; name the mission file inside of it"),
        ("latin.yaml", "name: Höhe".encode("latin-1"), "is not UTF-8 text (byte 8); save it as UTF-8"),
        ("utf16.yaml", "name: a".encode("utf-16"), "is not UTF-8 text (byte 1); save it as UTF-8"),
        ("large.yaml", b"#" * 10_000_001, "is larger than 10 MB; this is not a mission file"),
        ("nul\0.yaml", None, "cannot be read"),
    ],
)
def test_files_that_cannot_be_read(tmp_path: Path, name: str, content: bytes | None, message: str) -> None:
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(MissionFileError) as caught:
        read_document(tmp_path / name)
    assert str(caught.value).startswith(f"{tmp_path / name}: {message}")

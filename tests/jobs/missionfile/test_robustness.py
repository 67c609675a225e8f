"""Whatever stands in a file: a mission, or a MissionFileError that names places inside of the file."""

import re

from hypothesis import example, given, settings
from hypothesis import strategies as st

from gcs_windplan.errors import MissionFileError
from gcs_windplan.jobs.missionfile.parsing import parse_mission
from tests.jobs.missionfile.missions import FIELDS, FILE, mission
from tests.jobs.missionfile.test_parsing import FULL

SCALARS = st.sampled_from(
    [
        *[
            "",
            "~",
            "true",
            "on",
            "12:30",
            "-1",
            "0",
            "1e999",
            ".nan",
            ".inf",
            "9" * 30,
            "12 m",
            "5 m/s",
            "x",
            "- 1",
        ],
        *[
            "[]",
            "{}",
            "[[]]",
            "{a: b}",
            "[1, 2]",
            "*a",
            "&a 1",
            "!!int x",
            "!x y",
            "<<: 3",
            "? [a] : b",
            "'",
            ">",
        ],
        *['"\\x00"', "\t"],
    ]
)
LINE_ENDS = re.compile("\r\n|[\n\r\x85\u2028\u2029]")


def check(text: str) -> None:
    try:
        parse_mission(text, FILE)
    except MissionFileError as error:
        problems = error.problems
    else:
        return
    assert problems
    lines = len(LINE_ENDS.split(text))
    for problem in problems:
        assert problem.file == FILE
        assert problem.line is not None
        assert problem.column is not None
        assert 1 <= problem.line <= lines
        assert problem.column >= 1
        assert not re.search("Input should|Value error|does not fit here", problem.message)
    places = [(problem.line or 0, problem.column or 0) for problem in problems]
    assert places == sorted(places)
    assert len(set(problems)) == len(problems)


@given(st.text(max_size=60))
@example("\ufeff")
@example("%YAML 9.9\n---\na: b")
@example("%TAG ! x\n--- !y\n")
@example("a: \ud800")
@settings(deadline=None)
def test_any_text(text: str) -> None:
    check(text)


@given(st.integers(0, len(FULL)), st.integers(0, 12), st.one_of(st.text(max_size=6), SCALARS))
@settings(deadline=None, max_examples=300)
def test_a_mission_with_a_piece_replaced(start: int, length: int, piece: str) -> None:
    check(FULL[:start] + piece + FULL[start + length :])


@given(st.data())
@settings(deadline=None, max_examples=300)
def test_a_mission_with_values_replaced(data: st.DataObject) -> None:
    lines = FULL.splitlines()
    for number in data.draw(st.lists(st.integers(0, len(lines) - 1), min_size=1, max_size=6)):
        key, colon, _ = lines[number].partition(": ")
        lines[number] = f"{key}{colon or ' '}{data.draw(SCALARS)}"
    check("\n".join(lines))


VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5).map(repr), SCALARS),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4).map(lambda items: f"[{', '.join(map(str, items))}]"),
        st.dictionaries(
            st.sampled_from(
                ["name", "polygon", "keep_out", "wind", "latitude", "east", "prm", "uniform", "layers", "law", "dem"]
            ),
            inner,
            max_size=4,
        ).map(lambda items: f"{{{', '.join(f'{key}: {value}' for key, value in items.items())}}}"),
    ),
    max_leaves=8,
)


@given(
    st.sampled_from(
        [
            *FIELDS,
            "via",
            "cost",
            "graph",
            "limits",
            "obstacles",
            "departure",
            "export",
            "clearance",
        ]
    ),
    VALUES,
)
@settings(deadline=None, max_examples=500)
def test_a_mission_with_a_field_of_any_shape(field: str, value: object) -> None:
    check(mission(**{field: str(value)}))

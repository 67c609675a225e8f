"""A file of YAML becomes a checked section; every problem is told at once, with line and column."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final, TypeVar

import yaml
from pydantic import ValidationError

from gcs_windplan.errors import MissionFileError, Problem
from gcs_windplan.jobs.missionfile.marks import MarkedError, Marks, Values, compose
from gcs_windplan.jobs.missionfile.section import Section, findings

_S = TypeVar("_S", bound=Section)
#: What the parser of YAML stumbles over, and what usually helps; the first that fits.
_HINTS: Final = (
    ("\t", "indent with spaces, not with tabs"),
    (
        "mapping values are not allowed",
        "a value with ': ' needs quotes; fields of one section start in the same column",
    ),
    ("quoted scalar", "close the quotes"),
    ("nesting depth", "lists and sections nest too deeply"),
    ("flow mapping", "close the { } and put commas between fields"),
    ("flow sequence", "close the [ ] and put commas between entries"),
    ("undefined alias", "a value that starts with * needs quotes"),
    ("cannot start any token", "a value that starts with this character needs quotes"),
    ("could not find expected ':'", "write a colon and a space after the field's name"),
    ("block mapping", "fields of one section start in the same column"),
    ("block collection", "each entry of a list starts with '- ' in the same column"),
    ("single document", "keep one document, with no '---' after its first line"),
)


def read_text(path: Path, kind: str, most: int) -> str:
    """The text of a file of this kind (`mission file`) of at most so many bytes; raises `MissionFileError`."""
    try:
        if path.stat().st_size > most:
            raise _whole_file(path, f"is larger than {most // 1_000_000} MB; this is not {_a(kind)}")
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise _whole_file(path, "there is no such file; check the name and the folder") from None
    except IsADirectoryError:
        raise _whole_file(path, f"is a folder; name the {kind} inside of it") from None
    except UnicodeDecodeError as error:
        raise _whole_file(path, f"is not UTF-8 text (byte {error.start + 1}); save it as UTF-8") from None
    except (OSError, ValueError) as error:
        raise _whole_file(path, f"cannot be read: {getattr(error, 'strerror', None) or error}") from None


def check_text(section: type[_S], text: str, file: Path, kind: str, example: str) -> tuple[_S, Marks]:
    """What a YAML text says, and where each of its fields stands; `file` names it in messages.

    Raises `MissionFileError` with every problem, in the order of the lines.
    """
    marks = _marks_of(text, file, kind)
    try:
        values = Values(marks)
    except MarkedError as error:
        raise MissionFileError(Problem(error.message, None, file, error.line, error.column)) from None
    if not isinstance(values.value, dict):
        message = f"{_a(kind)} holds fields such as '{example}'; this one holds something else"
        raise MissionFileError(Problem(message, None, file, *marks.place(())))
    problems = list(_yaml_problems(values, file))
    broken = {problem.field for problem in problems}
    try:
        model = section.model_validate(values.value)
    except ValidationError as error:
        problems += [found for found in _schema_problems(error, marks, file) if found.field not in broken]
    if problems:
        raise MissionFileError(sorted(dict.fromkeys(problems), key=_order))
    return model, marks


def _marks_of(text: str, file: Path, kind: str) -> Marks:
    """What a text of this kind of file holds; raises `MissionFileError` for one that is not YAML, or empty."""
    try:
        marks = compose(text)
    except MarkedError as error:
        problem = Problem(error.message, None, file, error.line, error.column)
    except yaml.MarkedYAMLError as error:
        problem = _syntax_problem(error, text, file)
    except (yaml.YAMLError, UnicodeEncodeError):
        problem = _unreadable(text, file)
    else:
        if marks is not None:
            return marks
        problem = Problem(f"the {kind} is empty; begin it with 'name: ...'", None, file, 1, 1)
    raise MissionFileError(problem)


def _syntax_problem(error: yaml.MarkedYAMLError, text: str, file: Path) -> Problem:
    line, column = _syntax_place(error, text)
    here = "".join(text.split("\n")[line - 1 : line])[column - 1 : column]
    said = " ".join(part for part in (error.context, error.problem, here) if part)
    hint = next((hint for sign, hint in _HINTS if sign in said), "check the indentation, quotes and brackets here")
    return Problem(f"this is not YAML ({error.problem or error.context}); {hint}", None, file, line, column)


def _syntax_place(error: yaml.MarkedYAMLError, text: str) -> tuple[int, int]:
    """Where the parser stumbled; at the end of the text rather where that began which has no end."""
    rows = text.split("\n")
    for mark in (error.problem_mark, error.context_mark):
        if mark is not None and _rest(rows, mark.line, mark.column):
            return mark.line + 1, mark.column + 1
    return len(rows), len(rows[-1]) + 1


def _rest(rows: list[str], line: int, column: int) -> bool:
    """Whether anything stands at or behind a place, both counted from 0."""
    return any(row.strip() for row in ["".join(rows[line : line + 1])[column:], *rows[line + 1 :]])


def _unreadable(text: str, file: Path) -> Problem:
    """The first character that YAML does not allow (YAML 1.2, section 5.1)."""
    for number, line in enumerate(text.split("\n"), 1):
        for column, char in enumerate(line, 1):
            if not (char.isprintable() or char in "\t\r\x85\xa0\ufeff") or "\ud800" <= char <= "\udfff":
                message = f"the character {char!a} is not allowed in YAML; remove it"
                return Problem(message, None, file, number, column)
    return Problem("this is not YAML; save the file as UTF-8 text", None, file, 1, 1)


def _yaml_problems(values: Values, file: Path) -> Iterator[Problem]:
    for path, (line, column), message in values.findings:
        yield Problem(message, _joined(path), file, line, column)


def _schema_problems(error: ValidationError, marks: Marks, file: Path) -> Iterator[Problem]:
    for found in findings(error):
        path = marks.written(found.path)
        line, column = marks.key_place(path) if found.at_key else marks.place(path)
        yield Problem(found.message, _joined(path), file, line, column)


def _whole_file(file: Path, message: str) -> MissionFileError:
    return MissionFileError(Problem(message, None, file))


def _a(kind: str) -> str:
    """The kind with its article."""
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def _order(problem: Problem) -> tuple[int, int, str]:
    return problem.line or 0, problem.column or 0, problem.field or ""


def _joined(path: tuple[str | int, ...]) -> str | None:
    return ".".join(str(part) for part in path) or None

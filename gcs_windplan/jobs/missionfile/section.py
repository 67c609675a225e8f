"""What every section of a mission file shares: strictness, and messages that say what would be right."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar, Self, TypeAlias, get_args, get_origin

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, ValidationError, model_validator
from pydantic_core import CoreSchema, ErrorDetails, InitErrorDetails, PydanticCustomError

from gcs_windplan.units import shown

Path: TypeAlias = tuple[str | int, ...]
Fields: TypeAlias = Mapping[str, object]

_PLAIN = "plain"  # pydantic's type of an error that stands at the value
_AT_KEY = "plain_at_key"


@dataclass(frozen=True, slots=True)
class SchemaProblem:
    """What is wrong below a section, in plain language; `path` starts there.

    `at_key` points to the field's name instead of its value.
    """

    path: Path
    message: str
    at_key: bool = False


class Section(BaseModel):
    """A frozen section without unknown fields, whose errors are plain and complete.

    Fields that contradict each other are reported (`contradictions`) together with fields that are wrong by
    themselves; pydantic alone would report the first only after the second are mended.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    expects: ClassVar[str] = ""
    words: ClassVar[tuple[str, ...]] = ()  # examples of the text that may stand in its place
    alone: ClassVar[str] = ""  # the field whose value may stand in its place
    elsewhere: ClassVar[Mapping[str, str]] = {}  # fields that are looked for here, and where they stand, in words

    @classmethod
    def expanded(cls, data: object) -> object:
        """What the short form of a section stands for. Raises `ValueError` for words that say nothing."""
        return data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """What fields say against each other; they may be wrong by themselves."""
        return iter(())

    @model_validator(mode="wrap")
    @classmethod
    def _check(cls, data: Any, handler: Callable[[Any], Self]) -> Self:
        try:
            data = cls.expanded(data)
        except ValueError as error:
            said = SchemaProblem((), str(error))
            raise ValidationError.from_exception_data(cls.__name__, [_details(said)]) from None
        found = list(cls.contradictions(spelled_out(cls, data))) if isinstance(data, Mapping) else []
        model = None
        try:
            model = handler(data)
        except ValidationError as error:
            errors = error.errors(include_url=False)
            found += [_finding(one, cls) for one in errors if not _follows(one, errors, cls)]
        if model is None or found:
            raise ValidationError.from_exception_data(cls.__name__, [_details(one) for one in found])
        return model

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        long = handler(core)
        if cls.alone:
            field = long["properties"][cls.alone]
            return {"anyOf": [field.get("anyOf", [field])[0], long]}
        return {"anyOf": [{"type": "string", "examples": list(cls.words)}, long]} if cls.words else long


def spelled_out(section: type[Section], fields: Fields) -> Fields:
    """The fields of a section, and of all below it, without short forms; those that are wrong stay as they are."""

    def spelled(kind: type[Section], data: object) -> object:
        try:
            data = kind.expanded(data)
        except ValueError:
            return data
        return spelled_out(kind, data) if isinstance(data, Mapping) else data

    out = dict(fields)
    for name, (kind, several) in _parts(section).items():
        value = out.get(name)
        if not several:
            out.update({name: spelled(kind, value)} if name in out else {})
        elif isinstance(value, list | tuple):
            out[name] = [spelled(kind, entry) for entry in value]
    return out


def inner_sections(annotation: Any, suffix: str = "") -> Iterator[tuple[type[Section], str]]:
    """The sections in a field's type; behind each `[]` if the field is a list of them."""
    if isinstance(annotation, type) and issubclass(annotation, Section):
        yield annotation, suffix
    inside = "[]" if get_origin(annotation) is tuple else suffix
    for argument in get_args(annotation):
        yield from inner_sections(argument, inside)


@cache
def _parts(section: type[Section]) -> dict[str, tuple[type[Section], bool]]:
    """The sections in a section by their fields, and whether each is a list of them; none that are one of several."""
    found = {info.alias or name: [*inner_sections(info.annotation)] for name, info in section.model_fields.items()}
    return {name: (kinds[0][0], bool(kinds[0][1])) for name, kinds in found.items() if len(kinds) == 1}


def findings(error: ValidationError) -> list[SchemaProblem]:
    """What a failed check of a section found."""
    return [_finding(details, Section) for details in error.errors(include_url=False)]


def known_fields(section: type[BaseModel]) -> list[str]:
    """The names of a section's fields as the file writes them."""
    return [info.alias or name for name, info in section.model_fields.items()]


def exactly_one(fields: Fields, *names: str) -> Iterator[SchemaProblem]:
    """A finding unless exactly one of the fields is there."""
    if not any(name in fields for name in names):
        yield SchemaProblem((), f"one of {_listed(names)} is missing")
    yield from at_most_one(fields, *names)


def at_most_one(fields: Fields, *names: str) -> Iterator[SchemaProblem]:
    """A finding for each of the fields beside the first that is there."""
    first, *others = [name for name in fields if name in names] or [""]
    for other in others:
        yield SchemaProblem((other,), f"cannot stand beside '{first}'; keep one of {_listed(names)}", at_key=True)


def only_with(fields: Fields, name: str, *partners: str) -> Iterator[SchemaProblem]:
    """A finding if the field is there and none of its partners."""
    if name in fields and not any(partner in fields for partner in partners):
        yield SchemaProblem((name,), f"belongs only beside {_listed(partners)}; leave it out", at_key=True)


def suggestion(word: str, known: list[str]) -> str | None:
    """The known word that was probably meant."""
    close = difflib.get_close_matches(word.lower(), known, n=1, cutoff=0.6)
    return close[0] if close else None


def _finding(error: ErrorDetails, section: type[Section]) -> SchemaProblem:
    kind, path = error["type"], error["loc"]
    if kind in (_PLAIN, _AT_KEY):
        return SchemaProblem(path, error["ctx"]["message"], kind == _AT_KEY)
    if kind == "missing" and isinstance(path[-1], int):  # of a pair
        return SchemaProblem(path[:-1], "two values are expected, as in [38.1, 23.7]")
    return SchemaProblem(path, _plain_message(error, section), kind == "extra_forbidden")


def _follows(error: ErrorDetails, errors: list[ErrorDetails], section: type[Section]) -> bool:
    """Whether an error only follows from another one.

    Entries that are wrong are not counted by pydantic, so that their list seems too short; a misspelt field
    is missing under its right name.
    """
    if error["type"] == "too_short":
        return bool(len(error["input"]) >= error["ctx"]["min_length"])
    misspelt = [str(one["loc"][-1]) for one in errors if one["type"] == "extra_forbidden"]
    known = known_fields(section)
    return error["type"] == "missing" and error["loc"][-1] in [suggestion(word, known) for word in misspelt]


def _details(finding: SchemaProblem) -> InitErrorDetails:
    kind = PydanticCustomError(_AT_KEY if finding.at_key else _PLAIN, "{message}", {"message": finding.message})
    return InitErrorDetails(type=kind, loc=finding.path, input=None)


def _plain_message(error: ErrorDetails, section: type[Section]) -> str:
    value, context = shown(error["input"]), error.get("ctx", {})
    match error["type"]:
        case "missing":
            return _missing(str(error["loc"][-1]), section)
        case "extra_forbidden":
            return _unknown(str(error["loc"][-1]), section)
        case "model_type":
            return f"{section.expects or _some_fields(section)} belongs here, not {value}"
        case "tuple_type":
            return f"a list belongs here, in [ ] or with a '-' before each entry, not {value}"
        case "too_short":
            return f"at least {context['min_length']} entries are needed, not {context['actual_length']}"
        case "too_long":
            return f"{context['max_length']} values are expected, not {context['actual_length']}"
        case "bool_type":
            return f"write true or false, not {value}"
        case "literal_error":
            return _not_a_choice(error["input"], str(context["expected"]))
    return f"{value} does not fit here: {error['msg']}"


def _missing(name: str, section: type[Section]) -> str:
    info = next((info for key, info in section.model_fields.items() if name in (key, info.alias)), None)
    example = f", for example '{name}: {info.examples[0]}'" if info is not None and info.examples else ""
    return f"is missing; add it{example}"


def _unknown(name: str, section: type[Section]) -> str:
    if name in section.elsewhere:
        return f"unknown field; write it {section.elsewhere[name]}"
    known = known_fields(section)
    close = suggestion(name, [*known, *section.elsewhere])
    if close is not None and close in section.elsewhere:
        return f"unknown field; did you mean '{close}'? Write it {section.elsewhere[close]}"
    return f"unknown field; did you mean '{close}'?" if close else f"unknown field; known fields: {', '.join(known)}"


def _not_a_choice(value: object, expected: str) -> str:
    choices = re.findall(r"[^', ]+", expected.replace(" or ", ", "))
    close = suggestion(value, choices) if isinstance(value, str) else None
    hint = f"; did you mean {close}?" if close else ""
    return f"write {_listed(choices)}, not {shown(value)}{hint}"


def _some_fields(section: type[Section]) -> str:
    words = "".join(f"{word}, " for word in section.words)
    return f"{words}{'or ' if words else ''}a section with fields ({', '.join(known_fields(section))})"


def _listed(words: tuple[str, ...] | list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"

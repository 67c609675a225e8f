"""The reference of the mission and airframe files for people and for editors, made from the schemas themselves."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin

import yaml
from pydantic.fields import FieldInfo

from gcs_windplan.jobs.missionfile.airframe import AirframeModel
from gcs_windplan.jobs.missionfile.model import MissionModel
from gcs_windplan.jobs.missionfile.section import Section, inner_sections
from gcs_windplan.jobs.missionfile.values import Checked, Measure
from gcs_windplan.units import QUANTITIES

_FILES: Final[Mapping[str, type[Section]]] = {
    "# The mission file": MissionModel,
    "# The airframe file": AirframeModel,
}
_COLUMNS: Final = ("field", "value", "default", "meaning")


def schema_reference() -> str:
    """Every field of the mission and the airframe file as Markdown: values and units, default, meaning."""
    parts: list[str] = []
    for title, root in _FILES.items():
        parts += [title, *([] if parts else [_units_text()])]
        for section, places in _sections(root).items():
            parts.append(f"## {', '.join(places) or 'top level'}")
            parts.append(str(section.__doc__).partition("\n")[0])
            parts.append(_table(_rows(section)))
    return "\n\n".join(parts) + "\n"


def json_schema() -> dict[str, Any]:
    """The JSON schema of the mission file, for editors that complete and check YAML while one writes."""
    schema = MissionModel.model_json_schema(by_alias=True)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "Mission file"}


def _units_text() -> str:
    lines = [
        "A plain number is in the unit in brackets. With a unit, as in `20 kt`, a value may be written in:",
        "",
    ]
    for quantity in QUANTITIES:
        lines.append(f"- {quantity.name.split(' ', 1)[1]}: {', '.join(quantity.units)}")
    return "\n".join(lines)


def _sections(root: type[Section]) -> dict[type[Section], list[str]]:
    """Each kind of section in the order of the file, and the paths at which it stands."""
    places: dict[type[Section], list[str]] = {root: []}

    def visit(section: type[Section], path: str) -> None:
        for name, info in section.model_fields.items():
            for inner, suffix in inner_sections(info.annotation):
                place = f"{path}{info.alias or name}{suffix}"
                places.setdefault(inner, []).append(place)
                visit(inner, f"{place}.")

    visit(root, "")
    return places


def _rows(section: type[Section]) -> Iterator[tuple[str, ...]]:
    for name, info in section.model_fields.items():
        field = f"`{info.alias or name}`"
        yield field, _values(info.annotation, info.metadata), _default(info), str(info.description)


def _values(annotation: Any, metadata: Sequence[object] = ()) -> str:
    """What may be written for a type, in words."""
    own = next((one.describe() for one in metadata if isinstance(one, Checked)), None)
    if own is not None:
        return own
    arguments = get_args(annotation)
    match get_origin(annotation):
        case kind if kind is Annotated:
            return _values(arguments[0], arguments[1:])
        case kind if kind in (Union, types.UnionType):
            return " or ".join(dict.fromkeys(_values(one) for one in arguments if one is not type(None)))
        case kind if kind is Literal:
            return ", ".join(f"`{_yaml(one)}`" for one in arguments)
        case kind if kind is tuple and arguments[-1] is ...:
            return f"list of: {_values(arguments[0])}"
        case kind if kind is tuple:
            return f"[{', '.join(_values(one) for one in arguments)}]"
    if annotation is bool:
        return "`true`, `false`"
    words = getattr(annotation, "words", ())
    return f"section, or words: {', '.join(f'`{word}`' for word in words)}" if words else "section"


def _default(info: FieldInfo) -> str:
    if info.is_required():
        return "required"
    default = info.default
    if default is None or default == ():
        return ""
    measure = next((one for one in info.metadata if isinstance(one, Measure)), None)
    if measure is not None:
        return f"`{default:g} {measure.quantity.unit}`".replace(" `", "`")
    if isinstance(default, Section):
        default = default.model_dump(by_alias=True, exclude_unset=True)
    return f"`{_yaml(default)}`"


def _yaml(value: object) -> str:
    written: str = yaml.safe_dump(value, default_flow_style=True)
    return written.removesuffix("...\n").strip()


def _table(rows: Iterator[tuple[str, ...]]) -> str:
    lines = [_COLUMNS, tuple("---" for _ in _COLUMNS), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)

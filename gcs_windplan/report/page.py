"""The review as one HTML file that needs no network: verdict, findings, map, profile, scene, tables, provenance."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from functools import cache
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from gcs_windplan.assessment import Assessment, Finding
from gcs_windplan.errors import InputError
from gcs_windplan.report import words
from gcs_windplan.report.figures import changes, figures, gain
from gcs_windplan.report.places import place_of
from gcs_windplan.report.three import Library, script_hash, three_js
from gcs_windplan.report.tracks import page_numbers

_SCRIPTS = ("drawing.js", "charts.js", "map.js", "scene.js", "page.js")
_LONG = 60  # rows of a table that is folded away


def render_page(assessments: Sequence[Assessment]) -> str:
    """One mission's review as an HTML page, or two missions' side by side; the same text for the same input.

    Of two the first is what the second is compared with. Raises `InputError` for any other number.
    """
    if not 1 <= len(assessments) <= 2:
        raise InputError(f"a page shows one mission or compares two, not {len(assessments)}")
    numbers = page_numbers(assessments)
    return (
        _environment()
        .get_template("page.html")
        .render(
            missions=[_mission(i, one, len(assessments)) for i, one in enumerate(assessments)],
            changes=changes(*assessments) if len(assessments) == 2 else [],
            gain=gain(*assessments) if len(assessments) == 2 else "",
            title=" and ".join(dict.fromkeys(one.name for one in assessments)),
            numbers=_json(numbers),
            map=numbers["map"],
            mesh=numbers["mesh"],
            **_dress(),
        )
    )


def _mission(place: int, assessment: Assessment, how_many: int) -> dict[str, Any]:
    """One mission as the template wants it."""
    letter = "AB"[place] if how_many > 1 else ""
    return {
        "letter": letter,
        "key": place,
        "it": assessment,
        "verdict": assessment.verdict,
        "verdict_words": words.VERDICTS[assessment.verdict],
        "counts": words.counts(assessment.findings),
        "figures": figures(assessment),
        "findings": [_finding(letter, i, assessment, finding) for i, finding in enumerate(assessment.findings)],
        "summary": words.summary(assessment),
        "long": len(assessment.stops) > _LONG,
    }


def _finding(letter: str, i: int, assessment: Assessment, finding: Finding) -> dict[str, Any]:
    place = place_of(assessment, finding)
    return {
        "it": finding,
        "mark": f"{letter}{i + 1}",
        "index": i,
        "against": words.against_limit(finding),
        "place": place,
    }


def _json(value: Any) -> Markup:
    """JSON that can stand inside a script element: nothing in it ends the element or begins a comment."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False)
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Markup(text)


@cache
def _dress() -> dict[str, Any]:
    """What all pages share: style, script, three.js, and the policy by which a browser runs these and nothing else."""
    folder = files(__package__)
    style = folder.joinpath("page.css").read_text(encoding="utf-8")
    script = "\n".join(folder.joinpath(name).read_text(encoding="utf-8") for name in _SCRIPTS)
    script = f"(() => {{\n'use strict';\n{script}}})();\n"
    library = three_js()
    return {
        "style": Markup(style),
        "script": Markup(script),
        "library": Markup(library.packed) if library else None,
        "policy": _policy(style, script, library),
        "version": version("gcs-windplan"),
    }


def _policy(style: str, script: str, library: Library | None) -> Markup:
    """Nothing from anywhere: only pictures within the page, and the style and scripts that hash to what was written."""
    scripts = [script_hash(script.encode("utf-8"))] + ([library.hash] if library else [])
    styles = "sha256-" + base64.b64encode(hashlib.sha256(style.encode("utf-8")).digest()).decode("ascii")
    allowed = " ".join(f"'{one}'" for one in scripts)
    return Markup(
        f"default-src 'none'; img-src data:; style-src '{styles}'; script-src {allowed};"
        " base-uri 'none'; form-action 'none'"
    )


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("gcs_windplan", "report"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    environment.filters |= {
        "number": words.number,
        "clock": words.clock,
        "bearing": words.bearing,
        "percent": words.percent,
        "wh": words.watt_hours,
    }
    return environment

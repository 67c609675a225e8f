"""Requests and cases of a test, whose fields name those of their scene too."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, TypeVar

from gcs_windplan.assessment import Case
from gcs_windplan.planning.request import Request
from gcs_windplan.scene import Scene

SCENE = {field.name for field in fields(Scene)}
S = TypeVar("S", Request, Case)


def in_scene(**known: Any) -> dict[str, Any]:
    """The fields, those of a scene put into one."""
    scene = Scene(**{name: value for name, value in known.items() if name in SCENE})
    return {"scene": scene, **{name: value for name, value in known.items() if name not in SCENE}}


def changed(asked: S, **changes: Any) -> S:
    """The same with other fields, of its scene too."""
    scene = replace(asked.scene, **{name: value for name, value in changes.items() if name in SCENE})
    return replace(asked, scene=scene, **{name: value for name, value in changes.items() if name not in SCENE})

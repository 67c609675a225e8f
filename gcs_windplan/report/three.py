"""three.js, which draws the scene, out of the page that trimesh brings along for its own viewer."""

from __future__ import annotations

import base64
import gzip
import hashlib
from dataclasses import dataclass
from functools import cache
from typing import Final

_VIEWER_STARTS: Final = "init();"  # the last words of trimesh's script; what stands before only defines


@dataclass(frozen=True, slots=True)
class Script:
    """A script to be carried in a page: packed (gzip, base64), and the hash by which the page's policy lets it run."""

    packed: str
    hash: str


@cache
def three_js() -> Script | None:
    """three.js as packed text; None if this trimesh does not carry it where it is looked for."""
    import trimesh  # 0.6 s that only pages cost
    from trimesh.viewer.notebook import scene_to_html

    page = scene_to_html(trimesh.Scene(trimesh.creation.box()))
    script = page.partition("<script>")[2].rpartition("</script>")[0]
    text, start, _ = script.rpartition(_VIEWER_STARTS)
    if not start or "THREE" not in text:
        return None
    code = text.encode("utf-8")
    packed = gzip.compress(code, compresslevel=9, mtime=0)
    return Script(base64.b64encode(packed).decode("ascii"), script_hash(code))


def script_hash(code: bytes) -> str:
    """A script as a content security policy names it."""
    return "sha256-" + base64.b64encode(hashlib.sha256(code).digest()).decode("ascii")

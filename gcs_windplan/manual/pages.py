"""The pages of the manual by their topics."""

from __future__ import annotations

import difflib
import re
from importlib.resources import files

from gcs_windplan.errors import InputError


def topics() -> dict[str, str]:
    """Each topic with the title of its page, by name."""
    names = sorted(page.name.removesuffix(".md") for page in files(__package__).iterdir() if page.name.endswith(".md"))
    return {name: _read(name).partition("\n")[0].removeprefix("# ") for name in names}


def read_page(topic: str) -> str:
    """The page of a topic, as Markdown.

    Raises
    ------
    InputError
        There is no such topic; with the one that may be meant.
    """
    known = topics()
    if topic not in known:
        close = difflib.get_close_matches(topic.lower(), known, n=1, cutoff=0.6)
        advice = f"did you mean '{close[0]}'?" if close else f"there are {', '.join(known)}"
        raise InputError(f"'{topic}' is no topic of the manual; {advice}")
    # comments speak to the tests alone
    return re.sub(r"^<!--.*?-->\n", "", _read(topic), flags=re.MULTILINE)


def _read(topic: str) -> str:
    return (files(__package__) / f"{topic}.md").read_text(encoding="utf-8")

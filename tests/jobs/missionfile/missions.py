"""Mission texts for the tests: a small good one, and the same with fields replaced or added."""

from pathlib import Path

import pytest

from gcs_windplan.errors import MissionFileError
from gcs_windplan.jobs.missionfile.parsing import MissionDocument, parse_mission

FILE = Path("m.yaml")
FIELDS = {
    "name": "ridge",
    "vehicle": "{airspeed: 12 m/s}",
    "terrain": "{sample: jacksboro}",
    "wind": "{calm: true}",
    "start": "{latitude: 36.5, longitude: -84.3}",
    "goal": "{latitude: 36.6, longitude: -84.2}",
}
ORIGIN = "origin: {latitude: 36.5, longitude: -84.3}"


def mission(**fields: str | None) -> str:
    """The small mission, one field a line; given ones replace its own or follow in line 7, 8, ..."""
    merged = {**FIELDS, **fields}
    return "".join(f"{name}: {value}\n" for name, value in merged.items() if value is not None)


def read(**fields: str | None) -> MissionDocument:
    return parse_mission(mission(**fields), FILE)


def complaints(text: str) -> list[str]:
    """The lines of the error, without the file's name in front."""
    with pytest.raises(MissionFileError) as caught:
        parse_mission(text, FILE)
    lines = str(caught.value).split("\n")
    assert all(line.startswith("m.yaml:") for line in lines)
    return [line.removeprefix("m.yaml:") for line in lines]

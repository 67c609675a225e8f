"""The reference and the JSON schema say what the schema checks."""

import json
import re
from collections.abc import Iterator
from typing import Any

import pytest

from gcs_windplan.jobs.missionfile.model import MissionModel
from gcs_windplan.jobs.missionfile.reference import json_schema, schema_reference
from gcs_windplan.jobs.missionfile.section import Section, known_fields


def sections(kind: type[Section] = Section) -> Iterator[type[Section]]:
    for section in kind.__subclasses__():
        if section.__module__.startswith("gcs_windplan.jobs.missionfile."):
            yield section
        yield from sections(section)


@pytest.mark.parametrize("section", list(sections()), ids=lambda section: section.__name__)
def test_every_field_has_a_description(section: type[Section]) -> None:
    assert section.__doc__
    for name, info in section.model_fields.items():
        assert info.description, name
        assert info.examples or not info.is_required(), f"{name}: a required field shows an example"


def test_every_field_stands_in_the_reference() -> None:
    reference = schema_reference()
    for section in sections():
        for name in known_fields(section):
            assert f"| `{name}` |" in reference
    assert "| `airspeed` | speed [m/s], between 0.1 and 150 | required | cruise speed" in reference
    assert "| `clearance` | length [m], above 0 and at most 300000 | `30 m` |" in reference
    assert "| `from` | angle [deg], between 0 and 360 | required |" in reference
    assert "## start, goal, via[], fence.return_point, rally[]" in reference
    assert "## limits.keep_out[].circle, limits.keep_in[].circle" in reference
    assert "| `fence` | `true`, `false` | `false` | whether the autopilot's own fence holds it too" in reference
    assert "| `battery` | share, between 0 and 0.9 |  | share of the whole capacity that must be left" in reference
    assert "| `order` | `given`, `free` | `given` | in which order `via` is passed" in reference
    assert "| `wind` | section, or words: `calm`, `8 m/s from 270 deg`, `forecast.grib2` | required |" in reference
    assert (
        "| `start` | section, or words: `38.1,23.7`, `38.1,23.7,2100`, `38.1,23.7,80 m agl` | required |" in reference
    )
    assert "- share: %" in reference
    assert "- speed: m/s, km/h, kt, mph, ft/s, ft/min" in reference


def test_the_tables_of_the_reference_are_regular() -> None:
    rows = [line for line in schema_reference().splitlines() if line.startswith("|")]
    assert len(rows) > 80
    assert all(row.count("|") == 5 for row in rows)


def test_the_json_schema_allows_units_and_short_forms() -> None:
    schema = json_schema()
    json.dumps(schema, allow_nan=False)
    kinds = schema["$defs"]
    free, number, text, _ = kinds["VehicleModel"]["properties"]["airspeed"]["anyOf"]
    assert free == {"const": "free"}
    assert number == {"type": "number", "minimum": 0.1, "maximum": 150}
    assert re.search(text["pattern"], "20 kt")
    assert not re.search(text["pattern"], "20 m")
    assert kinds["CostModel"]["anyOf"][0]["enum"] == ["distance", "angle", "hybrid", "time", "energy"]
    assert kinds["PolygonModel"]["anyOf"][0]["type"] == "array"
    words, terrain = kinds["TerrainModel"]["anyOf"]
    assert words == {"type": "string", "examples": ["dem.tif", "sample:jacksboro", "flat:120 m"]}
    assert terrain["properties"]["dem"]["anyOf"][0]["type"] == "string"
    words, wind = kinds["WindModel"]["anyOf"]
    assert words["type"] == "string"
    assert wind["oneOf"][0] == {"required": ["calm"]}
    assert kinds["AreaModel"]["oneOf"] == [{"required": ["polygon"]}, {"required": ["circle"]}]
    assert kinds["AreaModel"]["properties"]["fence"]["default"] is False
    assert "from" in kinds["ConstantWindModel"]["anyOf"][1]["required"]
    share, percent, _ = kinds["LimitsModel"]["properties"]["battery"]["anyOf"]
    assert share == {"type": "number", "minimum": 0, "maximum": 0.9}
    assert re.search(percent["pattern"], "30 %")
    assert schema["properties"]["order"]["enum"] == ["given", "free"]
    assert set(schema["properties"]) == set(known_fields(MissionModel))


def test_every_reference_in_the_json_schema_resolves() -> None:
    schema = json_schema()

    def references(part: Any) -> Iterator[str]:
        if isinstance(part, dict):
            yield from (value for key, value in part.items() if key == "$ref")
            part = list(part.values())
        if isinstance(part, list):
            for inner in part:
                yield from references(inner)

    found = set(references(schema))
    assert found
    assert all(name.removeprefix("#/$defs/") in schema["$defs"] for name in found)

"""Airframe files: good ones, and bad ones with the exact lines that they bring."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import MissionFileError
from gcs_windplan.jobs.missionfile.airframe import parse_airframe, read_airframe
from gcs_windplan.vehicle import FixedWing, Multirotor, PowerTable, RotaryWing

FILE = Path("a.yaml")
FIELDS = {
    "name": "bee",
    "mass": "4.2 kg",
    "battery": "{capacity: 130 Wh}",
    "airspeed": "8 m/s",
    "maximum_airspeed": "15 m/s",
    "power": "{model: multirotor, k1: 0.8554, k2: 0.3051, c2: 0.3177, c4: 0.0296, c5: 0.0279}",
}
WING = "{model: fixed-wing, wing_area: 0.55, aspect_ratio: 15, oswald: 0.9, parasite_drag: 0.043, efficiency: 0.68}"
ROWS = "{airspeed: 0, power: 400 W}, {airspeed: 10, power: 350 W}, {airspeed: 36 mph, power: 0.5 kW}"
TABLE = f"{{model: table, measured: [{ROWS}]}}"


def airframe(**fields: str | None) -> str:
    """The small airframe, one field a line; given ones replace its own or follow in line 7, 8, ..."""
    merged = {**FIELDS, **fields}
    return "".join(f"{name}: {value}\n" for name, value in merged.items() if value is not None)


def complaints(text: str) -> list[str]:
    """The lines of the error, without the file's name in front."""
    with pytest.raises(MissionFileError) as caught:
        parse_airframe(text, FILE)
    lines = str(caught.value).split("\n")
    assert all(line.startswith("a.yaml:") for line in lines)
    return [line.removeprefix("a.yaml:") for line in lines]


def test_an_airframe_with_its_defaults() -> None:
    found = parse_airframe(airframe(), FILE)
    assert (found.name, found.mass, found.maximum_airspeed, found.acceleration) == ("bee", 4.2, 15.0, 2.5)
    assert (found.battery.capacity, found.battery.usable, found.battery.reserve) == (468_000.0, 0.8, 0.2)
    vehicle = found.vehicle
    assert (vehicle.airspeed, vehicle.climb, vehicle.descent, vehicle.type) == (8.0, 2.5, 1.5, "multicopter")
    assert found.power == Multirotor(4.2, 0.8554, 0.3051, 0.3177, 0.0296, 0.0279, 1.225)


def test_an_airframe_with_every_field_in_other_units() -> None:
    found = parse_airframe(
        airframe(
            mass="11000 g",
            battery="{capacity: 2 MJ, usable: 1, reserve: 0}",
            airspeed="90 km/h",
            maximum_airspeed="60 kt",
            type="fixed-wing",
            autopilot="px4",
            climb="500 ft/min",
            descent="3",
            acceleration="1 m/s²",
            power=WING.replace("}", ", stall_airspeed: 30 kt}").replace("0.55", "5500 cm2"),
        ),
        FILE,
    )
    assert found.mass == pytest.approx(11.0)
    assert found.battery.energy_to_plan_with == 2e6
    assert found.maximum_airspeed == pytest.approx(30.8667, abs=1e-4)
    assert (found.vehicle.type, found.vehicle.autopilot, found.acceleration) == ("fixed-wing", "px4", 1.0)
    assert found.vehicle.climb == pytest.approx(2.54)
    assert isinstance(found.power, FixedWing)
    assert found.power.wing_area == pytest.approx(0.55)
    assert found.power.stall_airspeed == pytest.approx(15.4333, abs=1e-4)


def test_the_other_power_models() -> None:
    rotors = "{model: rotary-wing, disc_area: 0.503 m2, solidity: 0.05, tip_speed: 120, efficiency: 0.7}"
    assert parse_airframe(airframe(power=rotors), FILE).power == RotaryWing(
        4.2, 0.503, 0.05, 120.0, 0.012, 0.1, 0.6, 0.7
    )
    found = parse_airframe(airframe(power=TABLE), FILE).power
    assert isinstance(found, PowerTable)
    assert found.measured_airspeeds == pytest.approx((0.0, 10.0, 16.09344))  # 1 mph = 0.447 04 m/s
    assert (found.measured_watts, found.mass) == ((400.0, 350.0, 500.0), 4.2)


CASES = [
    ("name", None, "1:1: name: is missing; add it, for example 'name: small quadcopter'"),
    ("mass", "0", "2:7: mass: must be above 0 kg and at most 1000 kg, not 0"),
    ("mass", "4 l", "2:7: mass: unknown unit 'l' for a mass; known units: kg, g, lb"),
    (
        "mass",
        "4 m",
        "2:7: mass: '4 m' is a length, but a mass belongs here; write for example 4.2 kg, or a plain number in kg",
    ),
    ("battery", "130", "3:10: battery: a battery such as {capacity: 130 Wh} belongs here, not 130"),
    ("battery", "{}", "3:10: battery.capacity: is missing; add it, for example 'capacity: 130 Wh'"),
    ("battery", "{capacity: 99.9}", "3:21: battery.capacity: must be at least 3600 J, not 99.9"),
    ("battery", "{capacity: 500 mWh}", "3:21: battery.capacity: unknown unit 'mWh' for an energy; known units: J, kJ,"),
    ("battery", "{capacity: 1 MJ, usable: 80}", "3:35: battery.usable: must be above 0 and at most 1, not 80"),
    ("battery", "{capacity: 1 MJ, reserve: 1}", "3:36: battery.reserve: must be between 0 and 0.9, not 1"),
    ("battery", "{capacty: 1 MJ}", "3:11: battery.capacty: unknown field; did you mean 'capacity'?"),
    ("airspeed", "20 m/s", "5:19: maximum_airspeed: is less than the cruise airspeed of 20 m/s"),
    ("maximum_airspeed", "7", "5:19: maximum_airspeed: is less than the cruise airspeed of 8 m/s"),
    ("acceleration", "2 m/s", "7:15: acceleration: '2 m/s' is a speed, but an acceleration belongs here"),
    ("power", "450 W", "6:8: power: a power model such as {model: multirotor, k1: ...} belongs here, not '450 W'"),
    ("power", "{k1: 1}", "6:8: power.model: is missing; add it, for example 'model: multirotor'"),
    (
        "power",
        "{model: multi-rotor}",
        "6:16: power.model: write rotary-wing, multirotor, fixed-wing or table, not 'multi-rotor'; did you mean",
    ),
    ("power", "{model: [1]}", "6:16: power.model: write rotary-wing, multirotor, fixed-wing or table, not a list"),
    (
        "power",
        "{model: multirotor, k1: 1, k2: 1, c2: 1, c44: 1}",
        "6:49: power.c44: unknown field; did you mean 'c4'?",
    ),
    ("power", "{model: multirotor, k1: 1, k2: 0, c2: 1, c4: 1}", "6:39: power.k2: must be above 0, not 0"),
    (
        "power",
        "{model: multirotor, k1: 1, k2: 1, c2: 1, c4: 1, density: 0}",
        "6:65: power.density: must be between 0.1 and 2 kg/m3, not 0",
    ),
    (
        "power",
        WING,
        "6:16: power.model: is one of wings, but a multicopter flies; write 'type: fixed-wing', or another",
    ),
    ("type", "fixed-wing", "6:16: power.model: is one of rotors, but a fixed-wing flies; write fixed-wing or table"),
    ("power", TABLE.replace("0 W}", "0}", 1), None),
    ("power", TABLE.replace("power: 350 W", "power: 0"), "6:85: power.measured.1.power: must be above 0 W, not 0"),
    (
        "power",
        TABLE.replace("airspeed: 10", "airspeed: 0"),
        "6:74: power.measured.1.airspeed: must rise from row to row",
    ),
    (
        "power",
        TABLE.replace("airspeed: 0,", "airspeed: 3,"),
        "6:45: power.measured.0.airspeed: the table must begin at 0",
    ),
    (
        "power",
        TABLE.replace("36 mph", "14"),
        "6:104: power.measured.2.airspeed: the table must reach the maximum airspeed of 15 m/s",
    ),
    ("power", "{model: table, measured: [{airspeed: 0, power: 4 W}]}", "6:33: power.measured: at least 2 entries are"),
    (
        "power",
        "{model: table, measured: [5, 6]}",
        "6:34: power.measured.0: a row such as {airspeed: 10 m/s, power: 450",
    ),
]


@pytest.mark.parametrize(("field", "value", "start"), CASES, ids=lambda value: str(value)[:40])
def test_a_wrong_field(field: str, value: str | None, start: str | None) -> None:
    text = airframe(**{field: value})
    if start is None:
        parse_airframe(text, FILE)
    else:
        assert complaints(text)[0].startswith(start)


def test_a_wing_slower_than_its_stall() -> None:
    text = airframe(type="fixed-wing", power=WING.replace("}", ", stall_airspeed: 9 m/s}"))
    assert complaints(text) == ["6:132: power.stall_airspeed: is more than the cruise airspeed of 8 m/s"]


def test_a_table_of_a_wing_begins_at_its_cruise() -> None:
    rows = "[{airspeed: 9, power: 1 kW}, {airspeed: 15, power: 2 kW}]"
    text = airframe(type="fixed-wing", power=f"{{model: table, measured: {rows}}}")
    assert complaints(text) == ["6:45: power.measured.0.airspeed: the table must begin at 8 m/s or below"]


def test_every_problem_is_told_at_once() -> None:
    text = airframe(mass="none", battery="{usable: 2}", power="{model: multirotor, k1: -1, q: 2}", climb="0", wings="2")
    assert [line.split(": ")[1] for line in complaints(text)] == [
        "mass",
        "battery.capacity",
        "battery.usable",
        "power.c2",
        "power.c4",
        "power.k2",
        "power.k1",
        "power.q",
        "climb",
        "wings",
    ]


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "1:1: the airframe file is empty; begin it with 'name: ...'"),
        ("- a\n", "1:1: an airframe file holds fields such as 'name: small quadcopter'; this one holds something else"),
        ("name: a: b", "1:8: this is not YAML"),
        ("name: a\nname: b", "2:1: name: appears twice, first in line 1; keep one of the two"),
        ("name:", "1:6: name: is empty; give it a value or leave the field out"),
        ("name: &a [*a]", "1:7: an alias (*name) stands inside of what it stands for"),
    ],
)
def test_a_text_that_is_no_airframe(text: str, complaint: str) -> None:
    assert any(line.startswith(complaint) for line in complaints(text))


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    def told(path: Path) -> str:
        with pytest.raises(MissionFileError) as caught:
            read_airframe(path)
        return str(caught.value).removeprefix(f"{path}: ")

    path = tmp_path / "a.yaml"
    assert told(path) == "there is no such file; check the name and the folder"
    assert told(tmp_path) == "is a folder; name the airframe file inside of it"
    path.write_bytes(b"name: \xff")
    assert told(path) == "is not UTF-8 text (byte 7); save it as UTF-8"
    path.write_bytes(b"#" * 1_000_001)
    assert told(path) == "is larger than 1 MB; this is not an airframe file"
    path.write_text("\ufeff" + airframe(), encoding="utf-8")
    assert read_airframe(str(path)).name == "bee"


@given(
    st.sampled_from([*FIELDS, "type", "climb"]), st.sampled_from(["~", "[]", "{}", "x", "-1", ".nan", "1e999", "''"])
)
def test_whatever_stands_in_a_field_is_an_airframe_or_has_a_place(field: str, value: str) -> None:
    try:
        parse_airframe(airframe(**{field: value}), FILE)
    except MissionFileError as caught:
        error = caught
    else:
        return
    assert all(problem.file == FILE and problem.line and problem.column for problem in error.problems)
    assert "does not fit here" not in str(error)


def test_a_power_that_no_battery_gives_has_its_place(tmp_path: Path) -> None:
    """Numbers that are right one by one, and together come to nothing that flies."""
    file = tmp_path / "absurd.yaml"
    text = "name: absurd\nmass: 10 kg\nbattery: {capacity: 700 Wh}\nairspeed: 12 m/s\nmaximum_airspeed: 18 m/s\n"
    file.write_text(f"{text}power: {{model: multirotor, k1: 2, k2: 1e-300, c2: 0, c4: 0.14}}\n")
    with pytest.raises(MissionFileError, match=r"absurd\.yaml:6:\d+: power: at the cruise it comes to inf W"):
        read_airframe(file)

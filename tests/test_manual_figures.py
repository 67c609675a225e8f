"""Figures of the manual that no command prints, each from the model or the flight that it stands for."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.paper.cases import CASES, make_rules, make_terrain, make_vehicle
from gcs_windplan.paper.flying import SHAPED, fly_case, sites_of
from gcs_windplan.paper.graphs import lay_uniform
from gcs_windplan.paper.published import ANGLE, DISTANCE, HYBRID
from gcs_windplan.vehicle import best_range_airspeed, energy_per_metre, least_power_airspeed
from tests.flight.test_duration import predicted_duration
from tests.vehicle.test_power_rotors import ZENG

ROOT = Path(__file__).resolve().parents[1]
MANUAL = "\n".join(page.read_text() for page in sorted((ROOT / "gcs_windplan" / "manual").glob("*.md")))


def test_the_mission_shown_is_the_mission_shipped():
    shown = re.search(r"```yaml\n(.*?)\n```", MANUAL, re.DOTALL)
    assert shown is not None
    assert shown[1] == (ROOT / "missions" / "jacksboro.yaml").read_text().rstrip()


def test_the_published_figures_shown_are_the_models():
    """The cells of the model's column, each from the model itself."""
    hexacopter = read_airframe(ROOT / "missions" / "vehicles" / "large_multirotor.yaml").power
    quadcopter = read_airframe(ROOT / "missions" / "vehicles" / "small_quadcopter.yaml").power
    slow = least_power_airspeed(ZENG, 60.0)

    def minutes(mass: float, watt_hours: float) -> str:
        return f"{0.9 * watt_hours * 60 / float(replace(hexacopter, mass=mass).watts(0.0, 0.0)):.1f}"

    large = ", ".join(minutes(10.0 + payload, 6 * 129.96) for payload in (0, 0.5, 1.9, 5.5))
    small = ", ".join(minutes(9.5 + payload, 6 * 99.9) for payload in (0, 0.9, 6.0))
    mean = float(np.mean(energy_per_metre(quadcopter, np.array([4.0, 6.0, 8.0, 10.0, 12.0]), density=1.172))) / 1000
    for cell in (
        f"{float(ZENG.watts(0.0, 0.0)):.1f} W; {float(ZENG.watts(slow, 0.0)):.1f} W at {slow:.2f} m/s;"
        f" {best_range_airspeed(ZENG, 60.0):.2f} m/s",
        f"{large} min",
        f"{small} min",
        f"{mean:.3f} MJ/km in the mean",
    ):
        assert f"| {cell} |" in MANUAL


def test_the_flights_shown_are_the_predicted_ones(shared_data):
    rows = re.findall(r"^\| [\w ,0-9x/]+ \| (\d+) \| ([\d.]+) \| ([\d.]+) \| ([+-][\d.]+) % \|$", MANUAL, re.MULTILINE)
    flights = json.loads((shared_data / "flights" / "arducopter_4.7.json").read_text())
    assert len(rows) == len(flights) == 12
    for (legs, measured, predicted, off), flight in zip(rows, flights, strict=True):
        found = predicted_duration(flight).en_route
        assert int(legs) == len(flight["legs"])
        assert float(measured) == pytest.approx(flight["total"], abs=0.051)
        assert float(predicted) == pytest.approx(found, abs=0.051)
        assert float(off) == pytest.approx(100 * (found / flight["total"] - 1), abs=0.051)


def test_the_papers_cases_shown_are_the_programs():
    terrain = make_terrain()
    rules = make_rules(terrain)
    veil = lay_uniform(rules, sites_of(rules, CASES))
    routes = [fly_case(case, veil, make_vehicle(), rules) for case in CASES]
    for name, key in (("distance", str(DISTANCE)), ("angle", str(ANGLE)), ("hybrid", str(HYBRID)), ("time", SHAPED)):
        row = re.search(
            rf"^\| {name}.* \| [\d.-]+ / ([\d.]+) \| [\d.-]+ / ([\d.]+) \| [\d.-]+ / ([\d.]+) \|$", MANUAL, re.M
        )
        assert row is not None, name
        assert [float(cell) for cell in row.groups()] == pytest.approx([r[key].seconds for r in routes], abs=0.011), (
            name
        )

"""CSV of judged missions, by the rules of RFC 4180."""

from __future__ import annotations

import csv
import io

import pytest

from gcs_windplan.formats.legs_csv import format_legs_csv
from gcs_windplan.wind import ConstantWind
from tests.assessment.cases import airframe, at, judged
from tests.formats.test_kml import REVIEW


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text, newline="")))


def test_a_row_for_each_leg_with_its_units():
    rows = rows_of(format_legs_csv(REVIEW))
    assert len(rows) == len(REVIEW.legs)
    for row, leg in zip(rows, REVIEW.legs, strict=True):
        assert int(row["leg"]) == leg.number
        assert float(row["lowest [m AGL]"]) == pytest.approx(leg.clearance, abs=0.005)
        assert float(row["track [deg true]"]) == pytest.approx(leg.track_deg, abs=0.05)
        assert float(row["time [s]"]) == pytest.approx(leg.seconds, abs=0.05)
        assert row["energy [Wh]"] == ""


def test_lines_end_as_the_rfc_has_it_and_have_as_many_fields():
    text = format_legs_csv(REVIEW)
    assert text.endswith("\r\n")
    assert "\n" not in text.replace("\r\n", "")
    assert len({len(row) for row in csv.reader(io.StringIO(text, newline=""))}) == 1


def test_energy_and_what_never_ends():
    drawn = rows_of(format_legs_csv(judged(at(0, 900), airframe=airframe())))
    assert float(drawn[0]["energy [Wh]"]) > 5
    assert 50 < float(drawn[0]["battery left [%]"]) < 100
    stopped = rows_of(format_legs_csv(judged(at(0, 900), wind=ConstantWind(0.0, -25.0))))
    assert stopped[0]["time [s]"] == "never"

"""A new forecast format is one file with an opener, and one entry in `FORMATS`: then missions are planned in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import gcs_windplan as gw
from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.wind.field_index import Field2D, FieldIndex, Grid, Level
from gcs_windplan.wind.files import anyfile


@contextmanager
def open_toy(path: Path) -> Iterator[FieldIndex]:
    """One line: TOYWIND, then u and v [m/s], the same on a grid of 3 x 3 nodes at 10 and 200 m above ground."""
    _, *numbers = path.read_text().split()
    grid = Grid(np.array([36.0, 36.5, 37.0]), np.array([-85.0, -84.25, -83.5]), "toy")

    def reader(value: float):
        def read(rows: IntArray, columns: IntArray) -> FloatArray:
            return np.full((len(rows), len(columns)), value)

        return read

    fields = tuple(
        Field2D(quantity, Level("height", height), grid, reader(float(number)))
        for height in (10.0, 200.0)
        for quantity, number in zip(("u", "v"), numbers, strict=True)
    )
    yield FieldIndex("toy", fields)


def test_a_toy_format_is_recognised_read_and_planned_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "wind.toy"
    file.write_text("TOYWIND 6.0 -2.0")
    with pytest.raises(gw.WindError, match="is of no format that is known here"):
        gw.read_forecast(file, (36.55, -84.29), terrain="flat:300")
    toy = anyfile.ForecastFormat(lambda head, text: head.startswith(b"TOYWIND"), __name__, "open_toy")
    monkeypatch.setattr(anyfile, "FORMATS", (*anyfile.FORMATS, toy))
    plan = gw.plan(
        gw.Mission(start=(36.55, -84.30), goal=(36.55, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300", wind=file)
    )
    assert plan.legs[0].wind_along == pytest.approx(6.0, abs=0.05)
    assert plan.legs[0].wind_across == pytest.approx(2.0, abs=0.05)

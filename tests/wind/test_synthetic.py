"""The invented wind over the Jacksboro terrain."""

from __future__ import annotations

import runpy
from pathlib import Path

import netCDF4
import numpy as np

FOLDER = Path(__file__).resolve().parents[2] / "missions" / "wind"
HALF_A_CENTIMETRE_PER_SECOND = 0.005001
LARGEST = 60_000  # [bytes]


def test_the_file_is_what_its_script_makes() -> None:
    latitudes, longitudes, u, v = runpy.run_path(str(FOLDER / "synthetic_jacksboro.py"))["synthesize"]()
    with netCDF4.Dataset(FOLDER / "jacksboro_synthetic.nc") as file:
        np.testing.assert_allclose(file["latitude"][:], latitudes, atol=1e-9)
        np.testing.assert_allclose(file["longitude"][:], longitudes, atol=1e-9)
        for name, values in (("u", u), ("v", v)):
            np.testing.assert_allclose(file[name][0], values, atol=HALF_A_CENTIMETRE_PER_SECOND)


def test_it_covers_the_terrain_with_a_margin_and_is_small() -> None:
    path = FOLDER / "jacksboro_synthetic.nc"
    with netCDF4.Dataset(path) as file:
        latitudes, longitudes = file["latitude"][:], file["longitude"][:]
        assert list(file["height"][:5]) == [10, 40, 80, 120, 200]
        assert "not a forecast" in file.title
    assert latitudes.min() < 36.42
    assert latitudes.max() > 36.76
    assert longitudes.min() < -84.44
    assert longitudes.max() > -84.05
    assert path.stat().st_size < LARGEST


def test_ridges_are_windier_than_valleys() -> None:
    with netCDF4.Dataset(FOLDER / "jacksboro_synthetic.nc") as file:
        speed = np.hypot(file["u"][0, 2], file["v"][0, 2])
    assert speed.max() > 1.8 * speed.min()
    assert abs(speed.mean() - 7.0) < 0.5

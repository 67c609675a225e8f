"""Model levels: their numbers, and half levels from all that files may hold."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.wind.netcdf_maker import AXES, Content, everything, wind, write_netcdf

ONE_PASCAL = 1.0
A = np.array([0.0, 2000.0, 5000.0, 3000.0, 0.0])  # [Pa] half levels from the top down
B = np.array([0.0, 0.0, 0.2, 0.7, 1.0])
MID_A, MID_B = (A[1:] + A[:-1]) / 2, (B[1:] + B[:-1]) / 2
HYBRID = {"standard_name": "atmosphere_hybrid_sigma_pressure_coordinate", "positive": "down"}
PA, ONE = {"units": "Pa"}, {"units": "1"}
U4 = wind("lev lat lon", 4, 3, 4)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "trap.nc"


def _levels(path: Path, content: dict[str, Content]) -> tuple[list[float], Any]:
    """The numbers of u's levels, and the half levels."""
    fields = [
        field2d for field2d, _ in everything(write_netcdf(path, {**AXES, **content}))[1] if field2d.quantity == "u"
    ]
    assert {field2d.level.kind for field2d in fields} == {"model"}
    assert len({id(field2d.half_levels) for field2d in fields}) == 1
    return [field2d.level.value for field2d in fields], fields[0].half_levels


def _check(halves: Any) -> None:
    np.testing.assert_allclose(halves[0], A, atol=ONE_PASCAL)
    np.testing.assert_allclose(halves[1], B, atol=1e-6)


def _lev(values: Any, **said: Any) -> Content:
    return "lev", np.asarray(values, dtype=np.float64), {**HYBRID, **said}


@pytest.mark.parametrize("turned", [False, True])
def test_bounds_with_a_formula(path: Path, turned: bool) -> None:
    """CMIP: the axis counts hybrid numbers, and each level has two bounds, from below or from above."""
    way = slice(None, None, -1) if turned else slice(None)
    edges = {"ap_bnds": (A, PA), "b_bnds": (B, ONE)}
    content = {
        "lev": _lev((MID_A / 1e5 + MID_B)[way], bounds="lev_bnds", formula_terms="ap: ap b: b ps: ps"),
        "lev_bnds": ("lev two", np.zeros((4, 2)), {"formula_terms": "ap: ap_bnds b: b_bnds ps: ps"}),
        "ap": ("lev", MID_A[way], PA),
        "b": ("lev", MID_B[way], ONE),
        **{name: ("lev two", np.stack([v[:-1], v[1:]], axis=1)[way, way], said) for name, (v, said) in edges.items()},
        "u": U4,
    }
    numbers, halves = _levels(path, content)
    assert numbers == [1, 2, 3, 4][way]
    _check(halves)
    del content["lev_bnds"][2]["formula_terms"]  # type: ignore[attr-defined]
    _check(_levels(path, content)[1])


@pytest.mark.parametrize("subset", [[1, 2, 3, 4], [3, 4]])
def test_interfaces_as_cdo_writes_ecmwfs(path: Path, subset: list[int]) -> None:
    lev: Content = ("lev", subset, {"standard_name": "hybrid_sigma_pressure", "units": "level"})
    content = {
        "lev": lev,
        "hyai": ("nhyi", A, PA),
        "hybi": ("nhyi", B, ONE),
        "u": wind("lev lat lon", len(subset), 3, 4),
    }
    numbers, halves = _levels(path, content)
    assert numbers == subset
    _check(halves)


def test_interfaces_as_ncar_writes_them_with_a_reference_pressure(path: Path) -> None:
    """CAM: the axis is 1000 (a + b), and hyai has no unit but that of P0."""
    content = {
        "lev": _lev(1000 * (MID_A / 1e5 + MID_B), units="hPa", formula_terms="a: hyam b: hybm p0: P0 ps: PS"),
        "ilev": ("ilev", 1000 * (A / 1e5 + B), {**HYBRID, "formula_terms": "a: hyai b: hybi p0: P0 ps: PS"}),
        "P0": ("", 1000.0, {"units": "hPa"}),
        "hyam": ("lev", MID_A / 1e5, ONE),
        "hybm": ("lev", MID_B, ONE),
        "hyai": ("ilev", A / 1e5, ONE),
        "hybi": ("ilev", B, ONE),
        "u": U4,
    }
    numbers, halves = _levels(path, content)
    assert numbers == [1, 2, 3, 4]
    _check(halves)


def test_an_axis_of_half_levels_with_a_formula_of_its_own(path: Path) -> None:
    content = {
        "lev": _lev([1, 2, 3, 4]),
        "half": ("half", np.arange(5.0), {**HYBRID, "formula_terms": "ap: edges_a b: edges_b ps: ps"}),
        "edges_a": ("half", A[::-1], PA),
        "edges_b": ("half", B[::-1], ONE),
        "u": U4,
    }
    _check(_levels(path, content)[1])


def test_the_table_of_the_grib_message(path: Path) -> None:
    pv = {"GRIB_pv": np.concatenate([A, B])}
    content = {"hybrid": ("hybrid", [3.0, 4.0], HYBRID), "u": wind("hybrid lat lon", 2, 3, 4, **pv)}
    numbers, halves = _levels(path, content)
    assert numbers == [3, 4]
    _check(halves)


def test_half_levels_follow_from_all_levels_down_to_the_ground(path: Path) -> None:
    """Met Norway: eta from 0 to 1, a and b of the levels alone."""
    content = {
        "lev": _lev(MID_A / 101325 + MID_B, formula_terms="ap: ap b: b ps: surface_air_pressure"),
        "ap": ("lev", MID_A.astype(np.float32), PA),
        "b": ("lev", MID_B.astype(np.float32), ONE),
        "u": U4,
    }
    numbers, halves = _levels(path, content)
    assert numbers == [1, 2, 3, 4]
    _check(halves)
    part = {**content, "lev": _lev([3, 4], formula_terms="ap: ap b: b"), "u": wind("lev lat lon", 2, 3, 4)}
    part |= {"ap": ("lev", MID_A[2:], PA), "b": ("lev", MID_B[2:], ONE)}
    assert _levels(path, part) == ([3, 4], None)


@pytest.mark.parametrize(
    ("values", "said", "numbers"),
    [
        ([1, 2, 3, 4], {}, [1, 2, 3, 4]),
        ([0.1, 0.3, 0.7, 0.9], {}, [1, 2, 3, 4]),
        ([0.9, 0.7, 0.3, 0.1], {}, [4, 3, 2, 1]),
        ([1, 2, 3, 4], {"positive": "up"}, [4, 3, 2, 1]),
        ([20.0, 80.0, 200.0, 500.0], {**HYBRID, "positive": "up"}, [4, 3, 2, 1]),
    ],
)
def test_numbers_count_from_the_top(path: Path, values: list[float], said: dict[str, str], numbers: list[int]) -> None:
    assert _levels(path, {"lev": _lev(values, **said), "u": U4}) == (numbers, None)


def test_numbers_that_go_the_wrong_way_are_counted_anew(path: Path) -> None:
    """a and b show that level 1 is at the ground."""
    content = {
        "lev": _lev([1, 2, 3, 4], formula_terms="ap: ap b: b"),
        "ap": ("lev", MID_A[::-1], PA),
        "b": ("lev", MID_B[::-1], ONE),
        "u": U4,
    }
    numbers, halves = _levels(path, content)
    assert numbers == [4, 3, 2, 1]
    _check(halves)


def test_bounds_of_a_part_are_no_half_levels_of_all(path: Path) -> None:
    for part, values in ((slice(2, 4), [3, 4]), (slice(0, 2), [1, 2])):
        content = {
            "lev": _lev(values, bounds="lev_bnds", formula_terms="ap: ap b: b"),
            "lev_bnds": ("lev two", np.zeros((2, 2)), {"formula_terms": "ap: ap_bnds b: b_bnds"}),
            "ap": ("lev", MID_A[part], PA),
            "b": ("lev", MID_B[part], ONE),
            "ap_bnds": ("lev two", np.stack([A[:-1], A[1:]], axis=1)[part], PA),
            "b_bnds": ("lev two", np.stack([B[:-1], B[1:]], axis=1)[part], ONE),
            "u": wind("lev lat lon", 2, 3, 4),
        }
        assert _levels(path, content) == (values, None)


def test_levels_that_are_only_counted_are_not_mixed_up_with_others(path: Path) -> None:
    content = {
        "lev": _lev([0.7, 0.9]),
        "lev_2": ("lev_2", [0.3, 0.7, 0.9], HYBRID),
        "u": wind("lev lat lon", 2, 3, 4),
        "t": wind("lev_2 lat lon", 3, 3, 4, units="K"),
    }
    index, fields = everything(write_netcdf(path, {**AXES, **content}))
    assert {field2d.name for field2d, _ in fields} == {"u"}
    assert index.unused[0].startswith("t: its model levels lev_2 are others than lev, and neither has numbers")


def test_coefficients_of_unknown_units_are_none(path: Path) -> None:
    content = {"lev": _lev([1, 2, 3, 4]), "hyai": ("nhyi", A, {}), "hybi": ("nhyi", B, ONE), "u": U4}
    assert _levels(path, content)[1] is None

"""Model levels of a NetCDF file: their numbers, and the half levels between them.

At a half level the pressure is a + b · the surface's (CF 1.11, appendix D, hybrid sigma pressure coordinate).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.errors import WindError
from gcs_windplan.wind.files.cf import Variable
from gcs_windplan.wind.files.netcdf_file import NetcdfFile
from gcs_windplan.wind.files.units import PRESSURE, compact, unit_factor

#: a [Pa] and b, from the top down.
Halves: TypeAlias = tuple[FloatArray, FloatArray]

_SEA_LEVEL = 101325.0  # [Pa] ISO 2533: only used to sort levels
_A_AT_GROUND, _B_AT_GROUND = 5.0, 1e-3  # [Pa], [1]: how far from 0 and 1 what adds up from single precision may end


@dataclass(frozen=True, slots=True, eq=False)
class ModelLevels:
    """The numbers of the levels along an axis, 1 at the top, and the half levels as far as the file has them all.

    `counted`: the numbers only count the axis's own levels, for its values are no numbers of levels.
    """

    numbers: tuple[int, ...]
    half_levels: Halves | None
    counted: bool


def model_levels(file: NetcdfFile, axis: Variable, data: Variable) -> ModelLevels:
    """The levels along an axis that counts some kind of model level; `data` is what lies on them."""
    values = file.values(axis).ravel()
    middles = _coefficients(file, axis)
    if middles is not None:
        top_down = _top_down(*middles)
    else:
        top_down = np.argsort(-values if axis.text("positive") == "up" else values)
    in_order = values[top_down]
    whole = bool((in_order == np.round(in_order)).all() and in_order[0] >= 1 and (np.diff(in_order) > 0).all())
    numbers = tuple(int(number) for number in (values if whole else np.argsort(top_down) + 1))
    for found in (
        _between_bounds(file, axis, top_down),
        _interfaces(file, axis, data),
        None if middles is None else _from_full_levels(*(part[top_down] for part in middles)),
    ):
        if found is None or not _ends_at_ground(*found):
            continue
        last = len(found[0]) - 1
        if max(numbers) <= last and (whole or len(numbers) == last):
            return ModelLevels(numbers, found, not whole)
    return ModelLevels(numbers, None, not whole)


def _top_down(a: FloatArray, b: FloatArray) -> IntArray:
    return np.argsort(a + b * _SEA_LEVEL)


def _ends_at_ground(a: FloatArray, b: FloatArray) -> bool:
    return bool(abs(a[-1]) < _A_AT_GROUND and abs(b[-1] - 1) < _B_AT_GROUND)


def _between_bounds(file: NetcdfFile, axis: Variable, top_down: IntArray) -> Halves | None:
    """Half levels from the bounds of all levels, where each level ends at the next one's beginning."""
    bounds = file.variables.get(axis.raw_text("bounds"))
    edges = None if bounds is None else _coefficients(file, bounds) or _by_suffix(file, axis, bounds)
    if edges is None or any(edge.ndim != 2 or edge.shape != (len(top_down), 2) for edge in edges):
        return None
    a, b = (edge[top_down] for edge in edges)
    upper_first = (a[:, 0] + b[:, 0] * _SEA_LEVEL) <= (a[:, 1] + b[:, 1] * _SEA_LEVEL)
    a, b = (np.where(upper_first[:, np.newaxis], edge, edge[:, ::-1]) for edge in (a, b))
    if not (np.allclose(a[1:, 0], a[:-1, 1], atol=0.1) and np.allclose(b[1:, 0], b[:-1, 1], atol=1e-6)):
        return None
    return np.append(a[:, 0], a[-1, 1]), np.append(b[:, 0], b[-1, 1])


def _by_suffix(file: NetcdfFile, axis: Variable, bounds: Variable) -> Halves | None:
    """The bounds of a and b by the names that CMIP's files give them, where the bounds have no formula."""
    terms = {term: f"{name}_bnds" for term, name in _terms(axis).items() if term in ("a", "ap", "b")}
    terms |= {term: name for term, name in _terms(axis).items() if term == "p0"}
    return _evaluated(file, terms)


def _interfaces(file: NetcdfFile, axis: Variable, data: Variable) -> Halves | None:
    """Half levels listed on their own: ECMWF's and NCAR's hyai and hybi, an axis with a formula, GRIB's pv."""
    found = _evaluated(file, {"ap": "hyai", "b": "hybi"}) or _evaluated(file, {"a": "hyai", "b": "hybi", "p0": "P0"})
    others = [v for v in file.variables.values() if v.shape == (axis.shape[0] + 1,)] if len(axis.shape) == 1 else []
    for other in others:
        found = found or _coefficients(file, other)
    pv = np.array(data.numbers("GRIB_pv"))
    if found is None and len(pv) and len(pv) % 2 == 0:
        found = pv[: len(pv) // 2], pv[len(pv) // 2 :]
    if found is None or found[0].ndim != 1:
        return None
    order = _top_down(*found)
    return found[0][order], found[1][order]


def _from_full_levels(a: FloatArray, b: FloatArray) -> Halves | None:
    """Half levels from the levels in the middle between them, from the top down, where all levels are there.

    Each level's a and b are the means of its two half levels' (Simmons and Burridge 1981), and both are 0 at the top.
    """
    halves = []
    for middles in (a, b):
        edges = [0.0]
        for middle in middles:
            edges.append(2 * float(middle) - edges[-1])
        halves.append(np.array(edges))
    pressures = halves[0] + halves[1] * _SEA_LEVEL
    return (halves[0], halves[1]) if (np.diff(pressures) > 0).all() else None


def _coefficients(file: NetcdfFile, variable: Variable) -> Halves | None:
    """a [Pa] and b as the formula of a coordinate, or of its bounds, names them."""
    terms = _terms(variable)
    found = _evaluated(file, terms) if terms else None
    return found if found is not None and found[0].shape[:1] == variable.shape[:1] else None


def _terms(variable: Variable) -> dict[str, str]:
    return dict(re.findall(r"(\w+)\s*:\s*(\S+)", variable.raw_text("formula_terms")))


def _evaluated(file: NetcdfFile, terms: dict[str, str]) -> Halves | None:
    """a [Pa] and b of the variables that stand for `ap`, or `a` and `p0`, and `b`; None where the file lacks them."""
    named = {term: file.variables[name] for term, name in terms.items() if name in file.variables}
    if "b" not in named or not all(file.is_numeric(variable) for variable in named.values()):
        return None
    try:
        if "ap" in named:
            a = file.values(named["ap"]) * unit_factor(named["ap"].name, named["ap"].raw_text("units"), PRESSURE)
        elif "a" in named and "p0" in named and compact(named["a"].raw_text("units")) not in PRESSURE.factors:
            reference = file.values(named["p0"]) * unit_factor(
                named["p0"].name, named["p0"].raw_text("units"), PRESSURE
            )
            a = file.values(named["a"]) * reference.ravel()[0]
        else:
            return None
    except WindError:
        return None
    b = file.values(named["b"])
    known = a.shape == b.shape and np.isfinite(a).all() and np.isfinite(b).all()
    return (a, b) if known else None

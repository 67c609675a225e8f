"""Panels along legs: where the wind is looked at for Simpson's rule, and which panels are halved.

A panel is a part of a leg, from a share of it on (`begins`) and so wide (`widths`), with the winds (3, w) at its
begin, middle and end; w numbers for each member of an ensemble, one after the other.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from gcs_windplan.arrays import FloatArray, IntArray
from gcs_windplan.kernels.compiled import compiled

Panels: TypeAlias = tuple[IntArray, FloatArray, FloatArray, FloatArray]  # leg, begins, widths, winds
_END, _MIDDLE = 1.0 / 6.0, 4.0 / 6.0  # Simpson's weights


@compiled
def knots_of(panels: IntArray) -> tuple[IntArray, FloatArray]:
    """Leg and share of it of each knot, 2 p + 1 of them on a leg of p = `panels` (n,) equal panels."""
    count = 0
    for i in range(panels.size):
        count += 2 * panels[i] + 1
    leg, share = np.empty(count, np.int64), np.empty(count)
    k = 0
    for i in range(panels.size):
        for j in range(2 * panels[i] + 1):
            leg[k], share[k] = i, j / (2.0 * panels[i])
            k += 1
    return leg, share


@compiled
def places_along(starts: FloatArray, vectors: FloatArray, leg: IntArray, share: FloatArray) -> FloatArray:
    """The places (k, 3) at shares (k,) of legs from `starts` (n, 3) along `vectors` (n, 3)."""
    places = np.empty((leg.size, 3))
    for k in range(leg.size):
        for axis in range(3):
            places[k, axis] = starts[leg[k], axis] + share[k] * vectors[leg[k], axis]
    return places


@compiled
def panels_of(panels: IntArray, winds: FloatArray) -> Panels:
    """The equal panels of legs whose knots' winds (k, w) are known: leg, begins, widths (p,), winds (p, 3, w)."""
    count = panels.sum()
    leg, begins, widths = np.empty(count, np.int64), np.empty(count), np.empty(count)
    found = np.empty((count, 3, winds.shape[1]))
    p, knot = 0, 0
    for i in range(panels.size):
        for j in range(panels[i]):
            leg[p], begins[p], widths[p] = i, j / panels[i], 1.0 / panels[i]
            for place in range(3):
                for axis in range(winds.shape[1]):
                    found[p, place, axis] = winds[knot + 2 * j + place, axis]
            p += 1
        knot += 2 * panels[i] + 1
    return leg, begins, widths, found


@compiled
def parted(
    leg: IntArray, begins: FloatArray, widths: FloatArray, winds: FloatArray, calm: float
) -> tuple[Panels, Panels, IntArray, FloatArray]:
    """The panels to keep and those to halve, in which the wind changes by more than `calm` over half of them.

    With these come leg and share of the places where their halves' winds are not known yet: the middles of all first
    halves, then those of the second. A panel in which a wind is not known (NaN) is kept.
    """
    rough = np.zeros(leg.size, np.bool_)
    for p in range(leg.size):
        most = 0.0
        for half in range(2):
            for axis in range(winds.shape[2]):
                change = abs(winds[p, half + 1, axis] - winds[p, half, axis])
                if change > most or math.isnan(change):
                    most = change
        rough[p] = most > calm
    more = leg[rough]
    quarter_legs, quarters = np.empty(2 * more.size, np.int64), np.empty(2 * more.size)
    first = begins[rough]
    wide = widths[rough]
    for p in range(more.size):
        quarter_legs[p] = quarter_legs[p + more.size] = more[p]
        quarters[p], quarters[p + more.size] = first[p] + 0.25 * wide[p], first[p] + 0.75 * wide[p]
    smooth = ~rough
    kept = leg[smooth], begins[smooth], widths[smooth], winds[smooth]
    return kept, (more, first, wide, winds[rough]), quarter_legs, quarters


@compiled
def halves_of(leg: IntArray, begins: FloatArray, widths: FloatArray, winds: FloatArray, middles: FloatArray) -> Panels:
    """Panels halved, all first halves and then all second ones, whose `middles` have winds (2 p, w)."""
    count = leg.size
    legs, firsts, wides = np.empty(2 * count, np.int64), np.empty(2 * count), np.empty(2 * count)
    found = np.empty((2 * count, 3, winds.shape[2]))
    for half in range(2):
        for p in range(count):
            k = p + half * count
            legs[k], wides[k] = leg[p], 0.5 * widths[p]
            firsts[k] = begins[p] + 0.5 * widths[p] if half else begins[p]
            for axis in range(winds.shape[2]):
                found[k, 0, axis] = winds[p, half, axis]
                found[k, 1, axis] = middles[k, axis]
                found[k, 2, axis] = winds[p, half + 1, axis]
    return legs, firsts, wides, found


@compiled
def samples_of(
    legs: int, members: int, leg: IntArray, begins: FloatArray, widths: FloatArray, winds: FloatArray
) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
    """The samples of all panels in the order of their legs, three a panel: `first` (legs + 1,), weights, shares (k,),
    winds (members, k, w)."""
    first = np.zeros(legs + 1, np.int64)
    for p in range(leg.size):
        first[leg[p] + 1] += 3
    for i in range(legs):
        first[i + 1] += first[i]
    place = first[:-1].copy()
    weights, shares = np.empty(3 * leg.size), np.empty(3 * leg.size)
    width = winds.shape[2] // members
    found = np.empty((members, 3 * leg.size, width))
    for p in range(leg.size):
        k = place[leg[p]]
        place[leg[p]] += 3
        for knot in range(3):
            weights[k + knot] = widths[p] * (_MIDDLE if knot == 1 else _END)
            shares[k + knot] = begins[p] + widths[p] * (0.5 * knot)
            for member in range(members):
                for axis in range(width):
                    found[member, k + knot, axis] = winds[p, knot, member * width + axis]
    return first, weights, shares, found

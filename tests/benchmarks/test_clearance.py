"""Legs against real ground: our exact smallest clearance beside embreex's hit or not."""

from __future__ import annotations

import pytest

from tests.benchmarks.jobs import LEGS
from tests.benchmarks.measuring import measure


@pytest.mark.parametrize("length", sorted(LEGS))
def test_legs_over_real_ground(table, length):
    ours, embree = measure("our_legs", length), measure("embree_legs", length)
    count = LEGS[length]
    for who, one in (("gcs_windplan, smallest and largest height", ours), ("trimesh + embreex, hit or not", embree)):
        table(f"Clearance: legs over {ours.answer['triangles']:,.0f} triangles of the Jacksboro fault, one core").row(
            who=who, leg_m=length, legs=f"{count:,}", seconds=f"{one.seconds:.3f}",
            million_legs_per_s=f"{count / one.seconds / 1e6:.2f}", build_s=f"{one.build:.2f}",
            peak_MB=f"{one.peak_mb:.0f}",
        )  # fmt: skip
    # embree reckons in single precision: a leg that grazes the ground may differ
    assert embree.answer["hits"] == pytest.approx(ours.answer["hits"], rel=1e-3)

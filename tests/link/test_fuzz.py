"""2000 random uploads over bad links: "accepted" is never a lie, and every run ends."""

from __future__ import annotations

from collections import Counter

from . import fuzz


def test_accepted_is_never_a_lie() -> None:
    runs = [fuzz.run(seed) for seed in range(2000)]
    verdicts = Counter(each.verdict for each in runs)
    assert [each.seed for each in runs if each.falsely] == []
    assert [each.seed for each in runs if not each.bounded] == []
    assert verdicts["accepted"] > 1200  # most links can be borne
    assert verdicts["rejected"] > 50
    assert verdicts["unknown"] > 50
    assert fuzz.table(runs).splitlines()[3].split() == [
        "all",
        "2000",
        *(str(verdicts[name]) for name in ("accepted", "rejected", "unknown")),
        "0",
    ]


def test_the_fuzz_would_notice() -> None:
    """Without reading back some of the same runs do lie, and the fuzz says so."""
    runs = [fuzz.run(seed, verify=False) for seed in range(400)]
    assert sum(each.falsely for each in runs) > 5

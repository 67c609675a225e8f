"""Values of all kinds as JSON."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest

from gcs_windplan.json_text import json_text, json_value, rounded, rounded_number
from gcs_windplan.mission import Command


@dataclass(frozen=True)
class Row:
    speed: float
    places: np.ndarray


def test_what_is_not_known_or_infinite_is_null():
    assert json_value([1.5, math.nan, math.inf, -math.inf]) == [1.5, None, None, None]
    assert json_value(np.array([[1.0, np.nan]])) == [[1.0, None]]


def test_moments_are_in_utc():
    noon_in_oslo = datetime(2026, 7, 1, 12, tzinfo=timezone(timedelta(hours=2)))
    assert json_value(noon_in_oslo) == "2026-07-01T10:00:00+00:00"


def test_values_become_objects_with_their_fields():
    assert json_value(Row(3.0, np.array([1, 2]))) == {"speed": 3.0, "places": [1, 2]}
    assert json_value({Command.NAV_LAND: Path("a/b"), 2: (True, None, "x")}) == {"21": "a/b", "2": [True, None, "x"]}


def test_numbers_lose_the_noise_of_sums_only():
    assert json.loads(json_text(0.1 + 0.2)) == 0.3
    assert json_value(149.165237416) == 149.165237416
    assert json_value(np.float64(-0.5)) == -0.5
    assert json_value(2**60) == 2**60


def test_text_is_short_without_an_indent():
    assert json_text({"a": [1, "ü"]}, indent=None) == '{"a":[1,"ü"]}'


def test_anything_else_is_an_error():
    with pytest.raises(TypeError, match="object"):
        json_text(object())


def test_rounded_numbers_are_whole_where_they_can_be():
    assert rounded([1.04, 2.0, -0.01, math.nan, 1e300], 1) == [1, 2, 0, None, int(1e300)]
    assert rounded_number(None, 1) is None
    assert rounded_number(2.25, 2) == 2.25

"""Items and missions check themselves."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs_windplan.errors import InputError
from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems, degrees_e7

HERE = GeoPoint(46.8, 9.8)


@given(st.integers(-1_800_000_000, 1_800_000_000))
def test_degrees_of_an_integer_come_back_as_that_integer(units: int) -> None:
    assert degrees_e7(units / 1e7) == units


def test_truncation_would_lose_a_unit() -> None:
    """One of the 6 % of coordinates that peers get wrong."""
    spoiled = [units for units in range(468_000_000, 468_001_000) if int(units / 1e7 * 1e7) != units]
    assert spoiled
    assert all(degrees_e7(units / 1e7) == units for units in spoiled)


def test_items_with_nan_compare_equal() -> None:
    first = MissionItem(3, 16, (0, 0, 0, float("nan")), 46.8, 9.8, 50)
    second = MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, (0, 0, 0, -math.nan), 46.8, 9.8, 50)
    assert first == second
    assert hash(first) == hash(second)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"command": -1}, "command -1 is not between 0 and 65535"),
        ({"command": 65536}, "command 65536 is not between"),
        ({"frame": 256}, "frame 256 is not between 0 and 255"),
        ({"params": (0, 0, 0)}, "not four numbers"),
        ({"params": (0, 0, 0, math.inf)}, "finite or NaN"),
        ({"latitude_deg": math.nan}, "is not finite"),
        ({"altitude": math.inf}, "of NAV_WAYPOINT is not finite"),
        ({"latitude_deg": 91.0}, "latitude 91.0 is not between -90 and 90"),
        ({"longitude_deg": -181.0}, "longitude -181.0 is not between -180 and 180"),
    ],
)
def test_an_item_that_cannot_be_is_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        MissionItem(**{"frame": 3, "command": 16, **changes})  # type: ignore[arg-type]


def test_without_a_place_parameters_5_to_7_are_free() -> None:
    shot = MissionItem(Frame.GLOBAL, 203, (0, 0, 0, 0), 1.0, 300.0, 5.0)
    assert not shot.has_place
    assert (shot.x, shot.y) == (1, 300)


def test_zero_zero_means_here_and_is_no_place() -> None:
    assert not MissionItem(Frame.GLOBAL, Command.NAV_TAKEOFF).has_place
    assert MissionItem(Frame.GLOBAL, Command.NAV_TAKEOFF, longitude_deg=9.8).has_place
    assert not MissionItem(Frame.MISSION, Command.NAV_WAYPOINT, latitude_deg=46.8).has_place


def test_places_travel_scaled_in_global_frames_only() -> None:
    place = {"latitude_deg": 46.80000005, "longitude_deg": -9.8}
    item = MissionItem(Frame.GLOBAL_RELATIVE_ALT, Command.NAV_WAYPOINT, **place)  # type: ignore[arg-type]
    assert (item.x, item.y) == (item.lat_e7, item.lon_e7) == (468000000, -98000000)
    assert MissionItem(Frame.MISSION, Command.DO_LAND_START, **place).x == 47  # type: ignore[arg-type]


def test_missions_check_vehicle_and_speeds() -> None:
    with pytest.raises(InputError, match="autopilot 'apm' is neither"):
        MissionItems((), autopilot="apm")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="vehicle type 'boat' is neither"):
        MissionItems((), vehicle_type="boat")  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"cruise speed 0 m/s is not a positive number"):
        MissionItems((), cruise_speed=0)
    with pytest.raises(InputError, match="hover speed nan m/s"):
        MissionItems((), hover_speed=math.nan)
    with pytest.raises(InputError, match="home's altitude is nan"):
        Home(HERE, math.nan)


def test_reprs_are_tidy() -> None:
    item = MissionItem(3, 16, (0, 0, 0, math.nan), 46.8, 9.8, 50, autocontinue=False)
    place = "46.8000000, 9.8000000, 50.000 in GLOBAL_RELATIVE_ALT"
    assert repr(item) == f"<NAV_WAYPOINT (0, 0, 0, nan) at {place}, waits>"
    mission = MissionItems((item,), Home(HERE, 1560.0), "px4", "multicopter")
    assert repr(mission) == "<Mission of 1 items, home 46.8000000, 9.8000000, 1560.0 m, px4, multicopter>"
    assert repr(MissionItems(())) == "<Mission of 0 items, no home>"

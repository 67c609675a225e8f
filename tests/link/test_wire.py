"""Items on the wire: degrees to integers and back, and what cannot travel."""

from __future__ import annotations

import math
import struct
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from gcs_windplan.errors import InputError
from gcs_windplan.link.codec import Codec
from gcs_windplan.link.wire import item_to_message, message_to_item
from gcs_windplan.mission import Command, Frame, MissionItem

singles = st.floats(width=32, allow_infinity=False)
heights = st.floats(-500, 9000, width=32)
places = st.tuples(st.integers(-900_000_000, 900_000_000), st.integers(-1_800_000_000, 1_800_000_000))


def sent(item: MissionItem, seq: int = 0):
    return Codec(2, 2).decode(Codec(1, 1).encode(item_to_message(item, seq, 2, 2, 0)))[0]


@given(st.tuples(singles, singles, singles, singles), places, heights, st.booleans())
def test_there_and_back(params, place, height, proceed):
    """Every coordinate of 1e-7 degrees comes back as it was, to the bit."""
    latitude, longitude = place
    item = MissionItem(3, Command.NAV_WAYPOINT, params, latitude / 1e7, longitude / 1e7, height, proceed)
    message = sent(item)
    assert (message.x, message.y) == place
    assert message_to_item(message) == item


@given(st.floats(-90, 90), st.floats(-180, 180))
def test_coordinates_are_rounded(latitude, longitude):
    message = sent(MissionItem(0, Command.NAV_WAYPOINT, (0, 0, 0, 0), latitude, longitude))
    assert abs(message.x - latitude * 1e7) <= 0.5 + 1e-6
    assert abs(message.y - longitude * 1e7) <= 0.5 + 1e-6


def test_parameters_in_place_of_a_place_are_not_scaled():
    item = MissionItem(Frame.MISSION, 203, (0, 0, 0, 0), 1.0, 5.0, 2.5)  # DO_DIGICAM_CONTROL
    message = sent(item)
    assert (message.x, message.y, message.z) == (1, 5, 2.5)
    assert message_to_item(message) == item


def test_deprecated_frames_become_plain_ones():
    frames = [sent(MissionItem(frame, Command.NAV_WAYPOINT)).frame for frame in (0, 2, 3, 5, 6, 10, 11)]
    assert frames == [0, 2, 3, 0, 3, 10, 10]


def test_nan_travels():
    message = sent(MissionItem(3, Command.NAV_WAYPOINT, (0, 0, 0, math.nan), 46.8, 9.8, 50))
    assert math.isnan(message.param4)
    assert math.isnan(message_to_item(message).params[3])


@pytest.mark.parametrize(
    "item",
    [
        MissionItem(3, Command.NAV_WAYPOINT, (1e39, 0, 0, 0)),
        MissionItem(3, Command.NAV_WAYPOINT, (0, 0, 0, 0), 0, 0, -1e39),
        MissionItem(Frame.MISSION, 203, (0, 0, 0, 0), 3e9, 0, 0),
    ],
)
def test_numbers_that_do_not_fit_are_refused(item):
    with pytest.raises(InputError, match=r"item 4 .* too large for MAVLink"):
        item_to_message(item, 4, 1, 1, 0)


def test_largest_numbers_fit():
    largest = struct.unpack("<f", b"\xff\xff\x7f\x7f")[0]
    assert message_to_item(sent(MissionItem(0, 16, (largest, -largest, 0, 0)))).params[:2] == (largest, -largest)


@pytest.mark.parametrize(
    ("command", "x", "z"),
    [(Command.NAV_WAYPOINT, 0, math.nan), (Command.NAV_WAYPOINT, 0, math.inf), (Command.NAV_WAYPOINT, 910_000_000, 0)],
)
def test_items_that_cannot_be_are_refused(command, x, z):
    message = mavlink.MAVLink_mission_item_int_message(1, 1, 0, 3, command, 0, 1, 0, 0, 0, 0, x, 0, z)
    with pytest.raises(InputError):
        message_to_item(message)


def test_an_unset_seventh_parameter_is_no_altitude():
    message = mavlink.MAVLink_mission_item_int_message(1, 1, 0, 2, Command.NAV_DELAY, 0, 1, 5, 0, 0, 0, 0, 0, math.nan)
    assert message_to_item(message) == MissionItem(2, Command.NAV_DELAY, (5, 0, 0, 0))


@pytest.mark.parametrize("frame", [Frame.MISSION, Frame.GLOBAL, Frame.GLOBAL_RELATIVE_ALT])
def test_parts_of_parameters_that_travel_whole_are_refused(frame):
    for number, numbers in ((5, (0.6, 0.0)), (6, (0.0, 0.6))):
        item = MissionItem(frame, 187, (0, 0, 0, 0), *numbers, 0.0)  # DO_SET_ACTUATOR
        text = f"item 4 \\(DO_SET_ACTUATOR\\) has 0.6 as parameter {number}, which MAVLink carries as a whole number"
        with pytest.raises(InputError, match=text):
            item_to_message(item, 4, 1, 1, 0)


def test_a_place_in_a_frame_without_degrees_is_refused():
    item = MissionItem(Frame.MISSION, Command.DO_LAND_START, (0, 0, 0, 0), 47.39, 8.54, 50.0)
    with pytest.raises(InputError, match=r"item 3 \(DO_LAND_START\) has the latitude 47\.39 in frame MISSION"):
        item_to_message(item, 3, 1, 1, 0)
    with pytest.raises(InputError, match=r"the longitude 8\.54 in frame MISSION, .* give it a global frame"):
        item_to_message(replace(item, latitude_deg=0.0), 3, 1, 1, 0)
    assert sent(replace(item, frame=Frame.GLOBAL)).x == 473_900_000

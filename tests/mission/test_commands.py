"""Numbers and names of commands and frames."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from gcs_windplan.mission import (
    Command,
    Frame,
    command_name,
    frame_name,
    is_global,
    plain_frame,
    scales_place,
    takes_place,
)


def test_numbers_are_those_of_the_specification() -> None:
    """MAVLink common.xml, MAV_CMD and MAV_FRAME."""
    assert (Command.NAV_WAYPOINT, Command.NAV_RETURN_TO_LAUNCH, Command.NAV_LAND, Command.NAV_TAKEOFF) == (
        16,
        20,
        21,
        22,
    )
    assert (Command.NAV_SPLINE_WAYPOINT, Command.DO_JUMP, Command.DO_CHANGE_SPEED) == (82, 177, 178)
    assert list(Frame) == [0, 2, 3, 5, 6, 10, 11]


def test_names() -> None:
    assert command_name(178) == "DO_CHANGE_SPEED"
    assert command_name(65000) == "command 65000"
    assert frame_name(3) == "GLOBAL_RELATIVE_ALT"
    assert frame_name(200) == "frame 200"


@pytest.mark.parametrize(("frame", "plain"), [(5, 0), (6, 3), (11, 10), (0, 0), (2, 2), (3, 3), (99, 99)])
def test_int_frames_mean_the_plain_ones(frame: int, plain: int) -> None:
    assert plain_frame(frame) == plain
    assert is_global(frame) == (plain in (0, 3, 10))


def test_which_commands_take_a_place() -> None:
    assert all(takes_place(command) for command in (16, 17, 18, 19, 21, 22, 31, 82, 84, 85, 189))
    assert not any(takes_place(command) for command in (20, 93, 177, 178, 203, 65000))


@pytest.mark.parametrize(
    ("command", "frame", "scaled"),
    [(16, 3, True), (16, 2, False), (203, 0, False), (65000, 3, True), (65000, 2, False)],
)
def test_which_places_travel_scaled(command: int, frame: int, scaled: bool) -> None:
    assert scales_place(command, frame) == scaled


def test_importing_missions_and_formats_leaves_the_process_alone_and_is_light() -> None:
    code = (
        "import os, sys; before = dict(os.environ); import gcs_windplan.mission, gcs_windplan.formats; "
        "assert dict(os.environ) == before; "
        "assert not {'numba', 'scipy', 'pymavlink.mavutil', 'matplotlib'} & set(sys.modules), 'heavy'"
    )
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MAVLINK")}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr

"""What a firmware is to this package: what it takes of a mission, stores, changes and ignores, and how it flies.

A firmware's facts stand in one file beside this one, as data with their sources. The lint, the comparison with what was
read back and the stand-in vehicle read them there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from gcs_windplan.mission.commands import Frame, plain_frame
from gcs_windplan.mission.firmware.storage import NONE, Storage
from gcs_windplan.mission.firmware.whole_numbers import CENTIMETRE, CutAltitude
from gcs_windplan.vehicle import Autopilot, MotionProfile, VehicleType

MissionType: TypeAlias = Literal["mission", "fence", "rally"]
Activity: TypeAlias = Literal["hold", "mission", "guided", "return", "land"]
"""What a vehicle does: stay, fly the mission, go where it is told, return, land."""

ParameterKind: TypeAlias = Literal["int8", "int16", "int32", "real32"]


@dataclass(frozen=True, slots=True)
class CommandRule:
    """What a firmware stores of a command.

    `params` are the ways of the seven parameters. With `place` 5 to 7 are a latitude, a longitude and an altitude, and
    the frame is looked at. `nan` are the parameters, counted from 1, that may be NaN; `choices`, where not empty, the
    values that parameter 1, cut to a whole number, may have.
    """

    params: tuple[Storage, ...]
    place: bool = False
    nan: tuple[int, ...] = ()
    choices: tuple[int, ...] = ()


def stores(
    *params: Storage, place: bool = False, nan: tuple[int, ...] = (), choices: tuple[int, ...] = ()
) -> CommandRule:
    """A rule whose other parameters are not stored."""
    return CommandRule(params + (NONE,) * (7 - len(params)), place, nan, choices)


@dataclass(frozen=True, slots=True)
class Mode:
    """A flight mode: HEARTBEAT's `custom_mode` and the flags of its `base_mode` (MAV_MODE_FLAG)."""

    name: str
    number: int
    activity: Activity
    flags: int


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter's default and type.

    `field` names what of a `MotionProfile` it sets, in units of `unit` SI units; "" where it sets nothing there.
    """

    value: float
    kind: ParameterKind = "real32"
    field: str = ""
    unit: float = 1.0


@dataclass(frozen=True, slots=True)
class Jumps:
    """How DO_JUMP counts.

    `first` is the number of the first item, `forever` the count that never ends, None where there is none. More than
    `in_a_row`, with nothing between them, lead nowhere; `tracked` is how many counted jumps a small board keeps track
    of, None for all.
    """

    first: int
    forever: int | None
    in_a_row: int
    tracked: int | None = None


@dataclass(frozen=True, slots=True)
class Feasibility:
    """What is looked at before a mission that was taken is flown; distances [m], slopes [deg].

    `positions` are commands that lead to a place; `waypoints` those that no take-off may follow.
    """

    positions: frozenset[int]
    waypoints: frozenset[int]
    first_waypoint: float
    far_first_waypoint: float
    gate_apart: float
    landing_required: bool
    steepest_approach: float
    approach_lenience: float


@dataclass(frozen=True, slots=True)
class Transfers:
    """How missions travel to and from the vehicle.

    `home_item`: item 0 is home, whatever is sent. `whole`: the types that take the old one's place only when they are
    complete. `ask_again` and `give_up` [s] are the vehicle's patience, `booting` [s] how long it takes none after boot.
    `repeats_acceptance`: the last item sent again is accepted again. `minds_sequence`: an item out of turn is answered
    with INVALID_SEQUENCE, and the upload goes on. `frame_first`: the frame is refused before the command.
    `reads_back_int`: frames come back in their deprecated _INT form.
    """

    home_item: bool
    whole: frozenset[MissionType]
    ask_again: float
    give_up: float
    booting: float
    repeats_acceptance: bool
    minds_sequence: bool
    frame_first: bool
    reads_back_int: bool


@dataclass(frozen=True, slots=True, eq=False)
class Firmware:
    """A firmware for one kind of vehicle, or what it has in common for all kinds (`vehicle_type` None, `variants`).

    What it is: `name` in a sentence, `family` the name for all kinds, `mav_autopilot` a HEARTBEAT's number for it,
    `version` as AUTOPILOT_VERSION writes it.

    What it takes: `commands`, with what it stores of them; those of `placeless`, where that is not None, it takes in
    frame MISSION by the rules there, and those of `commands` in global frames only. `frames` are those that it takes
    for places, plain, `rally_frames` those for rally points. `altitude` stores heights of missions, `rally` those of
    rally points; they must stay below `highest` and `rally_highest` [m]. `fence` are the commands of fences.
    `capacity` counts what fits on common boards, home included. `checks_numbers`: NaN, infinity and places that are
    not on Earth are refused.

    What it does: `navigation` are the commands that take their time; all others are done on the way. `ignored` are
    taken and never carried out, `quadplane_only` on a QuadPlane alone; any of `not_flown` keeps a mission on the
    ground, any of `vtol_only` but on a VTOL. `zero_altitude` are the commands at which a height of 0 means the present
    one, in the frames of `zero_frames`; `zero_place_is_here` says so of latitude and longitude. `takeoff` says what
    comes of a mission without one: it is refused, the vehicle climbs by itself, or nothing. `lowest_takeoff` [m] is the
    least that one climbs. `takeoff_goes_to_place`: it is followed by a leg to its place. `lands_and_goes_on`: a mission
    goes on after a landing with a new take-off. `ends_over_home`: one that ends in the air leads a fixed-wing home.
    `circles` are the commands whose parameter of that index is the radius of circles flown, `circle_radius` [m] the
    one flown where none is named. A polygon of its fence has at most `fence_corners`.

    How it flies by default: `motion` is a multicopter's, `motion_measured` whether all of it was seen in its simulator
    and nothing only supposed. `cruise` [m/s] is a fixed-wing's airspeed and `plane_return` [m] its height above home on
    the way back, None where that is a multicopter's and never lower than it flies. Its own simulator stands at
    `simulator_home` (latitude, longitude [deg], height AMSL [m]).

    How it talks: the first of `modes` is the one after boot, `own_modes` name those that it takes for what it does.
    `integers_as_bytes`: an integer parameter travels as its bytes in a float's place, not as its value (mavlink.io,
    Parameter Protocol). `mode_parts`: MAV_CMD_DO_SET_MODE names a mode by main and sub mode. `starts_armed`:
    MISSION_START arms the vehicle. `stream_groups`: REQUEST_DATA_STREAM is answered. `guided_takeoff` [m] is how high a
    commanded take-off without a height leads, None where it must name one above home and be guided.
    """

    autopilot: Autopilot
    name: str
    family: str
    vehicle_type: VehicleType | None
    mav_autopilot: int
    version: int
    commands: Mapping[int, CommandRule]
    placeless: Mapping[int, CommandRule] | None
    fence: Mapping[int, CommandRule]
    frames: frozenset[int]
    rally_frames: frozenset[int]
    rally: Storage
    altitude: Storage
    highest: float | None
    rally_highest: float | None
    capacity: Mapping[MissionType, int]
    checks_numbers: bool
    stores_autocontinue: bool
    jumps: Jumps
    transfers: Transfers
    navigation: frozenset[int]
    takeoff: Literal["required", "climbs first", "optional"]
    lowest_takeoff: float | None
    takeoff_goes_to_place: bool
    lands_and_goes_on: bool
    ends_over_home: bool
    zero_place_is_here: bool
    circles: Mapping[int, int]
    circle_radius: float
    motion: MotionProfile
    motion_measured: bool
    modes: tuple[Mode, ...]
    own_modes: Mapping[Activity, str]
    parameters: Mapping[str, Parameter]
    integers_as_bytes: bool
    mode_parts: bool
    starts_armed: bool
    stream_groups: bool
    guided_takeoff: float | None
    cruise: float
    simulator_home: tuple[float, float, float]
    plane_return: float | None
    zero_altitude: frozenset[int] = frozenset()
    zero_frames: frozenset[int] = frozenset()
    ignored: frozenset[int] = frozenset()
    quadplane_only: frozenset[int] = frozenset()
    vtol_only: frozenset[int] = frozenset()
    not_flown: frozenset[int] = frozenset()
    feasibility: Feasibility | None = None
    fence_corners: int | None = None
    variants: tuple[Firmware, ...] = field(default=(), repr=False)

    @property
    def full_name(self) -> str:
        """The name with the kind of vehicle, where the name does not tell it."""
        if self.vehicle_type is None or self.name != self.family:
            return self.name
        return f"{self.name} {self.vehicle_type}"

    def takes(self, command: int) -> bool:
        """Whether it takes the command into a mission in any frame; what it does with it is another question."""
        return command in self.commands or command in (self.placeless or ())

    def rule(self, command: int, frame: int | None = None) -> CommandRule | None:
        """The rule of a command in a frame, or without one in the frame that it is taken in; None where it is not."""
        if self.placeless is None:
            return self.commands.get(command)
        if frame is None:
            return self.commands.get(command) or self.placeless.get(command)
        return (self.placeless if frame == Frame.MISSION else self.commands).get(command)

    def takes_frame(self, command: int, frame: int) -> bool:
        """Whether the frame is one that it takes the command's place in; without a place it may not look at it."""
        rule = self.rule(command, frame)
        looks = self.transfers.frame_first or (rule is not None and rule.place)
        return not looks or plain_frame(frame) in self.frames

    def means_present_altitude(self, command: int, frame: int, altitude: float) -> bool:
        """Whether an item's height is taken for: stay as high as you are."""
        is_zero = abs(altitude) < CENTIMETRE
        return is_zero and command in self.zero_altitude and plain_frame(frame) in self.zero_frames

    @property
    def cuts_altitudes(self) -> bool:
        """Whether heights are stored in centimetres."""
        return isinstance(self.altitude, CutAltitude)

    def mode_for(self, activity: Activity) -> Mode:
        """The mode in which the vehicle does something of its own, or stays where it is."""
        return next(mode for mode in self.modes if mode.name == self.own_modes[activity])

    def mode_numbered(self, number: int) -> Mode | None:
        """The mode with a `custom_mode`, None where there is none here."""
        return next((mode for mode in self.modes if mode.number == number), None)

    @property
    def uploads_whole(self) -> bool:
        """Whether a mission that was broken off leaves the old one as it is."""
        return "mission" in self.transfers.whole

"""The airframe file: a vehicle's speeds, mass, battery and power, checked like a mission file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, ClassVar, Final, Literal, TypeAlias

from pydantic import BeforeValidator, ConfigDict, Field

from gcs_windplan.errors import InputError, MissionFileError, Problem
from gcs_windplan.jobs.missionfile.checking import check_text, read_text
from gcs_windplan.jobs.missionfile.marks import Marks
from gcs_windplan.jobs.missionfile.section import Fields, SchemaProblem, Section
from gcs_windplan.jobs.missionfile.values import (
    AIRSPEED,
    Acceleration,
    AirDensity,
    Airspeed,
    Capacity,
    Coefficient,
    Label,
    Mass,
    Measure,
    PositiveArea,
    PositiveNumber,
    PositivePower,
    PositiveSpeed,
    Reserve,
    Share,
    Speed,
)
from gcs_windplan.jobs.words import AutopilotName, VehicleKind
from gcs_windplan.units import SPEED
from gcs_windplan.vehicle import Airframe, Battery, FixedWing, Multirotor, PowerModel, PowerTable, RotaryWing, Vehicle

_KIND: Final = "airframe file"
_LARGEST_FILE: Final = 1_000_000  # bytes
_MEASURED: Final = Measure(SPEED, at_least=0)


class BatteryModel(Section):
    """The battery."""

    expects: ClassVar[str] = "a battery such as {capacity: 130 Wh}"

    capacity: Capacity = Field(description="energy from full to empty", examples=["130 Wh"])
    usable: Share = Field(default=0.8, description="share of the capacity that may be drawn at all")
    reserve: Reserve = Field(
        default=0.2, description="share of the usable energy to come home with; a mission's limits may ask for more"
    )


class RotaryWingModel(Section):
    """Rotors by theory: Zeng et al. 2019, doi:10.1109/TWC.2019.2902559, with climb."""

    model: Literal["rotary-wing"] = Field(description="`rotary-wing`", examples=["rotary-wing"])
    disc_area: PositiveArea = Field(description="A, swept by all rotors together", examples=["0.503 m2"])
    solidity: PositiveNumber = Field(description="s, blade area by disc area", examples=["0.05"])
    tip_speed: PositiveSpeed = Field(description="U, of the blades' tips in hover", examples=["120 m/s"])
    blade_drag: Coefficient = Field(default=0.012, description="δ, profile drag coefficient of the blades")
    induced_excess: Coefficient = Field(default=0.1, description="k, what an uneven inflow adds to the induced power")
    body_drag: Coefficient = Field(default=0.6, description="d0, flat plate area of the body by blade area")
    efficiency: Share = Field(default=1.0, description="share of the battery's power that reaches the rotors")


class MultirotorModel(Section):
    """Rotors by coefficients fitted to flights: Liu et al. 2017, doi:10.1109/ICUAS.2017.7991310."""

    model: Literal["multirotor"] = Field(description="`multirotor`", examples=["multirotor"])
    k1: Coefficient = Field(description="induced power", examples=["0.8554"])
    k2: PositiveNumber = Field(description="induced velocity, √(kg/m)", examples=["0.3051"])
    c2: Coefficient = Field(description="power of the blades, √(m/kg)", examples=["0.3177"])
    c4: Coefficient = Field(description="drag, kg/m", examples=["0.0296"])
    c5: Coefficient = Field(default=0.0, description="lift in forward flight, kg/m")
    density: AirDensity = Field(default=1.225, description="of the air in which the coefficients were found")

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Hovering that takes no power."""
        if fields.get("k1") == 0 and fields.get("c2") == 0:
            yield SchemaProblem(("c2",), "cannot be 0 with k1 at 0 as well; hovering takes power")


class FixedWingModel(Section):
    """A wing with a parabolic drag polar, and a propeller."""

    model: Literal["fixed-wing"] = Field(description="`fixed-wing`", examples=["fixed-wing"])
    wing_area: PositiveArea = Field(description="S", examples=["0.55 m2"])
    aspect_ratio: PositiveNumber = Field(description="span² by wing area", examples=["15.2"])
    oswald: Share = Field(description="e, Oswald's efficiency", examples=["0.9"])
    parasite_drag: PositiveNumber = Field(description="CD0, drag coefficient without lift", examples=["0.043"])
    efficiency: Share = Field(description="from the battery to the thrust", examples=["0.68"])
    stall_airspeed: Speed = Field(default=0.0, description="no slower than this, at sea level")


class MeasurementModel(Section):
    """A row of a power table."""

    expects: ClassVar[str] = "a row such as {airspeed: 10 m/s, power: 450 W}"

    airspeed: Speed = Field(description="level airspeed; rising from row to row", examples=["10 m/s"])
    power: PositivePower = Field(description="drawn from the battery", examples=["450 W"])


class PowerTableModel(Section):
    """Measured power against airspeed, straight lines in between."""

    model: Literal["table"] = Field(description="`table`", examples=["table"])
    measured: tuple[MeasurementModel, ...] = Field(
        min_length=2, description="rows by airspeed", examples=["[{airspeed: 0, power: 400 W}]"]
    )
    density: AirDensity = Field(default=1.225, description="of the air in which it was measured")
    climb_efficiency: Share = Field(default=0.5, description="weight times climb rate by the power that it adds")

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Airspeeds that do not rise."""
        for row, (slower, faster) in enumerate(pairwise(_measured_airspeeds(fields)), 1):
            if slower is not None and faster is not None and not faster > slower:
                yield SchemaProblem(
                    ("measured", row, "airspeed"), f"must rise from row to row; the one before is {slower:g}"
                )


class PowerChoiceModel(Section):
    """What every power model says: which one it is."""

    model_config = ConfigDict(extra="ignore")
    expects: ClassVar[str] = "a power model such as {model: multirotor, k1: ...}"

    model: Literal["rotary-wing", "multirotor", "fixed-wing", "table"] = Field(
        description="the power model", examples=["multirotor"]
    )


_SECTIONS: Final[Mapping[object, type[Section]]] = {
    "rotary-wing": RotaryWingModel,
    "multirotor": MultirotorModel,
    "fixed-wing": FixedWingModel,
    "table": PowerTableModel,
}


def _chosen(data: object) -> Section:
    """The section of the model that is named, or the complaint that none of them is."""
    named = data.get("model") if isinstance(data, dict) else None
    section = _SECTIONS.get(named if isinstance(named, str) else None, PowerChoiceModel)
    return section.model_validate(data)


PowerSection: TypeAlias = Annotated[
    RotaryWingModel | MultirotorModel | FixedWingModel | PowerTableModel, BeforeValidator(_chosen)
]


class AirframeModel(Section):
    """An airframe file."""

    name: Label = Field(description="of the airframe", examples=["small quadcopter"])
    type: VehicleKind = Field(default="multicopter", description="kind of airframe")
    autopilot: AutopilotName = Field(default="ardupilot", description="its firmware")
    mass: Mass = Field(description="all that flies: battery and payload too", examples=["4.2 kg"])
    battery: BatteryModel = Field(description="what it flies on", examples=["{capacity: 130 Wh}"])
    airspeed: Airspeed = Field(description="cruise speed through the air", examples=["12 m/s"])
    maximum_airspeed: Airspeed = Field(description="largest speed through the air", examples=["18 m/s"])
    climb: PositiveSpeed = Field(default=2.5, description="largest speed upwards")
    descent: PositiveSpeed = Field(default=1.5, description="largest speed downwards")
    acceleration: Acceleration = Field(default=2.5, description="level, along the track")
    power: PowerSection = Field(description="what it draws in flight", examples=["{model: multirotor, k1: ...}"])

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Speeds and a power model that do not go together."""
        power = fields.get("power")
        cruise, fastest = (AIRSPEED.read_or_none(fields.get(name)) for name in ("airspeed", "maximum_airspeed"))
        if cruise is not None and fastest is not None and fastest < cruise:
            yield SchemaProblem(("maximum_airspeed",), f"is less than the cruise airspeed of {cruise:g} m/s")
        if not isinstance(power, dict):
            return
        winged = fields.get("type", "multicopter") == "fixed-wing"
        yield from _wrong_kind(power.get("model"), winged)
        yield from _stalled(power, cruise)
        yield from _not_measured(power, cruise if winged else 0.0, fastest)


def read_airframe(path: Path | str) -> Airframe:
    """The airframe in a file; raises `MissionFileError` with every problem, by file, line and column.

    >>> import gcs_windplan as gw
    >>> gw.read_airframe("missions/vehicles/fixed_wing.yaml").vehicle.type
    'fixed-wing'
    """
    file = Path(path)
    return parse_airframe(read_text(file, _KIND, _LARGEST_FILE), file)


def parse_airframe(text: str, file: Path) -> Airframe:
    """The airframe in a YAML text; `file` names it in messages.

    Raises `MissionFileError` with every problem, in the order of the lines.
    """
    model, marks = check_text(AirframeModel, text, file, _KIND, "name: small quadcopter")
    try:
        return _airframe(model)
    except InputError as error:  # numbers that are right one by one
        raise MissionFileError([_placed(problem, marks, file) for problem in error.problems]) from None


def _placed(problem: Problem, marks: Marks, file: Path) -> Problem:
    """A problem of an airframe at its field's place in the file."""
    path = tuple((problem.field or "").split("."))
    line, column = marks.place(path)
    return replace(problem, file=file, line=line, column=column)


def _airframe(model: AirframeModel) -> Airframe:
    vehicle = Vehicle(model.airspeed, model.climb, model.descent, model.type, model.autopilot)
    battery = Battery(**model.battery.model_dump())
    power = _power(model.power, model.mass)
    return Airframe(model.name, vehicle, model.mass, battery, power, model.maximum_airspeed, model.acceleration)


def _power(model: PowerSection, mass: float) -> PowerModel:
    fields: dict[str, Any] = model.model_dump(exclude={"model"})
    match model:
        case RotaryWingModel():
            return RotaryWing(mass, **fields)
        case MultirotorModel():
            return Multirotor(mass, **fields)
        case FixedWingModel():
            return FixedWing(mass, **fields)
        case PowerTableModel(measured=rows):
            speeds, watts = tuple(row.airspeed for row in rows), tuple(row.power for row in rows)
            return PowerTable(mass, speeds, watts, model.density, model.climb_efficiency)


def _wrong_kind(named: object, winged: bool) -> Iterator[SchemaProblem]:
    """A power model of another kind of airframe."""
    if winged and named in ("rotary-wing", "multirotor"):
        yield SchemaProblem(("power", "model"), "is one of rotors, but a fixed-wing flies; write fixed-wing or table")
    if not winged and named == "fixed-wing":
        message = "is one of wings, but a multicopter flies; write 'type: fixed-wing', or another model"
        yield SchemaProblem(("power", "model"), message)


def _stalled(power: Fields, cruise: float | None) -> Iterator[SchemaProblem]:
    """A cruise below the stall."""
    stall = AIRSPEED.read_or_none(power.get("stall_airspeed"))
    if stall is not None and cruise is not None and stall > cruise:
        yield SchemaProblem(("power", "stall_airspeed"), f"is more than the cruise airspeed of {cruise:g} m/s")


def _not_measured(power: Fields, slowest: float | None, fastest: float | None) -> Iterator[SchemaProblem]:
    """A table that does not reach over the airspeeds that are flown."""
    known = _measured_airspeeds(power) if power.get("model") == "table" else []
    if len(known) < 2:
        return
    first, last = known[0], known[-1]
    if first is not None and slowest is not None and first > slowest:
        yield SchemaProblem(("power", "measured", 0, "airspeed"), f"the table must begin at {slowest:g} m/s or below")
    if last is not None and fastest is not None and last < fastest:
        place = ("power", "measured", len(known) - 1, "airspeed")
        yield SchemaProblem(place, f"the table must reach the maximum airspeed of {fastest:g} m/s")


def _measured_airspeeds(power: Fields) -> list[float | None]:
    """The airspeeds of a table's rows, None where they are not right."""
    rows = power.get("measured")
    if not isinstance(rows, list):
        return []
    return [_MEASURED.read_or_none(row.get("airspeed")) if isinstance(row, dict) else None for row in rows]

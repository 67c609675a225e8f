"""The vehicle of a mission: a value, or an airframe's file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeAlias

from gcs_windplan.jobs.missionfile.airframe import read_airframe
from gcs_windplan.vehicle import Airframe, Vehicle


@dataclass(frozen=True, slots=True)
class AirframeFile:
    """An airframe's file, and what a mission says of its vehicle otherwise than it does."""

    path: Path
    changes: Mapping[str, Any] = field(default_factory=dict)


#: A vehicle, an airframe (with which energy is known), or an airframe's file.
VehicleWords: TypeAlias = "Vehicle | Airframe | AirframeFile | str | os.PathLike[str]"


def load_vehicle(words: VehicleWords) -> tuple[Vehicle, Airframe | None]:
    """The vehicle, and its airframe where that is known. Raises `MissionFileError` for the airframe's file."""
    match words:
        case Vehicle():
            return words, None
        case Airframe():
            return words.vehicle, words
        case AirframeFile():
            airframe = read_airframe(words.path)
            return replace(airframe.vehicle, **words.changes), airframe
    airframe = read_airframe(Path(words))
    return airframe.vehicle, airframe


def has_airframe(words: VehicleWords) -> bool:
    """Whether the vehicle's power and battery will be known."""
    return not isinstance(words, Vehicle)


def airframe_path(words: VehicleWords) -> Path | None:
    """The airframe's file, where there is one."""
    if isinstance(words, AirframeFile):
        return words.path
    return Path(words) if isinstance(words, str | os.PathLike) else None

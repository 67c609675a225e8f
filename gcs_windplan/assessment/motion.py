"""How a vehicle flies straight pieces in wind: airspeed, speed over ground, power."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.arrays import BoolArray, FloatArray
from gcs_windplan.assessment.case import Case
from gcs_windplan.vehicle import air_density

_UPRIGHT = 1e-6  # [m] of level way for a metre of length: straight up
_LOWEST, _HIGHEST = -2000.0, 11_000.0  # [m] ISO 2533, as far as `air_density` goes
_HEADINGS = 12  # on a circle
_STUCK = 0.01  # [m/s] slower than this it stands against the wind


@dataclass(frozen=True, slots=True, eq=False)
class MotionCommand:
    """Where and how fast n samples are meant to go, (n,) each but for `direction` (n, 3), a unit vector.

    `slope` [m/s] is the speed along the slope that a multicopter comes to at most. `air` is a fixed-wing's airspeed,
    `ground` the least ground speed that it keeps to, 0 where none was commanded.
    """

    direction: FloatArray
    slope: FloatArray
    ground: FloatArray
    air: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """What flying takes at n samples, (n,) each [m/s]: along the slope, over ground, through the air, upwards.

    `needed` is the airspeed that the command asks for, beyond what the vehicle reaches where it is slower for that;
    `stopped` where it cannot make headway. Wind `along` from behind and `across` from left to right.
    """

    speed: FloatArray
    ground: FloatArray
    air: FloatArray
    climb: FloatArray
    needed: FloatArray
    along: FloatArray
    across: FloatArray
    stopped: BoolArray


def motion_in(winds: FloatArray, command: MotionCommand, case: Case) -> Motion:
    """How the vehicle flies in winds (n, 3) [m/s] by the exact wind triangle.

    A multicopter holds the ground speed commanded, as far as its largest airspeed allows; a fixed-wing holds its
    airspeed, raised where a ground speed is commanded that it would not reach.
    """
    level = np.hypot(command.direction[:, 0], command.direction[:, 1])
    upright = level <= _UPRIGHT
    safe = np.where(upright, 1.0, level)
    track = command.direction[:, :2] / safe[:, None]
    along = np.where(upright, 0.0, (winds[:, :2] * track).sum(axis=1))
    across = np.where(upright, 0.0, winds[:, 0] * track[:, 1] - winds[:, 1] * track[:, 0])
    if case.hovers:
        ground, air, needed = _held_over_ground(command.slope * level, along, across, case.fastest)
    else:
        ground, air, needed = _held_through_air(command, along, across, case.fastest)
    blowing = np.hypot(winds[:, 0], winds[:, 1])
    air = np.where(upright, blowing if case.hovers else air, air)
    needed = np.where(upright, air, needed)
    speed = np.where(upright, command.slope, ground / safe)
    stopped = np.where(upright, (blowing > case.fastest) & case.hovers, ground <= _STUCK)
    climb = speed * command.direction[:, 2] - winds[:, 2]
    return Motion(speed, np.where(upright, 0.0, ground), air, climb, needed, along, across, stopped)


def density_at(altitudes: FloatArray | float) -> FloatArray:
    """The standard atmosphere's density [kg/m³]; beyond where it is known, that of the nearest height."""
    return np.asarray(air_density(np.clip(altitudes, _LOWEST, _HIGHEST)))


def watts(motion: Motion, altitudes: FloatArray, case: Case) -> FloatArray | None:
    """The power at samples (n,) [W] at heights AMSL (n,) [m], None where the airframe is not known."""
    if case.airframe is None:
        return None
    return np.asarray(case.airframe.power.watts(np.abs(motion.air), motion.climb, density_at(altitudes)))


def waiting_watts(winds: FloatArray, altitudes: FloatArray, climb: FloatArray, case: Case) -> FloatArray | None:
    """The power (n,) [W] for staying over a place in winds (n, 3), or climbing or descending there [m/s]."""
    if case.airframe is None:
        return None
    density = density_at(altitudes)
    air = np.hypot(winds[:, 0], winds[:, 1]) if case.hovers else np.full(len(winds), case.cruise)
    return np.asarray(case.airframe.power.watts(air, climb - winds[:, 2], density))


def energy(power: FloatArray, seconds: FloatArray) -> FloatArray:
    """What powers [W] take in their times [J]; nothing in no time, even at the infinite power below a stall."""
    return np.asarray(np.where(seconds > 0, power, 0.0) * seconds)


def circling_watts(winds: FloatArray, altitudes: FloatArray, speeds: FloatArray, case: Case) -> FloatArray | None:
    """The mean power (n,) [W] on circles that are flown at ground speeds (n,) in winds (n, 3) [m/s]."""
    if case.airframe is None:
        return None
    density, powers = density_at(altitudes), []
    for angle in np.arange(_HEADINGS) * (2 * np.pi / _HEADINGS):
        air = np.hypot(speeds * np.sin(angle) - winds[:, 0], speeds * np.cos(angle) - winds[:, 1])
        powers.append(case.airframe.power.watts(np.minimum(air, case.fastest), -winds[:, 2], density))
    return np.asarray(np.mean(powers, axis=0))


def _held_over_ground(
    wanted: FloatArray, along: FloatArray, across: FloatArray, fastest: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Ground speed, airspeed and the airspeed needed, where a ground speed is commanded."""
    spare = fastest**2 - across**2
    most = np.where(spare >= 0, np.sqrt(np.maximum(spare, 0.0)) + along, 0.0)
    ground = np.minimum(wanted, np.maximum(most, 0.0))
    needed = np.hypot(wanted - along, across)
    return ground, np.minimum(np.hypot(ground - along, across), fastest), needed


def _held_through_air(
    command: MotionCommand, along: FloatArray, across: FloatArray, fastest: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The same where an airspeed is commanded, and perhaps a least ground speed."""
    raised = np.where(command.ground > 0, np.hypot(command.ground - along, across), 0.0)
    slow = np.sqrt(np.maximum(command.air**2 - across**2, 0.0)) + along
    needed = np.where((command.ground > 0) & (slow < command.ground), np.maximum(raised, command.air), command.air)
    air = np.minimum(needed, np.maximum(fastest, command.air))
    spare = air**2 - across**2
    ground = np.where(spare >= 0, np.sqrt(np.maximum(spare, 0.0)) + along, 0.0)
    return np.maximum(ground, 0.0), air, np.where(spare >= 0, needed, np.abs(across))

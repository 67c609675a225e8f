"""Power of vehicles that hang on rotors: by blade element and momentum theory, and by coefficients fitted in flight."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.constants import STANDARD_GRAVITY
from gcs_windplan.errors import InputError, Problem
from gcs_windplan.vehicle.air import SEA_LEVEL_DENSITY
from gcs_windplan.vehicle.power import flow, require

_NEWTON_STEPS: Final = 8  # to the last digits from every start that is tried in the tests
_HALVINGS: Final = 52  # of the interval [0, 1], down to a double's last digit


@dataclass(frozen=True, slots=True)
class RotaryWing:
    """Blade element and momentum theory, as Zeng, Xu, Zhang 2019 write it (doi:10.1109/TWC.2019.2902559).

    P(V) = P0 (1 + 3 V²/U²) + Pi v/v0 + ½ d0 ρ s A V³ with what they derive it from: the blades' P0 = δ/8 ρ s A U³,
    and in hover Pi = (1 + k) W^1.5/√(2ρA) and v0 = √(W/(2ρA)). So density and mass enter exactly, at a tip speed that
    stays. This is the rotors' mechanical power; by `efficiency` it becomes the battery's.

    They do not treat climb. At a climb rate c, W c is added, and the induced velocity v is that of momentum theory:
    v √(V² + (c + v)²) = v0², level the same as theirs (Leishman 2006, Principles of Helicopter Aerodynamics, sections
    2.13 and 2.14). Downwards it is the root with air that still goes down through the disc, the excess k stays that
    of level flight, and where the air would go up through the disc nothing is gained from it. Straight down and
    slower than 2 v0 that is too little: rotors in their own wake draw up to about their hover power (section 2.13).
    """

    mass: float  # [kg] all that flies
    disc_area: float  # [m²] A, of all rotors together
    solidity: float  # s, blade area by disc area
    tip_speed: float  # [m/s] U = Ω R
    blade_drag: float = 0.012  # δ, profile drag coefficient; Zeng et al. 2019, table I
    induced_excess: float = 0.1  # k, of the induced power over that of an even inflow; Zeng et al. 2019, table I
    body_drag: float = 0.6  # d0, the body's flat plate area by the blades'; Zeng et al. 2019, table I
    efficiency: float = 1.0  # share of the electrical power that reaches the rotors

    def __post_init__(self) -> None:
        not_negative = ("blade_drag", "induced_excess", "body_drag")
        require(self, ("mass", "disc_area", "solidity", "tip_speed"), not_negative, ("efficiency",))

    def airspeeds(self, density: float = SEA_LEVEL_DENSITY) -> tuple[float, float]:
        """From hover to the tip speed [m/s], where the theory of the blades has long ended."""
        return 0.0, self.tip_speed

    def blade_power(self, density: FloatArray | float = SEA_LEVEL_DENSITY) -> FloatArray:
        """P0 [W], what turning the blades takes in hover."""
        return np.asarray(self.blade_drag / 8 * density * self.solidity * self.disc_area * self.tip_speed**3)

    def induced_velocity(self, density: FloatArray | float = SEA_LEVEL_DENSITY) -> FloatArray:
        """v0 [m/s], of the air through the disc in hover."""
        return np.sqrt(self.mass * STANDARD_GRAVITY / (2 * np.asarray(density) * self.disc_area))

    def watts(
        self,
        airspeed: FloatArray | float,
        climb_rate: FloatArray | float,
        density: FloatArray | float = SEA_LEVEL_DENSITY,
    ) -> FloatArray:
        """The power [W]; see `PowerModel.watts`."""
        speed, climb, rho = flow(airspeed, climb_rate, density)
        through = inflow(speed, climb, self.induced_velocity(rho))
        blades = self.blade_power(rho) * (1 + 3 * (speed / self.tip_speed) ** 2)
        induced = np.minimum(through - climb, inflow(speed, np.zeros_like(climb), self.induced_velocity(rho)))
        lift = self.mass * STANDARD_GRAVITY * (through + self.induced_excess * induced)
        body = 0.5 * self.body_drag * rho * self.solidity * self.disc_area * speed**3
        return np.asarray((blades + lift + body) / self.efficiency)


@dataclass(frozen=True, slots=True)
class Multirotor:
    """Coefficients fitted to flights, as Liu, Sengupta, Kurzhanskiy 2017 do (doi:10.1109/ICUAS.2017.7991310).

    P = k1 T (c/2 + √(c²/4 + T/k2²)) + c2 T^1.5 + c4 V³ with T² = (m g - c5 (V cos α)²)² + (c4 V²)² and a climb rate c;
    their c3 and c6 are 0. Electrical power where the coefficients were fitted to the battery's. The angle α at which
    the air meets the rotors is that of the balance of forces, T sin α = c4 V².

    The coefficients hold at `density`. At another one they change as the theory behind them says: the induced k2² =
    2ρA with ρ, the drag c4 and the lift c5 with ρ, the blades' c2 with ρ^-½ (P0 ~ ρ Ω³ at a thrust T ~ ρ Ω²).
    """

    mass: float  # [kg] all that flies
    k1: float  # induced power, as a multiple of that of an even inflow
    k2: float  # [√(kg/m)] induced velocity
    c2: float  # [√(m/kg)] blades
    c4: float  # [kg/m] drag
    c5: float = 0.0  # [kg/m] lift of the body and of the rotors in forward flight
    density: float = SEA_LEVEL_DENSITY  # [kg/m³] at which the coefficients were found

    def __post_init__(self) -> None:
        require(self, ("mass", "k2", "density"), ("k1", "c2", "c4", "c5"))
        if self.k1 == self.c2 == 0:
            raise InputError(Problem("cannot be 0 with k1 at 0 as well: hovering takes power", "power.c2"))

    def airspeeds(self, density: float = SEA_LEVEL_DENSITY) -> tuple[float, float]:
        """From hover on, without end."""
        return 0.0, math.inf

    def watts(
        self,
        airspeed: FloatArray | float,
        climb_rate: FloatArray | float,
        density: FloatArray | float = SEA_LEVEL_DENSITY,
    ) -> FloatArray:
        """The power [W]; see `PowerModel.watts`."""
        speed, climb, rho = flow(airspeed, climb_rate, density)
        ratio = rho / self.density
        drag = self.c4 * ratio * speed**2
        thrust = np.hypot(self._carried(speed, ratio, drag), drag)
        half = climb / 2
        induced = self.k1 * thrust * (half + np.sqrt(half**2 + thrust / (self.k2**2 * ratio)))
        return np.asarray(induced + self.c2 * thrust**1.5 / np.sqrt(ratio) + drag * speed)

    def _carried(self, speed: FloatArray, ratio: FloatArray, drag: FloatArray) -> FloatArray:
        """What the rotors carry of the weight [N]: all but the lift, which the angle that they tilt to decides.

        Halves the interval of cos² α: what it gives falls as it grows, so there is one root.
        """
        weight, lift = self.mass * STANDARD_GRAVITY, self.c5 * ratio * speed**2
        low, high = np.zeros_like(lift), np.ones_like(lift)
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            carried = weight - lift * middle
            under = (carried > 0) & (carried**2 >= middle * (carried**2 + drag**2))
            low, high = np.where(under, middle, low), np.where(under, high, middle)
        return weight - lift * low


def inflow(airspeed: FloatArray, climb_rate: FloatArray, hover: FloatArray) -> FloatArray:
    """The air's speed through a rotor's disc [m/s], downwards, that carries the weight; 0 where it would go up.

    The root u of (u - c) √(V² + u²) = v0², with the induced velocity `hover` v0 of hovering. Left of it is convex and
    rises, and the root with V = 0 lies above all others: Newton's steps go down to it without overshooting.
    """
    half = climb_rate / 2
    root = np.sqrt(half**2 + hover**2) + np.abs(half)
    through = np.where(half >= 0, root, hover**2 / root)
    for _ in range(_NEWTON_STEPS):
        past = np.hypot(airspeed, through)
        miss = (through - climb_rate) * past - hover**2
        through = np.maximum(through - miss / (past + (through - climb_rate) * through / past), 0.0)
    return through

"""Naive twins of the power models: plain Python, one formula after the other, roots by bisection."""

from __future__ import annotations

import math

from scipy.integrate import quad
from scipy.optimize import brentq

G = 9.80665


def naive_zeng(speed: float, blades: float, induced: float, tip: float, hover: float, body: float) -> float:
    """The closed form of Zeng, Xu, Zhang 2019; `body` is ½ d0 ρ s A."""
    square = speed**2 / (2 * hover**2)
    shrinks = math.sqrt(math.sqrt(1 + square**2) - square)
    return blades * (1 + 3 * speed**2 / tip**2) + induced * shrinks + body * speed**3


def naive_inflow(speed: float, climb: float, hover: float) -> float:
    """The root u ≥ 0 of (u - c) √(V² + u²) = v0²; 0 where there is none."""

    def miss(through: float) -> float:
        return (through - climb) * math.hypot(speed, through) - hover**2

    low = max(climb, 0.0)
    if miss(low) >= 0:
        return 0.0
    return float(brentq(miss, low, low + abs(climb) + 2 * hover + 1, xtol=1e-14, rtol=1e-14))


def naive_liu(model, speed: float, climb: float, density: float) -> float:
    """The model of Liu et al. 2017, its angle found by bisecting the balance of forces."""
    ratio = density / model.density
    drag, lift = model.c4 * ratio * speed**2, model.c5 * ratio * speed**2
    weight = model.mass * G

    def leans(angle: float) -> float:  # forward force less what the drag asks for at this angle
        return (weight - lift * math.cos(angle) ** 2) * math.sin(angle) - drag * math.cos(angle)

    angle = float(brentq(leans, 0.0, math.pi / 2, xtol=1e-15)) if drag > 0 else 0.0
    thrust = math.hypot(weight - lift * math.cos(angle) ** 2, drag)
    induced = model.k1 * thrust * (climb / 2 + math.sqrt(climb**2 / 4 + thrust / (model.k2**2 * ratio)))
    return induced + model.c2 / math.sqrt(ratio) * thrust**1.5 + drag * speed


def naive_wing(model, speed: float, climb: float, density: float) -> float:
    """Lift coefficient, drag coefficient, drag, power, one after the other."""
    pressure = density * speed**2 / 2
    lift = model.mass * G / (pressure * model.wing_area)
    drag = model.parasite_drag + lift**2 / (math.pi * model.oswald * model.aspect_ratio)
    force = pressure * model.wing_area * drag
    return max(force * speed + model.mass * G * climb, 0.0) / model.efficiency


def naive_density(height: float) -> float:
    """The standard atmosphere by integrating dp = -ρ g dz with a gravity that falls with height."""
    radius, gas = 6_356_766.0, 287.05287

    def gravity(z: float) -> float:
        return G * (radius / (radius + z)) ** 2

    def temperature(z: float) -> float:
        return 288.15 - 0.0065 * quad(gravity, 0, z)[0] / G

    exponent = quad(lambda z: gravity(z) / (gas * temperature(z)), 0, height)[0]
    return 101_325 * math.exp(-exponent) / (gas * temperature(height))


def naive_aerosonde_thrust(speed: float, volts: float, density: float) -> tuple[float, float]:
    """Thrust [N] and battery power [W] of the Aerosonde's motor and propeller.

    Beard and McLain, addendum on propulsion; coefficients of the authors' mavsim_public, aerosonde_parameters.py.
    """
    diameter, ohms, idle = 20 * 0.0254, 0.042, 1.5
    constant = 60 / (2 * math.pi) / 145
    a = density * diameter**5 / (2 * math.pi) ** 2 * 0.005230
    b = density * diameter**4 / (2 * math.pi) * 0.004970 * speed + constant**2 / ohms
    c = density * diameter**3 * -0.01664 * speed**2 - constant / ohms * volts + constant * idle
    turns = (-b + math.sqrt(b**2 - 4 * a * c)) / (2 * a) / (2 * math.pi)  # [1/s]
    advance = speed / (turns * diameter)
    thrust = density * turns**2 * diameter**4 * (-0.1079 * advance**2 - 0.06044 * advance + 0.09357)
    return thrust, volts * (volts - constant * 2 * math.pi * turns) / ohms

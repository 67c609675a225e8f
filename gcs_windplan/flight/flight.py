"""Flying a polyline: what each leg and the whole route take in the wind, and how close they come to the ground."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import NoRouteError
from gcs_windplan.flight.energy import leg_energies
from gcs_windplan.flight.sampling import LegIntegrals, clocked, integrate, still_air_times
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.scene import Scene
from gcs_windplan.terrain import Terrain
from gcs_windplan.vehicle import PowerModel, Vehicle, air_density
from gcs_windplan.wind.field import WindField

_NEAR_THE_END = 3600.0  # [s] a leg that stops so shortly before the forecast's end stops because of it


def clock(seconds: float) -> str:
    """A duration in minutes and seconds: 18:05."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A corner of the route.

    `altitude` above mean sea level and `above_ground` [m]; `seconds` from the first waypoint to the arrival here;
    `east` and `north` in the local frame [m].
    """

    number: int
    point: GeoPoint
    altitude: float
    above_ground: float
    seconds: float
    east: float
    north: float


@dataclass(frozen=True, slots=True)
class Leg:
    """From one waypoint to the next.

    Angles in degrees from true north, lengths in m, speeds in m/s. `distance` is level, `length` along the slope,
    `climb` the gain in height. `ground_speed` is the level mean over the leg. `wind_along` is positive from behind,
    `wind_across` from left to right, both means. `clearance` is the smallest and `height` the largest height above
    ground. `airspeed` is the one to hold, `energy` [J] is known where the vehicle's power is.
    """

    number: int
    track_deg: float
    heading_deg: float
    distance: float
    length: float
    climb: float
    ground_speed: float
    wind_along: float
    wind_across: float
    seconds: float
    clearance: float
    height: float
    airspeed: float
    energy: float | None = None


@dataclass(frozen=True, slots=True)
class Totals:
    """The sum of all legs: lengths and heights in m, time in s.

    The take-off to the first waypoint and the landing under the last one are apart, straight up and down at the
    vehicle's rates. The landing counts only for a mission that lands there. Energies [J] are known where the vehicle's
    power is.
    """

    seconds: float
    distance: float
    length: float
    climb: float
    descent: float
    clearance: float
    height: float
    takeoff_seconds: float
    landing_seconds: float
    energy: float | None = None
    takeoff_energy: float | None = None
    landing_energy: float | None = None


@dataclass(frozen=True, slots=True)
class Flight:
    """A route as flown: its waypoints, legs and totals."""

    waypoints: tuple[Waypoint, ...]
    legs: tuple[Leg, ...]
    totals: Totals


def fly(
    points: FloatArray,
    scene: Scene,
    vehicle: Vehicle,
    begin: float = 0.0,
    power: PowerModel | None = None,
    airspeeds: FloatArray | None = None,
) -> Flight:
    """Fly a polyline (n, 3): east, north, height above mean sea level [m], from `begin` on [s since departure].

    Each leg is flown at the vehicle's airspeed, or at its own of `airspeeds` (n - 1,) [m/s].

    Raises `NoRouteError` where a leg cannot be flown in the wind.
    """
    starts, ends = points[:-1], points[1:]
    parts, times = fly_legs(points, scene.wind, vehicle, begin, airspeeds)
    _refuse_unflyable(parts, times, scene.wind, points)
    heights = scene.terrain.leg_heights(np.ascontiguousarray(starts), np.ascontiguousarray(ends))
    convergence = np.degrees(scene.frame.convergence((starts + ends) / 2))
    speeds = np.full(len(starts), float(vehicle.airspeed)) if airspeeds is None else airspeeds
    legs = tuple(
        _leg(i, ends[i] - starts[i], parts, heights[i], float(convergence[i]), float(speeds[i]))
        for i in range(len(starts))
    )
    waypoints = _waypoints(points, scene.frame, scene.terrain, parts.seconds)
    flight = Flight(waypoints, legs, _totals(legs, waypoints, vehicle))
    if power is None:
        return flight
    return _with_energy(flight, leg_energies(points, times, scene.wind, vehicle, power, speeds), vehicle, power)


def fly_legs(
    points: FloatArray,
    wind: WindField,
    vehicle: Vehicle,
    begin: float = 0.0,
    airspeeds: FloatArray | None = None,
) -> tuple[LegIntegrals, FloatArray]:
    """What the wind does along each leg of a polyline (n, 3), and the times at its points (n,) [s since departure].

    Infinite from the first leg on that cannot be flown, or lasts beyond the forecast.
    """

    def measure(when: FloatArray | None) -> tuple[LegIntegrals, FloatArray]:
        parts = integrate(wind, vehicle, points[:-1], points[1:], when, airspeeds=airspeeds)
        return parts, parts.seconds

    return clocked(measure, still_air_times(points, vehicle, begin), len(wind.times) > 1)


def _refuse_unflyable(parts: LegIntegrals, times: FloatArray, wind: WindField, points: FloatArray) -> None:
    """Raise if the wind, looked at closely, stops a leg that the graph's coarser wind let pass."""
    stopped = np.flatnonzero(~np.isfinite(parts.seconds))
    if len(stopped):
        i = int(stopped[0])
        if len(wind.times) > 1 and np.isfinite(parts.along[i]) and times[i] >= wind.times[-1] - _NEAR_THE_END:
            raise NoRouteError(
                f"the forecast ends {(wind.times[-1] - times[0]) / 60:.0f} min after leaving, during leg {i + 1} at the"
                " latest:"
                " take a forecast that reaches further, or depart earlier.",
                {"wind": len(stopped)},
            )
        if not np.isfinite(parts.along[i] + parts.across[i]):
            raise NoRouteError(
                f"leg {i + 1} cannot be flown: it rises above the wind's highest level, perhaps over a valley, and the"
                " wind is not known there. Use a finer graph, a limits.max_height below that level, or a higher wind.",
                {"wind": len(stopped)},
            )
        if math.hypot(*(points[i + 1] - points[i])[:2]) < 1e-6:
            raise NoRouteError(
                f"leg {i + 1} cannot be flown: it goes straight up or down, and in the wind there the vehicle cannot"
                " hold its place. Use other layers, more airspeed, or another departure.",
                {"wind": len(stopped)},
            )
        raise NoRouteError(
            f"leg {i + 1} cannot be flown: the wind along it is {parts.along[i]:.1f} m/s along and"
            f" {parts.across[i]:.1f} m/s across in the mean, and stronger in places. Use a finer graph, more airspeed,"
            " or another departure.",
            {"wind": len(stopped)},
        )


def _leg(
    i: int, vector: FloatArray, parts: LegIntegrals, heights: FloatArray, convergence_deg: float, airspeed: float
) -> Leg:
    """One leg's figures from its vector [m] and its share of the integrals."""
    distance, length = math.hypot(vector[0], vector[1]), float(np.linalg.norm(vector))
    seconds = float(parts.seconds[i])
    speed = distance / seconds if seconds > 0 else 0.0
    along, across = float(parts.along[i]), float(parts.across[i])
    track = math.degrees(math.atan2(vector[0], vector[1])) + convergence_deg
    # the air must carry the rest of the velocity over ground: `speed` forward and nothing sideways
    crab = math.degrees(math.atan2(-across, speed - along)) if distance > 0 else 0.0
    return Leg(
        number=i + 1,
        track_deg=track % 360,
        heading_deg=(track + crab) % 360,
        distance=distance,
        length=length,
        climb=float(vector[2]),
        ground_speed=speed,
        wind_along=along,
        wind_across=across,
        seconds=seconds,
        clearance=float(heights[0]),
        height=float(heights[1]),
        airspeed=airspeed,
    )


def _with_energy(flight: Flight, energies: FloatArray, vehicle: Vehicle, power: PowerModel) -> Flight:
    """The flight with the energy of its legs (n,) and of its vertical ends [J]."""
    totals, ends = flight.totals, (flight.waypoints[0].altitude, flight.waypoints[-1].altitude)
    airspeed = 0.0 if vehicle.hovers else vehicle.airspeed
    up = float(power.watts(airspeed, vehicle.climb, air_density(ends[0]))) * totals.takeoff_seconds
    down = float(power.watts(airspeed, -vehicle.descent, air_density(ends[1]))) * totals.landing_seconds
    legs = tuple(replace(leg, energy=float(joules)) for leg, joules in zip(flight.legs, energies, strict=True))
    total = math.fsum(energies)
    return replace(flight, legs=legs, totals=replace(totals, energy=total, takeoff_energy=up, landing_energy=down))


def _waypoints(points: FloatArray, frame: LocalFrame, terrain: Terrain, seconds: FloatArray) -> tuple[Waypoint, ...]:
    """The polyline's corners as places on earth, with the time of arrival."""
    latitudes, longitudes = frame.to_geographic(points)
    ground = terrain.heights_at(points)
    arrivals = np.concatenate([[0.0], np.cumsum(seconds)])
    return tuple(
        Waypoint(
            number=i + 1,
            point=GeoPoint(float(latitudes[i]), float(longitudes[i])),
            altitude=float(points[i, 2]),
            above_ground=float(points[i, 2] - ground[i]),
            seconds=float(arrivals[i]),
            east=float(points[i, 0]),
            north=float(points[i, 1]),
        )
        for i in range(len(points))
    )


def _totals(legs: tuple[Leg, ...], waypoints: tuple[Waypoint, ...], vehicle: Vehicle) -> Totals:
    """The sums over all legs, and the vertical ends at the vehicle's rates."""
    return Totals(
        seconds=math.fsum(leg.seconds for leg in legs),
        distance=math.fsum(leg.distance for leg in legs),
        length=math.fsum(leg.length for leg in legs),
        climb=math.fsum(max(leg.climb, 0.0) for leg in legs),
        descent=math.fsum(max(-leg.climb, 0.0) for leg in legs),
        clearance=min(leg.clearance for leg in legs),
        height=max(leg.height for leg in legs),
        takeoff_seconds=waypoints[0].above_ground / vehicle.climb,
        landing_seconds=waypoints[-1].above_ground / vehicle.descent,
    )

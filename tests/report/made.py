"""Assessments made by hand: small worlds with hills, wind and findings, no planner needed."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

from gcs_windplan.assessment import (
    AssessedLeg,
    Assessment,
    AssessmentLimits,
    Finding,
    GroundMap,
    MissionTotals,
    Outline,
    Profile,
    Source,
    Stop,
)
from gcs_windplan.geo.frame import GeoPoint, LocalFrame

FRAME = LocalFrame(GeoPoint(46.8, 9.8))
NASTY = 'ridge <script>alert(1)</script> & "quoted" \u2028 </script><!--'


def hills(east, north):
    """Ground heights [m]."""
    return 1200 + 180 * np.sin(east / 900) * np.cos(north / 700) + 60 * np.sin(east / 230 + north / 310)


def wind_at(east, north):
    return 5 + 2 * np.sin(north / 800), 3 * np.cos(east / 1000)


def ground_map(size: float = 3000.0, cells: int = 90) -> GroundMap:
    along = np.linspace(-size, size, cells)
    x, y = np.meshgrid(along, along[: cells * 2 // 3])
    places = np.stack(np.meshgrid(np.linspace(-size, size, 14), np.linspace(-size, size / 3, 9)), -1).reshape(-1, 2)
    winds = np.column_stack(wind_at(places[:, 0], places[:, 1]))
    return GroundMap(along, along[: cells * 2 // 3], hills(x, y), places, winds, wind_height=80.0)


def assessment(name: str = "over the ridge", stops: int = 9, above: float = 70.0, shift: float = 0.0) -> Assessment:
    """A mission of so many stops in a zigzag, flown at 14 m/s through the air, with two findings."""
    share = np.linspace(0, 1, stops)
    east = -2400 + 4800 * share
    north = -900 + shift + 700 * np.sin(share * (7 if stops < 50 else 60)) * (1 if stops < 50 else 1.4)
    altitude = hills(east, north) + above
    distance = np.concatenate([[0], np.cumsum(np.hypot(np.diff(east), np.diff(north)))])
    samples = np.unique(np.concatenate([np.linspace(0, distance[-1], max(600, 5 * stops)), distance]))
    e, n, z = (np.interp(samples, distance, values) for values in (east, north, altitude))
    leg = np.clip(np.searchsorted(distance, samples, side="left"), 1, stops - 1)
    track = np.arctan2(np.diff(east), np.diff(north))[leg - 1]
    u, v = wind_at(e, n)
    along = u * np.sin(track) + v * np.cos(track)
    across = u * np.cos(track) - v * np.sin(track)
    over = np.sqrt(14.0**2 - across**2) + along
    pace = np.concatenate([[0], np.diff(samples) / over[1:]])
    seconds = 12 + np.cumsum(pace)
    power = 900 + 8 * along**2
    left = 1 - np.cumsum(pace * power) / 1.6e6 - 0.02
    latitude, longitude = FRAME.to_geographic(np.column_stack([e, n]))
    profile = Profile(
        samples, seconds, latitude, longitude, e, n, z, hills(e, n), along, across, u, v, over, np.full_like(e, 14.0),
        leg, power, left,
    )  # fmt: skip
    at = np.searchsorted(samples, distance)
    listed = tuple(
        Stop(
            i + 1, i, "take-off" if i == 0 else "land" if i == stops - 1 else "waypoint", float(latitude[k]),
            float(longitude[k]), float(z[k]), above, float(e[k]), float(n[k]), float(samples[k]), float(seconds[k]),
            left=float(left[k]), return_energy=4e5 * i / stops, diversion_energy=2e5 if i % 2 else float("inf"),
        )
        for i, k in enumerate(at)
    )  # fmt: skip
    lengths = np.diff(distance)
    legs = tuple(
        AssessedLeg(
            i + 1, i + 1, float(np.degrees(track[at[i + 1]]) % 360), float(np.degrees(track[at[i + 1]]) % 360),
            float(lengths[i]), float(np.hypot(lengths[i], altitude[i + 1] - altitude[i])),
            float(altitude[i + 1] - altitude[i]), float((altitude[i + 1] - altitude[i]) / lengths[i]),
            float(over[at[i + 1]]), 14.0, float(along[at[i + 1]]), float(across[at[i + 1]]),
            float(seconds[at[i + 1]] - seconds[at[i]]), 18.0, 130.0, 4e4,
        )
        for i in range(stops - 1)
    )  # fmt: skip
    over_ground = z - hills(e, n)
    low, high = int(over_ground.argmin()), int(over_ground.argmax())
    totals = MissionTotals(
        float(seconds[-1] + 20), 12.0, 20.0, float(distance[-1]), sum(one.length for one in legs), 300.0, 280.0,
        float(over_ground.min()), float(over_ground.max()), 7.4, 10.2, float(1.6e6 * (1 - left[-1])), float(left[-1]),
        0.25,
    )  # fmt: skip
    findings = (
        Finding(
            "clearance", "danger", f"leg {leg[low]} comes within {over_ground.min():.1f} m of the ground: raise it.",
            item=int(leg[low]), leg=int(leg[low]), distance=float(samples[low]), latitude_deg=float(latitude[low]),
            longitude_deg=float(longitude[low]), value=float(over_ground.min()), limit=30.0, unit="m",
        ),
        Finding(
            "height", "warning", f"leg {leg[high]} is {over_ground.max():.1f} m above ground: lower it.",
            leg=int(leg[high]), distance=float(samples[high]), value=float(over_ground.max()), limit=120.0, unit="m",
        ),
        Finding("return", "warning", "the mission does not say how to come home."),
    )  # fmt: skip
    square = np.array([[-800.0, -1400.0], [300.0, -1500.0], [200.0, -700.0], [-700.0, -600.0]])
    return Assessment(
        name, "ardupilot", "multicopter", FRAME, "EGM2008", datetime(2026, 5, 1, 9, tzinfo=UTC), listed, legs, profile,
        totals, AssessmentLimits(clearance=30.0, max_height=120.0, wind=12.0, battery=0.25), findings, ground_map(),
        (Outline("reserve", "keep-out", square, ceiling=1500.0), Outline("all", "fence-in", 2.2 * square + 300)),
        ((46.795, 9.79),),
        (
            Source("mission", "ridge.plan", "ridge.plan", "ab" * 32),
            Source("wind", "forecast.grib2", "forecast.grib2", "cd" * 32, "run 2026-05-01 00:00 UTC"),
        ),
        ("item 4: loiter time 0 s read as a waypoint",),
    )  # fmt: skip


def clear() -> Assessment:
    """A mission without findings, energy, power, wind or gusts known."""
    made = assessment("quiet", stops=4)
    return replace(
        made, findings=(), outlines=(), rally=(), sources=(), remarks=(), departure=None, limits=AssessmentLimits(),
        profile=replace(made.profile, power=None, left=None),
        totals=replace(made.totals, energy=None, left=None, reserve=None, gust=None),
        ground=replace(made.ground, wind_places=np.zeros((0, 2)), winds=np.zeros((0, 2))),
    )  # fmt: skip

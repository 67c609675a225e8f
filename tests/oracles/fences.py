"""What the autopilots make of an uploaded fence, from its items alone, as plainly as can be.

Polygons: a ray cast in the plane of latitude and longitude, as both autopilots do. Circles: the distance to the centre
in the metre of each: ArduPilot 0.011131884502145034 m for 1e-7 degrees of latitude, longitude shrunk by the cosine of
the middle latitude (Location::get_distance); PX4 on a sphere of 6 371 000 m (MapProjection).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from gcs_windplan.mission import Command, MissionItem


def ardupilot_distance(lat: float, lon: float, there_lat: float, there_lon: float) -> float:
    metres_a_degree = 0.011131884502145034 * 1e7
    east = (there_lon - lon) * math.cos(math.radians((lat + there_lat) / 2))
    return metres_a_degree * math.hypot(there_lat - lat, east)


def px4_distance(lat: float, lon: float, there_lat: float, there_lon: float) -> float:
    a, b = math.radians(lat), math.radians(there_lat)
    half = math.sin((b - a) / 2) ** 2
    half += math.cos(a) * math.cos(b) * math.sin(math.radians(there_lon - lon) / 2) ** 2
    return 2 * 6_371_000 * math.asin(math.sqrt(half))


DISTANCES: tuple[Callable[[float, float, float, float], float], ...] = (ardupilot_distance, px4_distance)


def breaches(items: Sequence[MissionItem], lat: float, lon: float) -> list[str]:
    """What a vehicle at a place breaks of the fence, by either autopilot."""
    broken = []
    index = 0
    while index < len(items):
        item = items[index]
        count = 1
        if item.command in (Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION, Command.NAV_FENCE_POLYGON_VERTEX_EXCLUSION):
            count = int(item.params[0])
            vertices = [(v.x / 1e7, v.y / 1e7) for v in items[index : index + count]]
            within = _inside(vertices, lat, lon)
            if within != (item.command == Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION):
                broken.append(f"polygon at item {index}")
        elif item.command != Command.NAV_FENCE_RETURN_POINT:
            keep_in = item.command == Command.NAV_FENCE_CIRCLE_INCLUSION
            for distance in DISTANCES:
                within = distance(lat, lon, item.x / 1e7, item.y / 1e7) < item.params[0]
                if within != keep_in:
                    broken.append(f"circle at item {index} by {distance.__name__}")
        index += count
    return broken


def _inside(vertices: list[tuple[float, float]], lat: float, lon: float) -> bool:
    crossings = 0
    for (lat_a, lon_a), (lat_b, lon_b) in zip(vertices, vertices[1:] + vertices[:1], strict=True):
        if (lon_a > lon) != (lon_b > lon):
            crossings += lat < lat_a + (lon - lon_a) / (lon_b - lon_a) * (lat_b - lat_a)
    return crossings % 2 == 1

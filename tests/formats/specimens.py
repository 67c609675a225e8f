"""Missions to write: built ones for each autopilot, and arbitrary ones."""

from __future__ import annotations

import itertools
import math
from typing import Any

from hypothesis import strategies as st

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Command, Frame, Home, MissionItem, MissionItems, degrees_e7, plain_frame
from gcs_windplan.planning.route_items import RoutePoint, route_mission

HOME = Home(GeoPoint(46.813437951, 9.843772049), 1560.25)
ROUTE = (
    RoutePoint(HOME.point, 1600.0),
    RoutePoint(GeoPoint(46.8150000049, 9.8461234567), 1642.5, 12.345),
    RoutePoint(GeoPoint(46.8171, 9.8481), 1650.1239, 12.4),
    RoutePoint(GeoPoint(46.8193333333, 9.85), 1633.0, 7.0),
)

BUILT = {
    "-".join((autopilot, altitude, finish, "speeds" if speeds else "one-speed")): route_mission(
        HOME,
        ROUTE,
        autopilot=autopilot,  # type: ignore[arg-type]
        vehicle_type="multicopter",
        finish=finish,  # type: ignore[arg-type]
        altitude=altitude,  # type: ignore[arg-type]
        speed_changes=speeds,
        cruise_speed=10.5,
        landing_altitude=1590.0,
    )
    for autopilot, altitude, finish, speeds in itertools.product(
        ("ardupilot", "px4"), ("relative", "amsl"), ("land", "return", "hold"), (True, False)
    )
}

_latitudes = st.floats(-90, 90)
_longitudes = st.floats(-180, 180)
_altitudes = st.floats(-1000, 60000)
_params = st.one_of(st.floats(-1e6, 1e6, width=32), st.just(math.nan), st.integers(-1000, 1000).map(float))
_frames = st.sampled_from([*Frame, 4, 99])
_commands = st.one_of(st.sampled_from(list(Command)).filter(lambda c: c != Command.DO_JUMP), st.integers(0, 65535))

homes = st.builds(
    Home,
    st.builds(GeoPoint, _latitudes, _longitudes).filter(lambda p: abs(p.latitude_deg) > 1e-6),
    _altitudes,
)
items = st.builds(
    MissionItem,
    _frames,
    _commands,
    st.tuples(_params, _params, _params, _params),
    _latitudes,
    _longitudes,
    _altitudes,
    st.booleans(),
)
missions = st.builds(
    MissionItems,
    st.lists(items, max_size=8).map(tuple),
    homes,
    st.sampled_from([None, "ardupilot", "px4"]),
    st.sampled_from([None, "multicopter", "fixed-wing"]),
    st.one_of(st.none(), st.floats(0.01, 500)),
    st.one_of(st.none(), st.floats(0.01, 500)),
)


def content(item: MissionItem) -> tuple[Any, ...]:
    """What a file keeps of an item exactly: plain frame, parameters, coordinates in 1e-7 degrees."""
    return (
        plain_frame(item.frame),
        int(item.command),
        item.params,
        item.lat_e7,
        item.lon_e7,
        item.autocontinue,
    )


def altitudes(mission: MissionItems) -> list[float]:
    """The altitudes of home, if there is one, and of the items [m]."""
    home = [] if mission.home is None else [mission.home.altitude]
    return home + [item.altitude for item in mission.items]


def home_content(home: Home | None) -> tuple[int, int] | None:
    """What a file keeps of home exactly: its coordinates in 1e-7 degrees."""
    return None if home is None else (degrees_e7(home.point.latitude_deg), degrees_e7(home.point.longitude_deg))

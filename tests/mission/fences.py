"""Fences and rally points: one of every kind, and arbitrary ones."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from gcs_windplan.geo.frame import GeoPoint
from gcs_windplan.mission import Fence, FenceCircle, FencePolygon, Frame, RallyPoint, ReturnPoint

FIELD = FencePolygon((GeoPoint(46.80, 9.84), GeoPoint(46.83, 9.84), GeoPoint(46.83, 9.87), GeoPoint(46.80, 9.87)))
WOOD = FencePolygon((GeoPoint(46.81, 9.85), GeoPoint(46.8150000049, 9.8512345678), GeoPoint(46.81, 9.86)), False)
RANGE = FenceCircle(GeoPoint(46.815, 9.855), 2500.5)
MAST = FenceCircle(GeoPoint(46.82, 9.845), 80.0, False)
BACK = ReturnPoint(GeoPoint(46.805, 9.845), 40.25)
FENCE = Fence((FIELD, WOOD), (RANGE, MAST), BACK)
RALLY = (RallyPoint(GeoPoint(46.806, 9.846), 35.0), RallyPoint(GeoPoint(46.8266666666, 9.866), 52.5))

_units = st.integers(-1_700_000_000, 1_700_000_000)
_points = st.builds(lambda lat, lon: GeoPoint(lat / 2e7, lon / 1e7), _units, _units)


@st.composite
def polygons(draw: st.DrawFn) -> FencePolygon:
    """Star-shaped about a centre, so that no border crosses itself."""
    centre = draw(_points)
    count = draw(st.integers(3, 12))
    reach = st.floats(1e-4, 0.2)
    corners = []
    for step in range(count):
        angle, distance = 2 * math.pi * step / count, draw(reach)
        latitude = centre.latitude_deg + distance * math.cos(angle)
        longitude = centre.longitude_deg + distance * math.sin(angle)
        corners.append(GeoPoint(latitude, longitude))
    return FencePolygon(tuple(corners), draw(st.booleans()))


circles = st.builds(FenceCircle, _points, st.floats(0.5, 1e6, width=32), st.booleans())
_altitudes = st.integers(-1_000_000, 8_000_000).map(lambda millimetres: millimetres / 1000)
fences = st.builds(
    Fence,
    st.lists(polygons(), max_size=4).map(tuple),
    st.lists(circles, min_size=1, max_size=4).map(tuple),
    st.one_of(st.none(), st.builds(ReturnPoint, _points, _altitudes)),
)
rally_points = st.builds(RallyPoint, _points, _altitudes, st.sampled_from([Frame.GLOBAL_RELATIVE_ALT, Frame.GLOBAL]))

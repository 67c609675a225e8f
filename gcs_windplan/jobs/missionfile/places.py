"""Places of a mission file in the local frame."""

from __future__ import annotations

from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.jobs.missionfile.world import PlaceModel


def place_of(model: PlaceModel, frame: LocalFrame) -> tuple[float, float]:
    """East and north of a place [m]."""
    if model.latitude is not None and model.longitude is not None:
        east, north = frame.to_local(model.latitude, model.longitude)[0]
        return float(east), float(north)
    assert model.east is not None
    assert model.north is not None
    return model.east, model.north

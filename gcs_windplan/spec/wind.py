"""The wind that a mission file names."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from gcs_windplan import wind as air  # its readers are imported when first asked for: netCDF4 is heavy
from gcs_windplan.geodesy import LocalFrame
from gcs_windplan.spec.parsing import MissionDocument
from gcs_windplan.spec.world import PaperWindModel, ProfileModel

if TYPE_CHECKING:
    from gcs_windplan.terrain import Extent, Terrain
    from gcs_windplan.wind import LogLaw, PowerLaw, WindField


def build_wind(document: MissionDocument, frame: LocalFrame, terrain: Terrain, area: Extent) -> WindField:
    """The wind; raises `WindError`."""
    model = document.model.wind
    if model.netcdf is not None:
        forecast = air.read_netcdf(
            document.beside(model.netcdf),
            frame,
            terrain.heights_at,
            document.model.departure,
            _overlap(area, terrain.extent),
            extend=model.extend == "nearest",
        )
        return replace(forecast, ground_resolution=terrain.resolution)
    field: WindField = air.Calm()
    if model.constant is not None:
        field = air.ConstantWind.from_direction(model.constant.speed, model.constant.from_, frame)
    elif model.paper is not None:
        field = _papers(model.paper)
    if model.profile is None:
        return field
    return air.ProfileWind(field, terrain.heights_at, _law(model.profile), terrain.resolution)


def _papers(model: PaperWindModel) -> WindField:
    """One of the paper's fields."""
    if model.field == "jet":
        return air.Jet(model.speed, model.scale, model.reading)
    return (air.Diverging if model.field == "diverging" else air.Rotation)(model.speed, model.scale)


def _law(model: ProfileModel) -> PowerLaw | LogLaw:
    """The profile's law; the schema has seen to it that its own field is there."""
    if model.exponent is not None:
        return air.PowerLaw(model.reference_height, model.exponent)
    assert model.roughness is not None
    return air.LogLaw(model.reference_height, model.roughness)


def _overlap(area: Extent, edge: Extent) -> tuple[float, float, float, float]:
    """The part of the area over which there is terrain, as west, south, east, north."""
    return (
        max(area.west, edge.west),
        max(area.south, edge.south),
        min(area.east, edge.east),
        min(area.north, edge.north),
    )

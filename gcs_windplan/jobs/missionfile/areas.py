"""The areas of a mission file, and the fence that the autopilot makes of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

from pydantic import Field

from gcs_windplan.jobs.missionfile.section import Fields, SchemaProblem, Section, at_most_one, exactly_one
from gcs_windplan.jobs.missionfile.values import (
    SIGNED_LENGTH,
    Flag,
    Height,
    Label,
    Latitude,
    Length,
    Longitude,
    PositiveLength,
)
from gcs_windplan.jobs.missionfile.world import PlaceModel, SiteModel, one_of


class PolygonModel(Section):
    """The corners of an area."""

    expects: ClassVar[str] = "a list of corners [[latitude, longitude], ...] or {east_north: [[east, north], ...]}"
    alone: ClassVar[str] = "latitude_longitude"

    latitude_longitude: tuple[tuple[Latitude, Longitude], ...] | None = Field(
        default=None, min_length=3, description="at least 3 corners; a list alone is short for this"
    )
    east_north: tuple[tuple[Length, Length], ...] | None = Field(
        default=None,
        min_length=3,
        description="at least 3 corners in the local frame; needs `terrain.origin`",
    )

    @classmethod
    def expanded(cls, data: object) -> object:
        """A list alone holds latitudes and longitudes."""
        return {"latitude_longitude": data} if isinstance(data, list | tuple) else data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Both kinds of corners, or none."""
        names = ("latitude_longitude", "east_north")
        if not any(name in fields for name in names):
            yield SchemaProblem((), f"corners are missing; {cls.expects} belongs here")
        yield from at_most_one(fields, *names)


class CircleModel(PlaceModel):
    """A circle: its centre and its radius."""

    expects: ClassVar[str] = "a circle such as {latitude: 38.1, longitude: 23.7, radius: 300 m}"
    words: ClassVar[tuple[str, ...]] = ()

    radius: PositiveLength = Field(description="of the circle", examples=["300 m"])

    @classmethod
    def expanded(cls, data: object) -> object:
        """It has no short form: words say no radius."""
        return data


class AreaModel(Section):
    """An area, a polygon or a circle, with, if wanted, a floor and a ceiling."""

    model_config = one_of("polygon", "circle")

    name: Label = Field(description="for messages and maps", examples=["school"])
    polygon: PolygonModel | None = Field(default=None, description="its corners; beside it no `circle`")
    circle: CircleModel | None = Field(default=None, description="its centre and radius; beside it no `polygon`")
    floor: Length | None = Field(default=None, description="above mean sea level; default: the ground")
    ceiling: Length | None = Field(default=None, description="above mean sea level, above the floor; default: none")
    margin: Height = Field(default=5.0, description="distance to keep from its border in plan")
    fence: Flag = Field(
        default=False,
        description="whether the autopilot's own fence holds it too, in plan: a fence has no heights",
    )

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """A polygon and a circle, or neither; a ceiling that is not above the floor."""
        yield from exactly_one(fields, "polygon", "circle")
        floor, ceiling = (SIGNED_LENGTH.read_or_none(fields.get(name)) for name in ("floor", "ceiling"))
        if floor is not None and ceiling is not None and ceiling <= floor:
            yield SchemaProblem(("ceiling",), f"{ceiling:g} m is not above the floor, {floor:g} m")


class FenceModel(Section):
    """The autopilot's own fence, besides the areas that are marked with `fence: true`."""

    expects: ClassVar[str] = "{return_point: ...}, and 'fence: true' at the areas in limits that it shall hold,"

    return_point: SiteModel | None = Field(
        default=None, description="where a vehicle that broke the fence flies to; only ArduPlane does so"
    )

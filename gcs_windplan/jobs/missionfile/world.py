"""The sections of a mission file about the world: places, terrain, obstacles, wind."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Final, Literal

from pydantic import ConfigDict, Field

from gcs_windplan.jobs.missionfile.section import Fields, SchemaProblem, Section, at_most_one, exactly_one, only_with
from gcs_windplan.jobs.missionfile.short_words import place_fields, profile_fields, terrain_fields, wind_fields
from gcs_windplan.jobs.missionfile.values import (
    CLEARANCE,
    Calm,
    Direction,
    Exponent,
    FileNames,
    Height,
    Label,
    Latitude,
    Length,
    Longitude,
    Member,
    MeshName,
    Number,
    PositiveLength,
    PositiveSpeed,
    Speed,
)

_MOST_CELLS: Final = 5000  # along a side of an analytic surface: 200 MB of heights


def one_of(*names: str) -> ConfigDict:
    """A section's configuration that tells editors that exactly one of the fields is needed."""
    return ConfigDict(json_schema_extra={"oneOf": [{"required": [name]} for name in names]})


class PlaceModel(Section):
    """A place: latitude and longitude, or east and north of the local origin."""

    expects: ClassVar[str] = "a place such as {latitude: 38.1, longitude: 23.7} or {east: 100, north: 250}"
    words: ClassVar[tuple[str, ...]] = ("38.1,23.7",)

    latitude: Latitude | None = Field(default=None, description="WGS 84 latitude, north positive")
    longitude: Longitude | None = Field(default=None, description="WGS 84 longitude, east positive")
    east: Length | None = Field(
        default=None, description="east of the local origin, with `north`; needs `terrain.origin`"
    )
    north: Length | None = Field(default=None, description="north of the local origin, with `east`")

    @classmethod
    def expanded(cls, data: object) -> object:
        """A text says latitude and longitude."""
        return place_fields(data) if isinstance(data, str) and "," in data else data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Anything but exactly one full pair of coordinates."""
        geographic = [name for name in ("latitude", "longitude") if name in fields]
        local = [name for name in ("east", "north") if name in fields]
        if geographic and local:
            yield SchemaProblem((local[0],), "cannot stand beside latitude and longitude; keep one pair", at_key=True)
        elif not geographic and not local:
            yield SchemaProblem((), "a place needs latitude and longitude, or east and north")
        else:
            pair = ("latitude", "longitude") if geographic else ("east", "north")
            for name in pair:
                if name not in fields:
                    yield SchemaProblem((name,), f"is missing beside '{(geographic + local)[0]}'")


class SiteModel(PlaceModel):
    """A place to start from, to reach or to pass, and how high."""

    words: ClassVar[tuple[str, ...]] = ("38.1,23.7", "38.1,23.7,2100", "38.1,23.7,80 m agl")

    height: Height | None = Field(default=None, description="above ground; beside it no `altitude`")
    altitude: Length | None = Field(default=None, description="above mean sea level; beside it no `height`")

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Those of a place, and two vertical positions."""
        yield from super().contradictions(fields)
        yield from at_most_one(fields, "height", "altitude")


class OriginModel(Section):
    """Where the local origin (0, 0, 0) is."""

    words: ClassVar[tuple[str, ...]] = ("38.1,23.7,120",)

    latitude: Latitude = Field(description="WGS 84 latitude, north positive", examples=["38.1"])
    longitude: Longitude = Field(description="WGS 84 longitude, east positive", examples=["23.7"])
    altitude: Length = Field(default=0.0, description="above mean sea level")

    @classmethod
    def expanded(cls, data: object) -> object:
        """A text says latitude, longitude and perhaps the altitude."""
        return place_fields(data) if isinstance(data, str) and "," in data else data


class HillModel(Section):
    """A Gaussian hill: height · exp(-(distance / radius)² / 2)."""

    east: Length = Field(description="of its top, from the local origin", examples=["0"])
    north: Length = Field(description="of its top, from the local origin", examples=["0"])
    height: Length = Field(description="of its top above the flat ground; negative for a hollow", examples=["60 m"])
    radius: PositiveLength = Field(
        description="standard deviation: there it is 61 % as high as at its top", examples=["90 m"]
    )


class SurfaceModel(Section):
    """An analytic surface: Gaussian hills on flat ground, a square about the local origin."""

    size: PositiveLength = Field(description="side of the square", examples=["800 m"])
    cell: PositiveLength = Field(description="side of a cell of its grid", examples=["5 m"])
    hills: tuple[HillModel, ...] = Field(default=(), description="hills, added up; none leaves flat ground")

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Cells larger than the surface, or too many of them."""
        size, cell = (CLEARANCE.read_or_none(fields.get(name)) for name in ("size", "cell"))
        if size is None or cell is None:
            return
        if cell > size:
            yield SchemaProblem(("cell",), f"a cell of {cell:g} m is larger than the surface of {size:g} m")
        elif size / cell > _MOST_CELLS:
            right = size / _MOST_CELLS
            yield SchemaProblem(("cell",), f"more than {_MOST_CELLS} cells along a side; write at least {right:g} m")


class TerrainModel(Section):
    """The ground."""

    model_config = one_of("dem", "sample", "mesh", "surface", "flat")
    words: ClassVar[tuple[str, ...]] = ("dem.tif", "sample:jacksboro", "flat:120 m")

    dem: FileNames | None = Field(
        default=None,
        description="a file or a list of files with heights: GeoTIFF, .hgt, .hgt.zip; relative to this file",
    )
    sample: Literal["jacksboro"] | None = Field(
        default=None, description="heights that need no download: the USGS DEM that Matplotlib ships"
    )
    mesh: MeshName | None = Field(
        default=None, description="a triangle mesh in metres, z up, about `origin`; relative to this file"
    )
    surface: SurfaceModel | None = Field(default=None, description="an analytic surface about `origin`")
    flat: Length | None = Field(default=None, description="a plain, so high above mean sea level")
    nodata: Number | None = Field(default=None, description="this height means unknown too; only with `dem`")
    origin: OriginModel | None = Field(
        default=None,
        description="where the local origin is; required with `mesh` and `surface`",
    )
    vertical_datum: Label | None = Field(default=None, description="the datum of the heights, such as EGM96")

    @classmethod
    def expanded(cls, data: object) -> object:
        """A text says a file, the sample or a plain."""
        return terrain_fields(data) if isinstance(data, str) else data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Several sources of heights or none, an origin that is needed, fields without their partner."""
        yield from exactly_one(fields, "dem", "sample", "mesh", "surface", "flat")
        yield from only_with(fields, "nodata", "dem")
        shape = next((name for name in ("mesh", "surface") if name in fields), None)
        if shape and "origin" not in fields:
            example = "origin: {latitude: 38.1, longitude: 23.7}"
            yield SchemaProblem(("origin",), f"is missing; a {shape} needs it, for example '{example}'")


class ObstacleModel(Section):
    """A closed mesh that stands on the terrain."""

    name: Label = Field(description="for messages and maps", examples=["tower"])
    mesh: MeshName = Field(description="a closed mesh in metres, z up; relative to this file", examples=["tower.glb"])
    at: PlaceModel | None = Field(default=None, description="where the mesh's origin is; default: the local origin")
    altitude: Length | None = Field(
        default=None,
        description="above mean sea level, of the mesh's z = 0; default: it stands on the ground",
    )
    margin: Height = Field(default=5.0, description="smallest distance to keep from it")


class ConstantWindModel(Section):
    """The same wind everywhere."""

    words: ClassVar[tuple[str, ...]] = ("8 m/s from 270 deg",)

    speed: Speed = Field(description="wind speed", examples=["8 m/s"])
    from_: Direction = Field(alias="from", description="the true direction the wind blows from", examples=["270 deg"])

    @classmethod
    def expanded(cls, data: object) -> object:
        """A text says speed and direction."""
        return wind_fields(data).get("constant", data) if isinstance(data, str) else data


class PaperWindModel(Section):
    """An analytic field about the local origin."""

    field: Literal["jet", "diverging", "rotation"] = Field(
        description="equation (14), (15) or (16) of the paper", examples=["jet"]
    )
    reading: Literal["unit", "magnitude", "literal"] = Field(
        default="unit", description="how the printed jet is read; only with `field: jet`"
    )
    speed: PositiveSpeed = Field(default=1.0, description="what the field is multiplied by")
    scale: PositiveLength = Field(default=1.0, description="length of one unit of the paper's plane")

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """A reading of a field that has only one."""
        if "reading" in fields and fields.get("field") in ("diverging", "rotation"):
            yield SchemaProblem(("reading",), "belongs only beside 'field: jet'; leave it out", at_key=True)


class ProfileModel(Section):
    """How the wind grows with height above ground."""

    words: ClassVar[tuple[str, ...]] = ("power:0.143", "log:0.1")

    law: Literal["power", "log"] = Field(description="the law of the profile", examples=["power"])
    exponent: Exponent | None = Field(default=None, description="of the power law, such as 0.143; required there")
    roughness: PositiveLength | None = Field(
        default=None, description="roughness length of the log law; required there"
    )
    reference_height: PositiveLength = Field(
        default=10.0,
        description="above ground, where the wind is as given; with `forecast` only for a file that does not say where"
        " its wind is",
    )

    @classmethod
    def expanded(cls, data: object) -> object:
        """A text says the law and its figure."""
        return profile_fields(data) if isinstance(data, str) else data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """The other law's field, this law's field missing, a reference within the roughness."""
        own, other = {"power": ("exponent", "roughness"), "log": ("roughness", "exponent")}.get(
            str(fields.get("law")), (None, None)
        )
        if own is None:
            return
        if own not in fields:
            example = {"exponent": "0.143", "roughness": "0.1 m"}[own]
            yield SchemaProblem((own,), f"is missing; this law needs it, for example '{own}: {example}'")
        if other in fields:
            yield SchemaProblem((str(other),), "belongs to the other law; leave it out", at_key=True)
        roughness = CLEARANCE.read_or_none(fields.get("roughness"))
        reference = CLEARANCE.read_or_none(fields.get("reference_height", 10.0))
        if own == "roughness" and roughness and reference and roughness >= reference:
            yield SchemaProblem(("roughness",), f"must be below the reference height of {reference:g} m")


class WindModel(Section):
    """The wind."""

    model_config = one_of("calm", "constant", "paper", "forecast")
    words: ClassVar[tuple[str, ...]] = ("calm", "8 m/s from 270 deg", "forecast.grib2")

    calm: Calm | None = Field(default=None, description="still air")
    constant: ConstantWindModel | None = Field(default=None, description="the same wind everywhere")
    paper: PaperWindModel | None = Field(default=None, description="an analytic field")
    forecast: FileNames | None = Field(
        default=None,
        description="a file or a list of files with a forecast or reanalysis: GRIB, NetCDF, Open-Meteo's JSON; relative"
        " to this file",
    )
    members: Literal["all"] | tuple[Member, ...] | None = Field(
        default=None, description="of an ensemble: `all`, or a list of their numbers; only with `forecast`"
    )
    extend: Literal["nearest"] | None = Field(
        default=None, description="outside the file's area use the nearest values; only with `forecast`"
    )
    profile: ProfileModel | None = Field(
        default=None,
        description="how the wind changes with height above ground; with `constant` or `paper`, and with `forecast`"
        " below its lowest level and above levels that are all above ground",
    )

    @classmethod
    def expanded(cls, data: object) -> object:
        """A text says still air, a steady wind or a file."""
        return wind_fields(data) if isinstance(data, str) else data

    @classmethod
    def contradictions(cls, fields: Fields) -> Iterator[SchemaProblem]:
        """Several winds or none, fields without their partner, members twice."""
        yield from exactly_one(fields, "calm", "constant", "paper", "forecast")
        yield from only_with(fields, "extend", "forecast")
        yield from only_with(fields, "members", "forecast")
        yield from only_with(fields, "profile", "constant", "paper", "forecast")
        members = fields.get("members")
        if isinstance(members, list | tuple) and not members:
            yield SchemaProblem(("members",), "names no member; write `all`, or a list of their numbers")
        if isinstance(members, list | tuple) and len(set(map(str, members))) < len(members):
            yield SchemaProblem(("members",), "names a member twice")

"""Where the terrain is from, in words or in a mission file, and how it is read: files, samples, analytic surfaces."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final, Protocol, TypeAlias, runtime_checkable

import numpy as np

from gcs_windplan import terrain as ground  # its readers are imported when first asked for: rasterio is heavy
from gcs_windplan.geo.frame import LocalFrame
from gcs_windplan.jobs.missionfile.values import SIGNED_LENGTH

if TYPE_CHECKING:
    from gcs_windplan.terrain import Extent, Hill, Terrain

_SPARE: Final = 1000.0  # [m] of plain around everything
_FLAT: Final = re.compile(r"flat:(.+)")
_SAMPLE: Final = "sample:jacksboro"


@runtime_checkable
class TerrainSource(Protocol):
    """What a terrain is read from."""

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it is read from."""

    @property
    def name(self) -> str:
        """What it is, where no file names it."""

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """The terrain, as far as the area [m] needs it. Raises `TerrainError`."""


@dataclass(frozen=True, slots=True)
class DemFiles:
    """Heights in files: GeoTIFF, .hgt, .hgt.zip; `nodata` means unknown too."""

    files: tuple[Path, ...]
    nodata: float | None = None
    vertical_datum: str | None = None
    name: str = "DEM"

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """The heights of all files, as far as the area needs them."""
        return ground.read_dem(self.files, frame, area, nodata=self.nodata, vertical_datum=self.vertical_datum)


@dataclass(frozen=True, slots=True)
class SampleDem:
    """The USGS DEM that Matplotlib ships, near Jacksboro."""

    files: tuple[Path, ...] = ()
    name: str = "sample DEM"

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """The sample's heights."""
        return ground.sample_dem(frame, area)


@dataclass(frozen=True, slots=True)
class FlatGround:
    """A plain at an altitude above mean sea level [m]."""

    altitude: float
    files: tuple[Path, ...] = ()
    name: str = "plain"

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """A plain that reaches beyond the area."""
        size = 2 * max(abs(area.west), abs(area.east), abs(area.south), abs(area.north)) + _SPARE
        return ground.flat(size, self.altitude)


@dataclass(frozen=True, slots=True)
class MeshFile:
    """A triangle mesh about the local origin, which is at `altitude` above mean sea level [m]."""

    path: Path
    altitude: float = 0.0
    vertical_datum: str | None = None
    title: str = ""
    name: str = "mesh"

    @property
    def files(self) -> tuple[Path, ...]:
        """The mesh."""
        return (self.path,)

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """All of the mesh."""
        vertices, faces = ground.read_mesh(self.path)
        placed = vertices + np.array([0.0, 0.0, self.altitude])
        return ground.MeshTerrain(placed, faces, self.title or self.path.name, self.vertical_datum or "local")


@dataclass(frozen=True, slots=True)
class Hills:
    """Gaussian hills on flat ground: a square of `size` about the local origin in cells of `cell` [m]."""

    size: float
    cell: float
    hills: tuple[Hill, ...] = ()
    altitude: float = 0.0
    vertical_datum: str | None = None
    files: tuple[Path, ...] = ()
    name: str = "analytic surface"

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """The whole square."""
        title = f"{len(self.hills)} analytic hills" if self.hills else "flat ground"
        return ground.hills(self.size, self.cell, self.hills, self.altitude, title, self.vertical_datum or "local")


@dataclass(frozen=True, slots=True, eq=False)
class GivenTerrain:
    """A terrain that is there already, in the mission's local frame."""

    terrain: Terrain
    files: tuple[Path, ...] = ()

    @property
    def name(self) -> str:
        """The terrain's."""
        return self.terrain.name

    def load(self, frame: LocalFrame, area: Extent) -> Terrain:
        """The terrain itself."""
        return self.terrain


#: A file or several, `sample:jacksboro`, `flat:120`, or a terrain: a source of one, or itself.
TerrainWords: TypeAlias = "str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | TerrainSource | Terrain"


def as_terrain(words: TerrainWords) -> TerrainSource:
    """The source that words or a value say. Raises `ValueError`."""
    if isinstance(words, str | os.PathLike):
        words = [words]
    if not isinstance(words, Sequence):
        return words if isinstance(words, TerrainSource) else GivenTerrain(words)
    names = [os.fspath(word) for word in words]
    if names == [_SAMPLE]:
        return SampleDem()
    if len(names) == 1 and (plain := _FLAT.fullmatch(names[0])):
        return FlatGround(SIGNED_LENGTH.read(plain[1]))
    odd = [name for name in names if name.startswith("sample:") or _FLAT.fullmatch(name)]
    if odd or not names:
        said = repr(odd[0]) if odd else "an empty list"
        raise ValueError(f"{said} is no terrain: name files, or {_SAMPLE} or flat:ALTITUDE alone")
    return DemFiles(tuple(Path(name) for name in names))

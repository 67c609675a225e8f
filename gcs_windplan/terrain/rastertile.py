"""What a raster file says of itself: grid, projection, units; and its heights in metres."""

from __future__ import annotations

import re
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import rasterio
from rasterio.enums import ColorInterp
from rasterio.errors import NotGeoreferencedWarning, RasterioError
from rasterio.windows import Window as RasterWindow

from gcs_windplan.arrays import FloatArray
from gcs_windplan.errors import Problem, TerrainError
from gcs_windplan.terrain.window import Window
from gcs_windplan.units import INTERNATIONAL_FOOT, US_SURVEY_FOOT

_METRES = ("", "m", "metre", "metres", "meter", "meters")
_FEET = ("ft", "foot", "feet", "international foot", "international feet")
_SURVEY_FEET = ("us-ft", "ftus", "us survey foot", "us survey feet", "survey foot", "us foot", "foot_us")
_HGT_NAME = re.compile(r"[NS]\d{2}[EW]\d{3}", re.IGNORECASE)
_HGT_VOID = -32768.0  # SRTM user guide, section 2.1.3
_VERTICAL = re.compile(r'VERT_CS\["([^"]+)".*?VERT_DATUM\["([^"]+)".*?\bUNIT\["([^"]+)"', re.DOTALL)


@dataclass(frozen=True, slots=True, eq=False)
class RasterTile:
    """One open-able raster file.

    `transform` leads from (column, row) of pixel corners to the projection: x = a c + b r + c0, y = d c + e r
    + f0, as (a, b, c0, d, e, f0). GDAL has moved it by half a pixel where the file says AREA_OR_POINT=Point.
    `to_metres` turns stored values, scaled and offset, into metres.
    """

    path: Path
    source: str
    crs: Any
    transform: tuple[float, float, float, float, float, float]
    shape: tuple[int, int]
    bands: int
    scale: float
    offset: float
    to_metres: float
    vertical_datum: str

    @property
    def name(self) -> str:
        """The file's name, with a word on the bands that are not read."""
        return self.path.name + (f" (band 1 of {self.bands})" if self.bands > 1 else "")

    def read(self, window: Window, nodata: float | None) -> FloatArray:
        """The heights of a block [m], NaN where the file's mask, its nodata value or `nodata` says so."""
        with open_raster(self.path, self.source) as dataset:
            block = RasterWindow(window.column, window.row, window.columns, window.rows)
            raw = dataset.read(1, window=block, masked=True)
        heights = np.ma.getdata(raw).astype(np.float64)
        unknown = np.ma.getmaskarray(raw) | ~np.isfinite(heights)
        if nodata is not None:
            unknown |= heights == nodata
        if is_hgt(self.path):
            unknown |= heights == _HGT_VOID
        heights = (heights * self.scale + self.offset) * self.to_metres
        heights[unknown] = np.nan
        return heights


def describe(path: Path) -> RasterTile:
    """What a file says of its first band; TerrainError, with the file, if it is no usable height grid."""
    source = _source(path)
    with open_raster(path, source) as dataset:
        if dataset.count == 0:
            raise file_error(path, "a container without a band of its own; name one of its parts")
        if dataset.crs is None or dataset.transform.is_identity:
            raise file_error(path, "no projection in the file; add one: gdal_edit.py -a_srs EPSG:... -a_ullr ...")
        if dataset.colorinterp[0] in (ColorInterp.red, ColorInterp.palette):
            raise file_error(path, "a coloured picture, not heights")
        wkt = dataset.crs.to_wkt()
        return RasterTile(
            path=path,
            source=source,
            crs=dataset.crs,
            transform=tuple(dataset.transform)[:6],
            shape=dataset.shape,
            bands=dataset.count,
            scale=dataset.scales[0],
            offset=dataset.offsets[0],
            to_metres=_to_metres(path, dataset.units[0], wkt),
            vertical_datum=_vertical_datum(path, wkt),
        )


@contextmanager
def open_raster(path: Path, source: str) -> Iterator[Any]:
    """An open dataset; whatever rasterio raises or warns of becomes a TerrainError with the file."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NotGeoreferencedWarning)
            warnings.simplefilter("ignore", PendingDeprecationWarning)  # rasterio 1.4 under affine 3
            with rasterio.open(source) as dataset:
                yield dataset
    except RasterioError as error:
        cause = error.__cause__ or error
        raise file_error(path, f"not a raster that GDAL can read, or a damaged one ({cause})") from error


def is_hgt(path: Path) -> bool:
    """Whether a file is named as SRTM tiles are, `.hgt` or `.hgt.zip`."""
    return path.name.lower().endswith((".hgt", ".hgt.zip"))


def file_error(path: Path, message: str) -> TerrainError:
    """A TerrainError about a file."""
    return TerrainError(Problem(message, file=path))


def _source(path: Path) -> str:
    """What GDAL is to open: the file, or the one raster inside of a zip."""
    if not path.is_file():
        raise file_error(path, "there is no such file")
    if path.stat().st_size == 0:
        raise file_error(path, "an empty file; fetch it again")
    inside = _zipped(path) if path.suffix.lower() == ".zip" else None
    for name in (path.name, inside):
        if name is not None and name.lower().endswith((".hgt", ".hgt.zip")) and not _HGT_NAME.match(name):
            raise file_error(path, f"an HGT file is named after its corner, as S36E149.hgt is; {name} is not")
    if inside is None:
        return str(path)
    own, within = (_HGT_NAME.match(Path(name).name) for name in (path.name, inside))
    if own and within and own.group().upper() != within.group().upper():
        raise file_error(path, f"holds {inside}, which is another tile; rename the one that is wrong")
    return f"/vsizip/{path.resolve()}/{inside}"


def _zipped(path: Path) -> str:
    """The one raster in a zip file."""
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (zipfile.BadZipFile, OSError) as error:
        raise file_error(path, f"not a zip file, or a damaged one ({error}); fetch it again") from error
    rasters = [name for name in names if name.lower().endswith((".hgt", ".tif", ".tiff"))]
    if len(rasters) != 1:
        raise file_error(path, f"{len(rasters)} rasters in the zip; unpack it and name those you mean")
    return rasters[0]


def _to_metres(path: Path, unit: str | None, wkt: str) -> float:
    """The factor of the band's unit, or of the vertical projection's where the band names none."""
    vertical = _VERTICAL.search(wkt)
    word = (unit or (vertical.group(3) if vertical else "")).strip().lower().replace("_", " ")
    for words, factor in ((_METRES, 1.0), (_FEET, INTERNATIONAL_FOOT), (_SURVEY_FEET, US_SURVEY_FOOT)):
        if word in words:
            return factor
    raise file_error(path, f"heights in {word!r}, neither metres nor feet; say which: gdal_edit.py -units m")


def _vertical_datum(path: Path, wkt: str) -> str:
    vertical = _VERTICAL.search(wkt)
    if vertical:
        return vertical.group(2)
    return "EGM96" if is_hgt(path) else f"as in {path.name}"

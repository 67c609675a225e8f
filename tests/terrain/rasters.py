"""Small raster files for tests, in UTM zone 32 around 47° N, 9° E, and what they are compared by."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rasterio
from affine import Affine
from rasterio.warp import transform as warp

from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.terrain import Dem

UTM = "EPSG:32632"
ORIGIN = GeoPoint(47.0, 9.0)
FRAME = LocalFrame(ORIGIN)


def write(path: Path, heights: np.ndarray, crs: str | None, transform: Affine, **extra) -> Path:
    """A GeoTIFF; `tags`, `units`, `scales`, `offsets` are set on the dataset, the rest goes into the profile."""
    set_later = {key: extra.pop(key) for key in ("units", "scales", "offsets") if key in extra}
    tags = extra.pop("tags", {})
    bands = heights if heights.ndim == 3 else heights[None]
    profile = {"driver": "GTiff", "count": len(bands), "dtype": bands.dtype, **extra}
    height, width = bands.shape[1:]
    with rasterio.open(path, "w", width=width, height=height, crs=crs, transform=transform, **profile) as file:
        file.update_tags(**tags)
        for key, value in set_later.items():
            setattr(file, key, value)
        file.write(bands)
    return path


def from_origin(west: float, north: float, width: float, height: float) -> Affine:
    return Affine(width, 0.0, west, 0.0, -height, north)


def relief(rows: int, columns: int, dtype: str = "float32") -> np.ndarray:
    return np.random.default_rng(rows * columns).uniform(100, 900, (rows, columns)).astype(dtype)


def utm_corner() -> tuple[float, float]:
    (x,), (y,) = warp("EPSG:4326", UTM, [ORIGIN.longitude_deg], [ORIGIN.latitude_deg])
    return round(x, -1) - 500, round(y, -1) + 500


def write_hgt(path: Path, heights: np.ndarray) -> Path:
    path.write_bytes(heights.astype(">i2").tobytes())
    return path


def same_ground(one: Dem, other: Dem, reach: float) -> None:
    x, y = np.meshgrid(np.linspace(-reach, reach, 301), np.linspace(-reach, reach, 7))
    places = np.stack([x.ravel(), y.ravel()], axis=-1)
    both = one.heights_at(places), other.heights_at(places)
    assert np.isfinite(both[0]).all()
    np.testing.assert_allclose(both[0], both[1], atol=0.05)
    starts = np.column_stack([places, np.full(len(places), 1000.0)])
    ends = starts[::-1].copy()
    np.testing.assert_allclose(one.leg_heights(starts, ends), other.leg_heights(starts, ends), atol=0.05)

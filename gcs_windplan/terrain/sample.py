"""Real terrain that is on every machine: the DEM that matplotlib ships.

`jacksboro_fault_dem.npz` shows the Jacksboro fault in Tennessee: 344 x 403 heights 3 arc-seconds apart, row 0
to the north, from the USGS National Elevation Dataset (public domain).

Its `xmin`, `xmax`, `ymin` and `ymax` are the outer edges of the pixels, not the centres of the outermost
ones: (xmax - xmin) is 403 steps of `dx`, not 402, and the edges are odd multiples of half a step, so that the
centres fall on whole multiples of 3 arc-seconds, as they do in the NED. `ymin` names the northern edge.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np

from gcs_windplan.errors import TerrainError
from gcs_windplan.geo.frame import GeoPoint, LocalFrame
from gcs_windplan.terrain.dem import Dem
from gcs_windplan.terrain.gridmap import GeographicGrid
from gcs_windplan.terrain.surface import Extent
from gcs_windplan.terrain.window import Window, covering_window

NAME = "Jacksboro fault (matplotlib's sample DEM)"
SAMPLE_CENTRE = GeoPoint(36.5895833, -84.2458333)


def sample_dem(frame: LocalFrame, area: Extent | None = None) -> Dem:
    """matplotlib's DEM of the Jacksboro fault, heights in NAVD 88, seen from a local frame.

    `area` keeps only the part that covers that box. Raises TerrainError if matplotlib has no such file, or if
    the DEM lies somewhere else.
    """
    with np.load(_locate()) as archive:
        heights = np.asarray(archive["elevation"], dtype=np.float64)
        step, west, north = float(archive["dx"]), float(archive["xmin"]), float(archive["ymin"])
    grid = GeographicGrid(north - step / 2, west + step / 2, step, step, heights.shape[1])
    window = Window(0, 0, *heights.shape) if area is None else covering_window(grid, frame, area, heights.shape, NAME)
    part = GeographicGrid(
        grid.first_latitude - window.row * step,
        grid.first_longitude + window.column * step,
        step,
        step,
        window.columns,
    )
    return Dem.georeferenced(heights[window.slices], part, frame, NAME, "NAVD88")


def _locate() -> Path:
    """The file inside of the installed matplotlib, which is not imported for it."""
    spec = importlib.util.find_spec("matplotlib")
    if spec is None or not spec.submodule_search_locations:
        raise TerrainError("the sample terrain comes with matplotlib, which is not installed: pip install matplotlib")
    path = Path(spec.submodule_search_locations[0], "mpl-data", "sample_data", "jacksboro_fault_dem.npz")
    if not path.is_file():
        raise TerrainError(
            f"{path}: not there; this matplotlib was installed without its sample data, reinstall it with pip"
        )
    return path

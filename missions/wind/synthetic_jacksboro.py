"""Makes `jacksboro_synthetic.nc`: an invented wind over the real terrain that matplotlib ships.

    python missions/wind/synthetic_jacksboro.py

It is no forecast and solves no equations of motion. It puts together, from the terrain alone, what wind over
ridges and valleys is known for, so that a route has something to gain from bending and from choosing its
height:

- a flow from the west-south-west, 7 m/s at 80 m above the ground, growing with height by a power law;
- speed-up over ridges and shelter in valleys, in proportion to how high the ground stands above its
  surroundings, strongest near the ground (Jackson and Hunt 1975: the speed-up over a low hill is about twice
  its height over its half-length, and fades with height over that length);
- channelling: in a valley the flow near the ground turns along the valley's axis;
- a veer to the right with height, as friction leaves it in the northern hemisphere.

The terrain: Jacksboro fault, Tennessee, USGS, public domain, 3 arc seconds, as in matplotlib's sample data.
The same input gives the same file, byte for byte. `synthetic_front.py` takes its terrain and its profile from here.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import netCDF4
import numpy as np
from matplotlib import cbook
from scipy.ndimage import gaussian_filter, map_coordinates

from gcs_windplan.arrays import FloatArray

FILE = Path(__file__).with_name("jacksboro_synthetic.nc")

SPEED = 7.0  # [m/s] of the flow at 80 m above flat ground
FROM_DEG = 247.5  # west-south-west
REFERENCE = 80.0  # [m]
SHEAR = 0.16  # exponent of the power law; IEC 61400-1 (2005) takes 0.2 at most over land
VEER_PER_METRE = 8.0 / 190.0  # [deg/m] 8 degrees between 10 and 200 m
LEVELS = np.array([10.0, 40.0, 80.0, 120.0, 200.0, 500.0])  # [m] above the ground
SPACING = 0.02  # [deg]
MARGIN = 0.04  # [deg] around the terrain
FADING = 250.0  # [m] over which the terrain's grip on the flow falls to 1/e
GRAIN = 8  # cells that the terrain is smoothed by: about 700 m
SURROUNDINGS = 40  # cells that make the surroundings: about 3.5 km


def main() -> None:
    """Writes the file beside this script and says how strong its wind is."""
    latitudes, longitudes, u, v = synthesize()
    write(FILE, latitudes, longitudes, u, v)
    speed = np.hypot(u, v)
    for level, values in zip(LEVELS, speed, strict=True):
        print(f"{level:5.0f} m: {values.min():4.1f} to {values.max():4.1f} m/s, mean {values.mean():4.1f}")
    print(f"{FILE.name}: {FILE.stat().st_size} bytes")


class Land(NamedTuple):
    """What of the terrain the wind feels: see `relief`."""

    stand: FloatArray
    axis: FloatArray
    valley: FloatArray


def synthesize() -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Latitudes (ny,) and longitudes (nx,) [deg], u and v (levels, ny, nx) [m/s] towards east and north."""
    latitudes, longitudes = nodes(SPACING, MARGIN)
    land = land_at(latitudes, longitudes, GRAIN, SURROUNDINGS)
    parts = [flow(z, SPEED, FROM_DEG, land) for z in LEVELS]
    return latitudes, longitudes, np.stack([p[0] for p in parts]), np.stack([p[1] for p in parts])


def nodes(spacing: float, margin: float) -> tuple[FloatArray, FloatArray]:
    """Latitudes and longitudes on whole multiples of the spacing, at least the margin around the terrain [deg]."""
    _, south, north, west, east = terrain()

    def between(low: float, high: float) -> FloatArray:
        first, last = np.floor((low - margin) / spacing), np.ceil((high + margin) / spacing)
        return np.round(np.arange(first, last + 1) * spacing, 6)

    return between(south, north), between(west, east)


def land_at(latitudes: FloatArray, longitudes: FloatArray, grain: float, surroundings: float) -> Land:
    """The relief at the wind's nodes (ny, nx); beyond the terrain its edge goes on. `grain` as in `relief`."""
    heights, south, north, west, east = terrain()
    rows = (latitudes - south) / (north - south) * (heights.shape[0] - 1)
    columns = (longitudes - west) / (east - west) * (heights.shape[1] - 1)
    places = np.meshgrid(rows, columns, indexing="ij")
    stand, axis, valley = relief(heights, grain, surroundings)
    fields = (stand, np.cos(2 * axis), np.sin(2 * axis), valley)
    stand, cos2, sin2, valley = (map_coordinates(field, places, order=1, mode="nearest") for field in fields)
    return Land(stand, np.arctan2(sin2, cos2) / 2, valley)


def terrain() -> tuple[FloatArray, float, float, float, float]:
    """Heights [m], row 0 in the south; the outermost cells' centres south, north, west, east [deg]."""
    with cbook.get_sample_data("jacksboro_fault_dem.npz") as dem:
        heights = np.asarray(dem["elevation"], dtype=np.float64)[::-1]
        half_x, half_y = float(dem["dx"]) / 2, float(dem["dy"]) / 2
        edge_south, edge_north = sorted((float(dem["ymin"]), float(dem["ymax"])))  # its ymin is the northern one
        edge_west, edge_east = float(dem["xmin"]), float(dem["xmax"])
    return heights, edge_south + half_y, edge_north - half_y, edge_west + half_x, edge_east - half_x


def relief(heights: FloatArray, grain: float, surroundings: float) -> Land:
    """What of the terrain the wind feels, on its cells, smoothed by so many of them; so many make the surroundings.

    How the ground stands above its surroundings, -1 to 1; the direction of the valleys' axis [rad from east];
    how much of a valley it is, 0 to 1.
    """
    smooth = gaussian_filter(heights, grain, mode="nearest")
    anomaly = smooth - gaussian_filter(heights, surroundings, mode="nearest")
    stand = np.tanh(anomaly / (1.5 * anomaly.std()))
    slope_y, slope_x = np.gradient(smooth)  # the axis lies across the direction in which heights change most
    xx, yy, xy = (gaussian_filter(p, grain) for p in (slope_x**2, slope_y**2, slope_x * slope_y))
    axis = 0.5 * np.arctan2(2 * xy, xx - yy) + np.pi / 2
    return Land(stand, axis, np.clip(-stand, 0, 1))


def flow(
    z: float, speed: FloatArray | float, from_deg: FloatArray | float, land: Land
) -> tuple[FloatArray, FloatArray]:
    """u and v [m/s] at one height above the ground, of a flow that is told as at 80 m above flat ground."""
    grip = np.exp(-z / FADING)
    speed = speed * (z / REFERENCE) ** SHEAR * (1 + 0.6 * grip * land.stand)
    towards = np.radians(270.0 - from_deg - VEER_PER_METRE * (min(z, 200.0) - REFERENCE))  # from east, anticlockwise
    off = (land.axis - towards + np.pi / 2) % np.pi - np.pi / 2  # the valley's nearer end, at most a right angle away
    turned = towards + grip * land.valley * off * np.cos(off)  # across a valley the flow does not choose an end
    return speed * np.cos(turned), speed * np.sin(turned)


def write(path: Path, latitudes: FloatArray, longitudes: FloatArray, u: FloatArray, v: FloatArray) -> None:
    """A compressed NetCDF4 file by the CF conventions, rounded to 1 cm/s."""
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.Conventions = "CF-1.11"
        file.title = "synthetic wind made by gcs_windplan, not a forecast"
        file.source = "missions/wind/synthetic_jacksboro.py over the Jacksboro DEM (USGS, public domain)"
        grid(file, np.zeros(1), "hours since 2026-05-01 12:00:00", latitudes, longitudes)
        for name, values, standard in (("u", u, "eastward_wind"), ("v", v, "northward_wind")):
            wind(file, name, ("time", "height", "latitude", "longitude"), values[np.newaxis], standard)


def grid(file: netCDF4.Dataset, times: FloatArray, since: str, latitudes: FloatArray, longitudes: FloatArray) -> None:
    """The coordinates of time, height, latitude and longitude."""
    coordinate(file, "time", times, since, "time")
    file["time"].calendar = "standard"
    coordinate(file, "height", LEVELS, "m", "height")
    file["height"].positive = "up"
    file["height"].long_name = "height above ground"
    coordinate(file, "latitude", latitudes, "degrees_north", "latitude")
    coordinate(file, "longitude", longitudes, "degrees_east", "longitude")


def coordinate(file: netCDF4.Dataset, name: str, values: FloatArray, units: str, standard_name: str) -> None:
    """A dimension and its coordinate."""
    file.createDimension(name, len(values))
    variable = file.createVariable(name, "f8", (name,))
    variable.standard_name, variable.units = standard_name, units
    variable[:] = values


def wind(file: netCDF4.Dataset, name: str, dimensions: tuple[str, ...], values: FloatArray, standard_name: str) -> None:
    """A variable in m/s, packed in two bytes a value."""
    variable = file.createVariable(name, "i2", dimensions, compression="zlib", complevel=9, shuffle=True)
    variable.standard_name, variable.units, variable.scale_factor = standard_name, "m s-1", 0.01
    variable[:] = values


if __name__ == "__main__":
    main()

"""Makes `front_synthetic.nc`: an invented ensemble forecast of a cold front that crosses the Jacksboro terrain.

    python missions/wind/synthetic_front.py

It is no forecast and solves no equations of motion. It holds ten members, every three hours from 2026-05-01 06 UTC on
for a day, so that a route has something to gain from leaving at the right time, and from not trusting one member.
Clocks on the ground are four hours behind UTC. In the control, at 80 m above flat ground:

- ahead of the front a flow from the south-west, 5 m/s at night, that grows to 9 m/s at noon on the ground (16 UTC);
- close ahead of it a jet that adds 5 m/s, a band 19 km wide where it adds half of that or more, which moves with the
  front from north-west to south-east (low-level jets ahead of cold fronts: Browning and Pardoe 1973; this one is
  narrow so that the terrain holds both the jet and what lies beside it);
- the front, at 4 m/s a slow one, over the middle of the terrain at 18:50 UTC: within an hour the wind veers to
  north-west;
- behind it 8 m/s, which fade to 3 m/s in the evening as the ground cools;
- gusts of 1.4 times the wind at 10 m, most at the front: 1.8 times.

Each member has its own draw of when the front comes, how strong the wind is, from where it blows and how far ahead of
the front the jet lies. They part in proportion to the time since the run began at 00 UTC; when the control's front is
over the middle, by 1.2 h, 10 %, 8 degrees and 4 km in standard deviations. Member 0 is the control.

Between two times whoever reads the file goes straight from one wind to the other. So here the front takes three hours
to pass, and a jet that comes and goes between two times is not seen at all: that is what forecasts every three hours
are like. Height, ridges and valleys do what they do in `synthetic_jacksboro.py`, smoothed to the wider grid. The same
input gives the same file, byte for byte.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import netCDF4
import numpy as np
from synthetic_jacksboro import LEVELS, flow, grid, land_at, nodes, wind

from gcs_windplan.arrays import FloatArray

FILE = Path(__file__).with_name("front_synthetic.nc")

MEMBERS = 10
SEED = 20260501
TIMES = np.arange(6.0, 31.0, 3.0)  # [h] since the run
RUN = "hours since 2026-05-01 00:00:00"
SPACING = 0.05  # [deg]
MARGIN = 0.025  # [deg] around the terrain
GRAIN = 25  # cells that the terrain is smoothed by: about 2 km, so that the grid can tell ridges from valleys
SURROUNDINGS = 100  # cells that make the surroundings: about 9 km

NIGHT, NOON, BEHIND, EVENING = 5.0, 9.0, 8.0, 3.0  # [m/s] ahead of the front and behind it
WARMING = 8.0, 16.0  # [h] in which night becomes noon
COOLING = 19.0, 25.0  # [h] in which the wind behind the front fades
SOUTH_WEST, VEER = 225.0, 90.0  # [deg] where the wind comes from at first, and by how much the front turns it
PASSAGE = 18.0 + 50.0 / 60.0  # [h] when the control's front is over the middle
PACE = 14.4  # [km/h] of the front
WIDTH = 5.0  # [km] of the front: nine tenths of the turn take an hour
JET = 5.0  # [m/s] that the jet adds
JET_AHEAD = 12.0  # [km] of the front, its middle
JET_WIDTH = 8.0  # [km] standard deviation across
GUST, SQUALL = 1.4, 1.8  # times the wind at 10 m: far from the front, and at it
SQUALLS = 12.0  # [km] from the front, where 1/e of the difference is left

LATE, STRONG, TURNED, ASIDE = 1.2, 0.10, 8.0, 4.0  # [h, 1, deg, km] standard deviations when the control's front passes


class Member(NamedTuple):
    """What sets a member apart from the control, in standard deviations."""

    late: float
    strong: float
    turned: float
    aside: float


class Ensemble(NamedTuple):
    """Winds u and v (members, times, levels, ny, nx) and gusts at 10 m (members, times, ny, nx), all in m/s."""

    latitudes: FloatArray
    longitudes: FloatArray
    u: FloatArray
    v: FloatArray
    gusts: FloatArray


def main() -> None:
    """Writes the file beside this script and says how strong its wind is at 80 m."""
    made = synthesize()
    write(FILE, made)
    speed = np.hypot(made.u, made.v)[:, :, list(LEVELS).index(80.0)]
    for k, hour in enumerate(TIMES):
        control, strongest, gust = speed[0, k], speed[:, k].max(), made.gusts[:, k].max()
        print(
            f"{hour % 24:02.0f} UTC: control {control.min():4.1f} to {control.max():4.1f} m/s,"
            f" mean {control.mean():4.1f}; all members to {strongest:4.1f} m/s, gusts at 10 m to {gust:4.1f}"
        )
    print(f"{FILE.name}: {FILE.stat().st_size} bytes")


def synthesize() -> Ensemble:
    """The winds of all members at all times."""
    latitudes, longitudes = nodes(SPACING, MARGIN)
    land = land_at(latitudes, longitudes, GRAIN, SURROUNDINGS)
    along = south_eastward(latitudes, longitudes)
    winds, gusts = [], []
    for member in draw():
        for hour in TIMES:
            ahead = along - front_at(hour, member)
            speed, from_deg = weather(hour, ahead, member)
            levels = np.array([flow(z, speed, from_deg, land) for z in LEVELS])
            factor = GUST + (SQUALL - GUST) * np.exp(-((ahead / SQUALLS) ** 2))
            winds.append(levels)
            gusts.append(factor * np.hypot(*levels[0]))
    shape = MEMBERS, len(TIMES)
    u, v = np.moveaxis(np.reshape(winds, (*shape, *np.shape(winds)[1:])), 3, 0)
    return Ensemble(latitudes, longitudes, u, v, np.reshape(gusts, (*shape, *np.shape(gusts)[1:])))


def draw() -> list[Member]:
    """The control, and members whose draws have a mean of 0 and a standard deviation of 1."""
    draws = np.random.default_rng(SEED).standard_normal((MEMBERS - 1, len(Member._fields)))
    draws = (draws - draws.mean(axis=0)) / draws.std(axis=0)
    return [Member(0.0, 0.0, 0.0, 0.0), *(Member(*map(float, one)) for one in draws)]


def south_eastward(latitudes: FloatArray, longitudes: FloatArray) -> FloatArray:
    """How far to the south-east of the middle a node is (ny, nx) [km]."""
    north = (latitudes - latitudes.mean()) * 111.2
    east = (longitudes - longitudes.mean()) * 111.2 * np.cos(np.radians(latitudes.mean()))
    return (east[np.newaxis, :] - north[:, np.newaxis]) / np.sqrt(2)


def parted(hour: float) -> float:
    """How far the members have parted: 1 when the control's front passes."""
    return hour / PASSAGE


def front_at(hour: float, member: Member) -> float:
    """How far to the south-east of the middle the front is [km]."""
    return PACE * (hour - PASSAGE - LATE * member.late * parted(hour))


def weather(hour: float, ahead: FloatArray, member: Member) -> tuple[FloatArray, FloatArray]:
    """Speed [m/s] and direction [deg] at 80 m above flat ground, for nodes so far ahead of the front [km]."""
    spread = parted(hour)
    behind = (1 - np.tanh(ahead / WIDTH)) / 2
    jet = JET * np.exp(-(((ahead - JET_AHEAD - ASIDE * member.aside * spread) / JET_WIDTH) ** 2) / 2)
    before = NIGHT + (NOON - NIGHT) * eased(hour, *WARMING)
    after = BEHIND + (EVENING - BEHIND) * eased(hour, *COOLING)
    speed = (1 - behind) * before + behind * after + jet
    return speed * (1 + STRONG * member.strong * spread), SOUTH_WEST + VEER * behind + TURNED * member.turned * spread


def eased(hour: float, begin: float, end: float) -> float:
    """From 0 to 1 between two hours, smoothly."""
    return float((1 - np.cos(np.pi * np.clip((hour - begin) / (end - begin), 0, 1))) / 2)


def write(path: Path, made: Ensemble) -> None:
    """A compressed NetCDF4 file by the CF conventions, rounded to 1 cm/s."""
    with netCDF4.Dataset(path, "w", format="NETCDF4") as file:
        file.Conventions = "CF-1.11"
        file.title = "synthetic ensemble forecast made by gcs_windplan, not a forecast"
        file.source = "missions/wind/synthetic_front.py over the Jacksboro DEM (USGS, public domain)"
        file.comment = "An invented cold front; 10 members, of which 0 is the control."
        file.createDimension("number", MEMBERS)
        number = file.createVariable("number", "i4", ("number",))
        number.standard_name, number.units, number.long_name = "realization", "1", "ensemble member"
        number[:] = np.arange(MEMBERS)
        grid(file, TIMES, RUN, made.latitudes, made.longitudes)
        _alone(file, "forecast_reference_time", 0.0, units=RUN, calendar="standard")
        _alone(file, "gust_height", 10.0, units="m", standard_name="height", positive="up")
        across = ("latitude", "longitude")
        for name, values, standard in (("u", made.u, "eastward_wind"), ("v", made.v, "northward_wind")):
            wind(file, name, ("number", "time", "height", *across), values, standard)
            file[name].coordinates = "forecast_reference_time"
        wind(file, "gust", ("number", "time", *across), made.gusts, "wind_speed_of_gust")
        file["gust"].coordinates = "forecast_reference_time gust_height"


def _alone(file: netCDF4.Dataset, name: str, value: float, **attributes: str) -> None:
    """A coordinate of one value; its name is the standard name, unless another is given."""
    variable = file.createVariable(name, "f8", ())
    variable.setncatts({"standard_name": name} | attributes)
    variable[:] = value


if __name__ == "__main__":
    main()

"""The limits of a mission: what no leg may break, and what must be left in the battery on landing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field

from gcs_windplan.jobs.missionfile.areas import AreaModel
from gcs_windplan.jobs.missionfile.section import Section
from gcs_windplan.jobs.missionfile.values import Flag, LongTime, PositiveLength, PositiveSpeed, Reserve


class LimitsModel(Section):
    """What the route must keep, beside the clearance; each is a constraint when planning."""

    elsewhere: ClassVar[Mapping[str, str]] = {"clearance": "beside `limits:`, not into it"}

    wind: PositiveSpeed | None = Field(
        default=None,
        description="largest wind anywhere along the route, planned with 1 % to spare; over an ensemble in as many"
        " members as `robust` asks for",
    )
    gust: PositiveSpeed | None = Field(
        default=None, description="largest gust anywhere along the route, likewise; needs a forecast with gusts"
    )
    max_height: PositiveLength | None = Field(default=None, description="largest height above ground of any leg")
    keep_out: tuple[AreaModel, ...] = Field(default=(), description="areas no leg enters")
    keep_in: tuple[AreaModel, ...] = Field(default=(), description="areas no leg leaves")
    battery: Reserve | None = Field(
        default=None,
        description="share of the whole capacity that must be left at the end, such as `30 %`; needs an airframe",
    )
    reserve: LongTime | None = Field(
        default=None, description="of level flight at the airspeed, must be left at the end; needs an airframe"
    )
    way_home: Flag | None = Field(
        default=None,
        description="whether home or a rally point must be within the battery's reach from every waypoint; default:"
        " only for `finish: return`",
    )

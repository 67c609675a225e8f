"""Where findings lie."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcs_windplan.assessment import Assessment, Finding


@dataclass(frozen=True, slots=True)
class FindingPlace:
    """Where a finding lies, as far as it is known: the profile's sample, along the route [m], on earth."""

    sample: int | None = None
    distance: float | None = None
    latitude_deg: float | None = None
    longitude_deg: float | None = None


def place_of(assessment: Assessment, finding: Finding) -> FindingPlace:
    """The finding's own place; what it does not say is taken from its leg, its item, or the way flown.

    Several samples have one distance where it climbs upright: then the finding's leg tells which is meant.
    """
    profile, distance = assessment.profile, finding.distance
    if not len(profile.distance):
        return FindingPlace(None, distance, finding.latitude_deg, finding.longitude_deg)
    on_leg = np.flatnonzero(profile.leg == finding.leg) if finding.leg is not None else np.zeros(0, np.int64)
    if distance is None and len(on_leg):
        distance = float(profile.distance[on_leg[0]])
    if distance is None and finding.item is not None:
        distance = next((stop.distance for stop in assessment.stops if stop.item == finding.item), None)
    if distance is None:
        return FindingPlace(None, None, finding.latitude_deg, finding.longitude_deg)
    choice = on_leg if len(on_leg) else np.arange(len(profile.distance))
    sample = int(choice[np.abs(profile.distance[choice] - distance).argmin()])
    if finding.latitude_deg is None or finding.longitude_deg is None:
        here = float(profile.latitude_deg[sample]), float(profile.longitude_deg[sample])
        return FindingPlace(sample, distance, *here)
    return FindingPlace(sample, distance, finding.latitude_deg, finding.longitude_deg)

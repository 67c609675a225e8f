"""Findings in words: one sentence each, with the number, the limit and what to do, made of the finding's fields.

A rule without a sentence of its own is told by its name, its number and its limit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, Final

from gcs_windplan.assessment.assessment import Finding

_AREAS: Final = {
    "keep-out": ("enters the keep-out '{}'", "lead it around"),
    "keep-in": ("leaves the keep-in '{}'", "keep it inside"),
    "fence-out": (
        "enters the mission's own {}",
        "the autopilot will act on it; lead it around, or correct the fence",
    ),
    "fence-in": (
        "leaves the mission's own {}",
        "the autopilot will act on it; keep it inside, or correct the fence",
    ),
}
_JOULES: Final = 3600.0  # in a Wh

Facts = Mapping[str, Any]


def message_of(finding: Finding) -> str:
    """The finding in one sentence."""
    if finding.rule.startswith("firmware-"):
        return "{effect} by {firmware}: {line}".format(**finding.facts)
    return _SENTENCES.get(finding.rule, _by_its_number)(finding, finding.facts)


def _by_its_number(finding: Finding, facts: Facts) -> str:
    where = "" if finding.leg is None else f"{_leg(finding)}: "
    unit = f" {finding.unit}" if finding.unit else ""
    amount = "" if finding.value is None else f" of {finding.value:g}{unit}"
    limit = "" if finding.limit is None else f", where the limit is {finding.limit:g}{unit}"
    return f"{where}{finding.rule}{amount}{limit}"


def _terrain(finding: Finding, facts: Facts) -> str:
    outside, name = _number(finding.value), facts["terrain"]
    if finding.item == 0:
        return f"home lies {_metres(outside)} outside of the terrain ({name}): add a tile, or correct home"
    where = f"leads over a gap in the terrain ({name})"
    if outside > 0:
        where = f"leaves the terrain ({name}) by {_metres(outside)}"
    return f"{_leg(finding)} {where}; the ground there is unknown: add a tile that covers it, or move the leg"


def _clearance(finding: Finding, facts: Facts) -> str:
    lowest, least = _number(finding.value), _number(finding.limit)
    raised = f"raise it there by {math.ceil(least - lowest):.0f} m" if least > 0 else "raise it"
    if lowest < 0:
        where = f"runs {-lowest:.1f} m below the ground"
    else:
        where = f"comes within {lowest:.1f} m of the ground, less than the clearance of {least:g} m"
    return f"{_leg(finding)} {where}: {raised}, or lead it around"


def _circle(finding: Finding, facts: Facts) -> str:
    return (
        f"the circles of {facts['radius']:g} m at the end of {_leg(finding)} come within {finding.value:.1f} m of the"
        f" ground (clearance {finding.limit:g} m): raise item {finding.item}, or circle elsewhere"
    )


def _height(finding: Finding, facts: Facts) -> str:
    excess = _number(finding.value) - _number(finding.limit)
    lower = f"lower it there by {math.ceil(excess):.0f} m, or add a waypoint where the ground falls"
    return (
        f"{_leg(finding)} is {finding.value:.1f} m above ground, more than the limit of {finding.limit:g} m:"
        f" {'fly back by waypoints instead of the return' if facts['returning'] else lower}"
    )


def _obstacle(finding: Finding, facts: Facts) -> str:
    closer = -_number(finding.value)
    return f"{_move(finding)} comes {closer:.1f} m closer to an obstacle than its margin: raise it or lead it around"


def _area(finding: Finding, facts: Facts) -> str:
    breaks, advice = _AREAS[facts["kind"]]
    return f"{_move(finding)} {breaks.format(facts['area'])}: {advice}"


def _forecast(finding: Finding, facts: Facts) -> str:
    why = facts["reason"] or "it rises above the highest level of the wind"
    return f"{_leg(finding)}: the wind is not known there and taken as still air: {why}"


def _wind(finding: Finding, facts: Facts) -> str:
    first, last, members = facts["first_leg"], facts["last_leg"], facts["members"]
    who = f"{_leg(finding)} meets"
    if first != last:
        who = f"legs {first} to {last} meet, at worst on {_leg(finding)},"
    strongest = f" in the strongest of {members} members, {facts['broken_in']} of which break it" if members > 1 else ""
    return (
        f"{who} {'gusts' if finding.rule == 'gust' else 'wind'} of {finding.value:.1f} m/s{strongest}, more than the"
        f" limit of {finding.limit:g} m/s: choose another departure, or a lower or more sheltered route"
    )


def _flyable(finding: Finding, facts: Facts) -> str:
    if finding.unit != "members":
        return (
            f"{_leg(finding)} cannot be flown: in wind of {finding.value:.1f} m/s the vehicle cannot make headway at an"
            f" airspeed of {finding.limit:g} m/s: choose another departure, or a faster vehicle"
        )
    first, last = facts["first_leg"], facts["last_leg"]
    more = "" if first == last else f"; legs {first} to {last} in as many at most"
    return (
        f"{_leg(finding)} cannot be flown in {finding.value:.0f} of {facts['members']} members, whose wind is too"
        f" strong for an airspeed of {facts['airspeed']:g} m/s{more}: choose another departure, or a faster vehicle"
    )


def _airspeed(finding: Finding, facts: Facts) -> str:
    more = f", and {facts['others']} other legs too much" if facts["others"] else ""
    return (
        f"{_leg(finding)} takes an airspeed of {finding.value:.1f} m/s to keep its speed{more}, and the vehicle reaches"
        f" {finding.limit:.1f} m/s: it flies slower there and arrives later; command less, or fly in less wind"
    )


def _stall(finding: Finding, facts: Facts) -> str:
    first, last = facts["first_leg"], facts["last_leg"]
    who = f"{_leg(finding)} flies"
    if first != last:
        who = f"{_leg(finding)}, of legs {first} to {last} the nearest to the stall, flies"
    return (
        f"{who} at an airspeed of {finding.value:.1f} m/s, and at that height the wing stalls at {facts['stall']:.1f}"
        f" m/s: command {_number(finding.limit) / facts['stall']:.3g} times that, {finding.limit:.1f} m/s"
    )


def _gradient(finding: Finding, facts: Facts) -> str:
    climb = facts["climb"]
    late = "the autopilot waits for the height" if facts["hovers"] else "it arrives at another height"
    return (
        f"{_leg(finding)} {'climbs' if climb > 0 else 'descends'} {abs(climb):.0f} m on {facts['distance']:.0f} m,"
        f" {finding.value:.1f} m/s at its speed, and the vehicle does {finding.limit:g} m/s: {late}; give it"
        f" {facts['distance_needed']:.0f} m of distance, or circle"
    )


def _home(finding: Finding, facts: Facts) -> str:
    off = _number(finding.value)
    return (
        f"home is {abs(off):.1f} m {'above' if off > 0 else 'below'} the ground ({facts['altitude']:.1f} m against"
        f" {facts['ground']:.1f} m {facts['datum']}); where the vehicle is armed on the ground all heights above home"
        " are off by that: correct its altitude, or compare the datums"
    )


def _first_leg(finding: Finding, facts: Facts) -> str:
    return (
        f"the first place (item {finding.item}) lies {_metres(_number(finding.value))} from home, more than"
        f" {finding.limit:g} m: is this the mission of this site, and is home right?"
    )


def _landing(finding: Finding, facts: Facts) -> str:
    off = _number(finding.value)
    matters = "it comes down fast on higher ground, slowly on lower" if facts["hovers"] else "it flares at that height"
    return (
        f"item {finding.item} lands at {facts['altitude']:.1f} m above sea level, {abs(off):.1f} m"
        f" {'above' if off > 0 else 'below'} the ground there ({facts['ground']:.1f} m); {matters}: correct its"
        " altitude"
    )


def _endless(finding: Finding, facts: Facts) -> str:
    does = "loiters indefinitely" if facts["loiters"] else "repeats indefinitely"
    advice = "give it a count, and an end after it"
    if facts["loiters"]:
        advice = "use NAV_LOITER_TIME, and land or return after it"
    cut = f"; items after {finding.item} are unreachable" if facts["unreachable"] else ""
    return (
        f"item {finding.item}, {facts['command']}, {does}: it flies until the battery is empty, and time and battery"
        f" are counted up to there only{cut}; {advice}"
    )


def _ending(finding: Finding, facts: Facts) -> str:
    return (
        f"the mission ends in the air, with item {facts['last_item']}: it {facts['then']} until the battery is empty;"
        " landing or return is not counted: add a LAND or RTL"
    )


def _battery(finding: Finding, facts: Facts) -> str:
    left, least, stop = _number(finding.value), _number(finding.limit), facts["stop"]
    wanted = {
        "reserve": "the airframe's reserve",
        "battery": "the limit",
        "reserve-time": f"a reserve of {facts['reserve_seconds'] / 60:g} min",
    }[finding.rule]
    end = f"{left:.0f} % of the battery is left at the end"
    if left < 0:
        end = f"the mission takes {100 - left:.0f} % of the battery"
    return (
        f"{end}, and {wanted} asks for {least:.0f} %: {facts['missing'] / _JOULES:.0f} Wh are missing, from stop {stop}"
        " on; fly a shorter way, choose another departure, or a larger battery"
    )


def _return(finding: Finding, facts: Facts) -> str:
    return (
        f"from {_stops(facts)} the straight way home at {facts['height']:.0f} m above home runs"
        f" {-_number(finding.value):.0f} m below the ground (worst from item {finding.item}): set the return altitude"
        f" to {facts['needed']} m, or give a rally point"
    )


def _reach(finding: Finding, facts: Facts) -> str:
    places = "home and the rally points are" if facts["rally"] else "home is"
    why = "the wind on the way is too strong"
    if finding.value is not None:
        why = f"the way takes {finding.value:.0f} Wh, and {finding.limit:.0f} Wh may be drawn"
    return (
        f"from {_stops(facts)} {places} out of reach: {why} at item {finding.item}; add a rally point there, or choose"
        " another departure"
    )


_SENTENCES: Final[Mapping[str, Callable[[Finding, Facts], str]]] = {
    "terrain": _terrain,
    "clearance": _clearance,
    "circle": _circle,
    "height": _height,
    "obstacle": _obstacle,
    "keep-out": _area,
    "keep-in": _area,
    "fence": _area,
    "forecast": _forecast,
    "wind": _wind,
    "gust": _wind,
    "flyable": _flyable,
    "airspeed": _airspeed,
    "stall": _stall,
    "gradient": _gradient,
    "home": _home,
    "first-leg": _first_leg,
    "landing": _landing,
    "endless": _endless,
    "ending": _ending,
    "reserve": _battery,
    "battery": _battery,
    "reserve-time": _battery,
    "return": _return,
    "reach": _reach,
}


def _leg(finding: Finding) -> str:
    """A leg for people, with the item that it leads to."""
    return f"leg {finding.leg} (to item {finding.item})"


def _move(finding: Finding) -> str:
    """A leg, a take-off or a landing for people."""
    return f"the {finding.facts['move']} (item {finding.item})" if finding.leg is None else _leg(finding)


def _stops(facts: Facts) -> str:
    first, last = facts["first_stop"], facts["last_stop"]
    return f"stop {first}" if first == last else f"stops {first} to {last}"


def _metres(value: float) -> str:
    """A length for people: 12.3 m, 4.20 km."""
    if not math.isfinite(value):
        return "an unknown length"
    return f"{value / 1000:.2f} km" if abs(value) >= 2000 else f"{value:.1f} m"


def _number(value: float | None) -> float:
    return math.nan if value is None else value

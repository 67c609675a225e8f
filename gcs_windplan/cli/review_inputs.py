"""What the files of `gcs-windplan review` become: a planned or a read mission, judged."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from gcs_windplan.cli.review_world import Options, case_by_options, limits_with, read_departure, with_given_home
from gcs_windplan.cli.surroundings import is_file
from gcs_windplan.errors import InputError, Problem

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment, Case, Source

_MISSION_FILES = (".yaml", ".yml")
_LISTED = 4  # of a mission's repairs


def assessment_of(file: Path, world: Path | None, options: Options) -> Assessment:
    """A mission judged: one that is planned in its own world, one that is read in that of `world` or of the options.

    Raises `InputError`, and `NoRouteError` for a mission file without a route.
    """
    from gcs_windplan.assessment import assess

    case = _planned(file, options) if file.suffix.lower() in _MISSION_FILES else _read(file, world, options)
    software = _software()
    return assess(replace(case, sources=(*case.sources, software)))


def _planned(file: Path, options: Options) -> Case:
    """The mission that planning a mission file comes to, in its world."""
    from gcs_windplan.assessment.planned import case_of
    from gcs_windplan.jobs.missionfile import read_mission
    from gcs_windplan.planning.export import mission_of
    from gcs_windplan.planning.planner import plan_routes

    _refuse_two_worlds(file, options)
    request = read_mission(file, read_departure(options))
    plan = plan_routes(request, [request.cost])[0]
    case = case_of(request, mission_of(plan), tuple(_sources_of(file, case_wind=request.wind.name)))
    return with_given_home(replace(case, remarks=plan.notes, limits=limits_with(case.limits, options)), options)


def _read(file: Path, world: Path | None, options: Options) -> Case:
    """The mission in a ground station's file."""
    from gcs_windplan.formats import read_mission

    read = read_mission(file)
    said = tuple(f"{file.name}: {repair}" for repair in read.repairs)
    own = _source("mission", file, f"{len(read.mission.items)} items")
    if not read.mission.items:
        raise InputError(Problem("holds no items: there is nothing to judge", file=file))
    if world is None:
        case = case_by_options(read.mission, file.stem, file, options)
        sources = tuple(_sources_by_options(case, options))
    else:
        case = _in_world(file, world, options)
        case = replace(case, mission=replace(read.mission, autopilot=case.autopilot, vehicle_type=case.vehicle_type))
        case = with_given_home(case, options)
        sources = tuple(_sources_of(world, case_wind=case.wind.name, role=None))
    return replace(case, name=file.stem, remarks=(*said, *case.remarks), sources=(own, *sources))


def _in_world(file: Path, world: Path, options: Options) -> Case:
    """The case of a mission file's world, to put another mission into."""
    from gcs_windplan.assessment.planned import case_of
    from gcs_windplan.jobs.missionfile import read_mission
    from gcs_windplan.mission import Mission

    _refuse_two_worlds(world, options)
    request = read_mission(world, read_departure(options))
    case = case_of(request, Mission(()))
    said = f"judged by the terrain, wind, vehicle, limits and areas of {world}"
    limits = limits_with(replace(case.limits, first_leg=500.0), options)
    return replace(case, remarks=(said,), limits=limits)


def _refuse_two_worlds(file: Path, options: Options) -> None:
    """A mission file settles the world: options that say another one contradict it."""
    if options.world:
        raise InputError(Problem(f"cannot stand beside {file}, which says that itself: leave it out", options.world[0]))


def _sources_of(file: Path, case_wind: str, role: str | None = "mission") -> Iterator[Source]:
    """The mission file, and the files that it names."""
    from gcs_windplan.jobs.missionfile import read_document

    document = read_document(file)
    model = document.model
    yield _source(role or "limits", file, "planned by gcs-windplan" if role else "its world and limits")
    terrain = [document.beside(name) for name in (*(model.terrain.dem or ()), *filter(None, [model.terrain.mesh]))]
    yield from (_source("terrain", path, "") for path in terrain)
    if not terrain:
        yield _source("terrain", None, "", "sample DEM" if model.terrain.sample else "analytic surface")
    winds = [document.beside(name) for name in model.wind.forecast or ()]
    yield from (_source("wind", path, case_wind) for path in winds)
    if not winds:
        yield _source("wind", None, "", case_wind)
    if model.vehicle.airframe is not None:
        yield _source("vehicle", document.beside(model.vehicle.airframe), "")


def _sources_by_options(case: Case, options: Options) -> Iterator[Source]:
    yield from _named("terrain", options.terrain, case.terrain.name, f"heights in {case.terrain.vertical_datum}")
    yield from _named("wind", options.wind, case.wind.name, case.wind.name)
    if options.vehicle is not None:
        yield _source("vehicle", options.vehicle, "" if case.airframe is None else case.airframe.name)


def _named(role: str, names: Iterable[str], name: str, detail: str) -> Iterator[Source]:
    """The files that an option names, or its word."""
    files = [Path(word) for word in names if is_file(word)]
    yield from (_source(role, path, detail) for path in files)
    if not files:
        yield _source(role, None, detail, name)


def _source(role: str, path: Path | None, detail: str, name: str = "") -> Source:
    from gcs_windplan.assessment import Source

    if path is None:
        return Source(role, name, detail=detail if detail != name else "")
    return Source(role, path.name, str(path), _digest(path), detail)


def _digest(path: Path) -> str | None:
    """The file's SHA-256, None where it cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return None


def _software() -> Source:
    from importlib.metadata import version

    from gcs_windplan.assessment import Source

    return Source("software", f"gcs-windplan {version('gcs-windplan')}")

"""The files that a plan or a review comes to, by name, and writing them into a folder."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeAlias

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.formats import write_atomically

if TYPE_CHECKING:
    from gcs_windplan.assessment import Assessment
    from gcs_windplan.planning.planner import PlannedRoute
    from gcs_windplan.planning.request import Request

Files: TypeAlias = "dict[str, str | bytes]"

#: What can be written beside a review's page.
REVIEW_EXPORTS: Final = ("kml", "geojson", "csv", "png")


def file_stem(name: str) -> str:
    """A mission's name as the name of files."""
    return name.strip().lower().replace(" ", "_")


def plan_files(planned: PlannedRoute) -> Files:
    """The content of every file of a plan, by file name."""
    from gcs_windplan.formats import format_plan, format_waypoints
    from gcs_windplan.formats.summary import format_summary
    from gcs_windplan.planning.export import mission_of
    from gcs_windplan.report import draw_map, draw_profile

    stem, mission = file_stem(planned.request.name), mission_of(planned)
    files: Files = {}
    if planned.request.export.waypoints:
        files[f"{stem}.waypoints"] = format_waypoints(mission.without_fence())
    if planned.request.export.plan:
        files[f"{stem}.plan"] = format_plan(mission)
    files["summary.json"] = format_summary(planned)
    files["map.png"] = draw_map([planned])
    files["profile.png"] = draw_profile(planned)
    return files


def file_notes(request: Request, files: Files, folder: Path) -> Iterator[str]:
    """What must be known of a plan's files: what does not fit, and mission files of an earlier plan in the folder."""
    stem = file_stem(request.name)
    beside = [name for name, there in (("fence", request.fence), ("rally points", request.rally)) if there]
    if request.export.waypoints and beside:
        yield f"{stem}.waypoints has no place for {' and '.join(beside)}: upload {stem}.plan"
    for name in (f"{stem}.waypoints", f"{stem}.plan"):
        if name not in files and (folder / name).exists():
            yield f"{folder / name} is of an earlier plan; this one does not write it"


def review_files(assessments: Sequence[Assessment], page: str, also: Sequence[str] = ()) -> Files:
    """The page of judged missions by its name, and what is wanted beside it (of `REVIEW_EXPORTS`)."""
    from gcs_windplan.report import draw_assessment_map, render_page

    stem = Path(page).stem
    files: Files = {page: render_page(assessments)}
    for number, assessment in enumerate(assessments, start=1):
        files.update(_beside(assessment, stem if len(assessments) == 1 else f"{stem}-{number}", also))
    if "png" in also:
        files[f"{stem}.map.png"] = draw_assessment_map(assessments)
    return files


def make_folder(folder: Path) -> Path:
    """The folder, made if need be; raises `InputError` where it cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(Problem(f"the folder cannot be made ({error.strerror})", file=folder)) from None
    return folder


def write_files(files: Mapping[str, str | bytes], folder: Path) -> list[Path]:
    """Write files into a folder, each whole or not at all; nothing if one of the names is taken by a folder."""
    for name in files:
        if (folder / name).is_dir():
            text = "is a folder, and a file of this name is to be written: move it"
            raise InputError(Problem(text, file=folder / name))
    for name, content in files.items():
        write_atomically(folder / name, content)
    return [folder / name for name in files]


def _beside(assessment: Assessment, stem: str, also: Sequence[str]) -> Files:
    """The files of one mission that are wanted beside the page, by name."""
    from gcs_windplan.formats.geojson import format_geojson
    from gcs_windplan.formats.kml import format_kml
    from gcs_windplan.formats.legs_csv import format_legs_csv

    texts = {"kml": format_kml, "geojson": format_geojson, "csv": format_legs_csv}
    files: Files = {f"{stem}.{kind}": texts[kind](assessment) for kind in also if kind in texts}
    if "png" in also:
        from gcs_windplan.report import draw_assessment_profile

        files[f"{stem}.profile.png"] = draw_assessment_profile(assessment)
    return files

"""What a firmware will make of a mission, by its rules alone."""

from __future__ import annotations

from dataclasses import dataclass

from gcs_windplan.errors import InputError, Problem
from gcs_windplan.jobs.items import ItemsWords, file_of, items_of
from gcs_windplan.jobs.words import Naming
from gcs_windplan.mission.firmware import Firmware, autopilots, firmware_of
from gcs_windplan.mission.lint import EFFECTS, FINER_THAN_FLOWN, Effect, FirmwareFinding, lint
from gcs_windplan.progress import CancelToken, ProgressCallback
from gcs_windplan.vehicle import Autopilot, VehicleType


@dataclass(frozen=True, slots=True)
class Check:
    """What a firmware does to a mission: `findings`, an item each; `items` is how many there are.

    `notes` say what was repaired of the file, and what was assumed.

    >>> import gcs_windplan as gw
    >>> gw.check(gw.MissionItems((), autopilot="px4", vehicle_type="multicopter")).items
    0
    """

    firmware: Firmware
    items: int
    findings: tuple[FirmwareFinding, ...]
    notes: tuple[str, ...] = ()

    @property
    def matters(self) -> bool:
        """Whether more was found than places that are kept to a centimetre, which no vehicle flies."""
        return any(finding.rule not in FINER_THAN_FLOWN for finding in self.findings)

    @property
    def counts(self) -> dict[Effect, int]:
        """How many findings of each effect there are, worst first."""
        counted = {effect: sum(finding.effect == effect for finding in self.findings) for effect in EFFECTS}
        return {effect: number for effect, number in counted.items() if number}


def check(
    mission: ItemsWords,
    *,
    autopilot: Autopilot | None = None,
    vehicle_type: VehicleType | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelToken | None = None,
    named: Naming = str,
) -> Check:
    """Say what a firmware will reject, drop, round, change or ignore of a mission.

    `mission` is a ground station's file (.plan, .waypoints), `MissionItems`, or what `plan` takes, which is planned
    first. The rules are the firmware's own, with its default parameters; terrain and wind do not come into it.
    `autopilot` and `vehicle_type` take the place of the mission's. `named` is how the face that asks calls them.

    Raises `InputError` for a file that cannot be used or that names no autopilot, and as `plan` does.

    >>> import gcs_windplan as gw
    >>> plan = gw.plan(gw.Mission(
    ...     start=(36.55, -84.30), goal=(36.56, -84.28), vehicle=gw.Vehicle(12.0), terrain="flat:300",
    ... ))
    >>> gw.check(plan).firmware.name
    'ArduCopter'
    """
    read = items_of(mission, progress=progress, cancel=cancel)
    items, file, notes = read.mission, file_of(mission), list(read.repairs)
    pilot = autopilot or items.autopilot
    if pilot is None:
        option = named("autopilot")
        options = " or ".join(f"{option} {name}" for name in autopilots())
        text = f"does not say for which autopilot it is: give {options}"
        raise InputError(Problem(text, file=file))
    if items.autopilot not in (None, pilot):
        notes.append(f"the file is for {items.autopilot}, and {named('autopilot')} {pilot} asks for other rules")
    kind = vehicle_type or items.vehicle_type
    if kind is None:
        notes.append(
            "for which kind of vehicle is not said: only what all have in common was looked for; say it with"
            f" {named('vehicle_type')}"
        )
    firmware = firmware_of(pilot, kind)
    return Check(firmware, len(items.items), lint(items, firmware), tuple(notes))

"""What a firmware will reject, drop, round, change or ignore of a mission: its own rules, no terrain, no wind."""

from gcs_windplan.mission.lint.finding import EFFECTS, FINER_THAN_FLOWN, Effect, Firmware, FirmwareFinding
from gcs_windplan.mission.lint.lint import lint
from gcs_windplan.mission.lint.telling import Told, told

__all__ = ["EFFECTS", "FINER_THAN_FLOWN", "Effect", "Firmware", "FirmwareFinding", "Told", "lint", "told"]

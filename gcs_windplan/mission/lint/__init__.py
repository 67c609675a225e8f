"""What a firmware will reject, drop, round, change or ignore of a mission: its own rules, no terrain, no wind."""

from gcs_windplan.mission.lint.finding import EFFECTS, FINER_THAN_FLOWN, Effect, FirmwareFinding
from gcs_windplan.mission.lint.lines import FindingLine, finding_lines
from gcs_windplan.mission.lint.lint import lint

__all__ = ["EFFECTS", "FINER_THAN_FLOWN", "Effect", "FindingLine", "FirmwareFinding", "finding_lines", "lint"]

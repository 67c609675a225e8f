"""The mission file: what may stand in it, and the request that it makes."""

from gcs_windplan.spec.build import read_mission
from gcs_windplan.spec.parsing import MissionDocument, parse_mission, read_document

__all__ = ["MissionDocument", "parse_mission", "read_document", "read_mission"]

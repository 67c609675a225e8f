"""The paper's tables and figures, flown again."""

from gcs_windplan.reproduction.reproduce import Reproduction, reproduce
from gcs_windplan.reproduction.tables import Table

__all__ = ["Reproduction", "Table", "reproduce"]

"""The paper's tables and figures, flown again."""

from gcs_windplan.paper.reproduce import Reproduction, reproduce
from gcs_windplan.paper.tables import Table

__all__ = ["Reproduction", "Table", "reproduce"]

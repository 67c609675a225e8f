"""The manual: one Markdown page a topic, read from the package wherever it is installed."""

from __future__ import annotations

from gcs_windplan.manual.pages import read_page, topics

__all__ = ["read_page", "topics"]

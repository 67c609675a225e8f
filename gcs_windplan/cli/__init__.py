"""The command line."""

from gcs_windplan.cli.app import main

__all__ = ["main"]

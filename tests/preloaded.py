"""What the verbs import, loaded once."""

import importlib
import pkgutil

import gcs_windplan

for module in pkgutil.walk_packages(gcs_windplan.__path__, "gcs_windplan."):
    importlib.import_module(module.name)

"""The panels around the 3D view. A file in this folder that defines PANEL is a panel; nothing else needs to know it."""

import importlib
import pkgutil
from functools import cache

from viewer.panels.panel import Panel


@cache
def all_panels():
    """Every panel, in the order they stand on the page."""
    modules = (importlib.import_module(f"{__name__}.{m.name}") for m in pkgutil.iter_modules(__path__))
    found = (vars(module).get("PANEL") for module in modules)
    return tuple(sorted((p for p in found if isinstance(p, Panel)), key=lambda p: p.order))

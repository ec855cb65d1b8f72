"""Everything a person touches: the browser viewer, the command line, and `show` for notebooks."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from viewer.notebook import show

__all__ = ["show"]


def __getattr__(name):
    if name == "show":
        from viewer.notebook import show

        return show
    raise AttributeError(f"module 'viewer' has no attribute {name!r}")

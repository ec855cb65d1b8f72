"""What a panel is."""

from collections.abc import Callable
from dataclasses import dataclass

LEVELS = ("picture", "pixel", "path", "event")


@dataclass(frozen=True)
class Panel:
    """One part of the page.

    place: where it stands: header, left, right (above the tabs), tab, below.
    level: what it depends on; show is asked again when that, or something before it in LEVELS, changes.
    show: (session, say) -> plain values, which the template finds under the panel's name; None if it has none.
    template: Vue template; `w` holds the words whose key starts with "ui.".
    calls: window -> {name: function}, what its page may ask for beside the calls of viewer.calls.
    lazy: a tab that takes long to fill, and is filled only while it is open; else its state is None.
    """

    name: str
    place: str
    level: str
    order: int
    template: str
    show: Callable | None = None
    calls: Callable | None = None
    lazy: bool = False

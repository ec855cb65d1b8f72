"""Progress of long work, on standard error."""

import sys
from contextlib import contextmanager, nullcontext


def watched(what):
    """A context that gives a function progress(done, total), or None where nobody watches."""
    return bar(what) if sys.stderr.isatty() else nullcontext()


@contextmanager
def bar(what):
    """A progress bar; gives the function progress(done, total) that moves it."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (TextColumn(what), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(what)
        yield lambda done, total: progress.update(task, completed=done, total=total)

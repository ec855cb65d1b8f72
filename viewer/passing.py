"""A file for as long as it is read: what comes from the page lies nowhere else."""

import tempfile
from contextlib import contextmanager
from pathlib import Path

from tracer.settings import TracerError


@contextmanager
def passing(name, data):
    """The Path of a file of that (harmless) name with these bytes, in a folder of its own that is gone
    afterwards; the block's TracerErrors name no folder."""
    with tempfile.TemporaryDirectory(prefix="castray-") as folder:
        file = Path(folder) / name
        file.write_bytes(data)
        try:
            yield file
        except TracerError as error:
            raise TracerError(str(error).replace(str(file), name)) from None

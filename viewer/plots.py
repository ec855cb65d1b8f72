"""What pictures of curves have in common: where they may be written, and colours told apart by everyone."""

from tracer.settings import TracerError

# (Okabe and Ito 2008), without the yellow that vanishes on white.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")
GREY = "#666666"


def check_path(path):
    """TracerError unless a picture of that name can be written."""
    if path.suffix.lower() not in (".png", ".svg"):
        raise TracerError(f"{path}: a plot is written as .png or .svg")
    if not path.resolve().parent.is_dir():
        raise TracerError(f"{path}: there is no folder {path.resolve().parent}")


def write(page, path):
    """Write a matplotlib Figure to .png or .svg."""
    try:
        page.savefig(path, dpi=120)
    except OSError as error:
        raise TracerError(f"{path}: cannot be written: {error.strerror or error}") from None

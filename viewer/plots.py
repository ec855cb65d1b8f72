"""What pictures of curves have in common: where they may be written, colours for every eye, and letters."""

from contextlib import contextmanager

from tracer.settings import TracerError
from viewer.words import Speaker

# (Okabe and Ito 2008), without the yellow that vanishes on white.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")
GREY = "#666666"
# Fonts with Chinese letters: those of Linux, macOS and Windows; the last have other shapes of some.
CHINESE = (
    "Noto Sans CJK SC",
    "Noto Sans SC",
    "Source Han Sans SC",
    "WenQuanYi Micro Hei",
    "WenQuanYi Zen Hei",
    "PingFang SC",
    "Hiragino Sans GB",
    "Heiti TC",
    "Arial Unicode MS",
    "Microsoft YaHei",
    "SimHei",
    "Noto Sans CJK JP",
)


@contextmanager
def lettered(language=None):
    """A Speaker of what is drawn and written within; of English where no font has the language's letters."""
    import matplotlib as mpl
    from matplotlib.font_manager import fontManager

    say = Speaker(language)
    if say.language == "en":
        yield say
        return
    known = {font.name for font in fontManager.ttflist}
    chinese = [name for name in CHINESE if name in known][:1]
    with mpl.rc_context({"font.family": ["DejaVu Sans", *chinese]}):
        yield say if chinese else Speaker("en")


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

"""What every page of the site has: head, font, where the others are, and the other language."""

import base64
import importlib.util
import io
from functools import cache
from html import escape
from pathlib import Path

from tracer.settings import TracerError
from viewer.offline import document
from viewer.words import LANGUAGES, Speaker

HERE = Path(__file__).parent
# In English only: it is made of docstrings.
ENGLISH = ("reference.html",)


def named(stem, language):
    """The file of a page in a language."""
    return f"{stem}.html" if language == "en" else f"{stem}.{language}.html"


def framed(title, main, stem, language, styles="", scripts="", wide=False):
    """A page of the site. stem: its file's name without language and ending; wide: as wide as there is room."""
    say = Speaker(language)
    body = (
        f'<header class="top"><a class="home" href="{named("index", language)}">castray</a>'
        f'<nav>{_nav(say)}</nav><span class="languages">{_languages(stem, language)}</span></header>\n'
        f"<main{' class=wide' if wide else ''}>{main}</main>"
    )
    face = f'@font-face{{font-family:"STIX Two Math";src:url({font()})}}\n' if "<math" in main else ""
    own = (HERE / "site.css").read_text(encoding="utf-8")
    return document(title, body, language, face + own + styles, scripts)


def _nav(say):
    pages = {"index": named("index", say.language), "formulas": named("formulas", say.language)}
    pages |= {"reference": "reference.html", "log": named("log-format", say.language)}
    return " ".join(f'<a href="{href}">{escape(say(f"site.{name}"))}</a>' for name, href in pages.items())


def _languages(stem, language):
    """Links to the same page in other languages."""
    if f"{stem}.html" in ENGLISH:
        return ""
    others = {tag: name for tag, name in LANGUAGES.items() if tag != language}
    return " ".join(
        f'<a lang="{tag}" hreflang="{tag}" href="{named(stem, tag)}">{name}</a>'
        for tag, name in others.items()
    )


@cache
def font():
    """The maths font with what formulas use of it, as an address."""
    from fontTools import subset

    package = importlib.util.find_spec("ziamath")
    if package is None or package.origin is None:
        raise TracerError("the maths font is missing: install ziamath")
    options = subset.Options(
        flavor="woff", hinting=False, name_IDs=[], layout_features=["ssty", "math", "kern"]
    )
    face = subset.load_font(str(Path(package.origin).parent / "fonts" / "STIXTwoMath-Regular.ttf"), options)
    few = subset.Subsetter(options)
    few.populate(unicodes=_letters())
    few.subset(face)
    kept = io.BytesIO()
    subset.save_font(face, kept, options)
    return f"data:font/woff;base64,{base64.b64encode(kept.getvalue()).decode('ascii')}"


def _letters():
    """Code points: what is typed, and the italic and bold letters that a browser puts in its place."""
    ranges = ((0x20, 0x7F), (0x391, 0x3CA), (0x1D400, 0x1D468), (0x1D6E2, 0x1D71C))
    signs = "ϑϕϵℎℓ·×±÷−′″°…⋯⋅≤≥≠≈→⇒⟺⇔¯∞∫∑∏∂∈∝≡∼≪≫‖⊥∥⟨⟩⌊⌋∀∧∨√"
    return {k for low, high in ranges for k in range(low, high)} | {ord(sign) for sign in signs}

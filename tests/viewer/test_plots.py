"""The pictures of curves speak the reader's language, in letters that their font has."""

import re
import warnings
from types import SimpleNamespace

import pytest
from matplotlib.text import Text

import tracer
from viewer import plot_bench, plot_bsdf, plots
from viewer.commands.bsdf import report

CHINESE = re.compile(r"[\u4e00-\u9fff]")
OWN = re.compile(
    r"[-−.\d×° ]*|(?:path|direct).*|RMSE|roughdielectric.*|dielectric.*|\$.*\$"
)  # numbers and names


def curves():
    """What a figure of one scene is made of."""
    point = SimpleNamespace(seconds=(0.1,), rmse=(0.1, 0.05, 0.2), rel_mse=(0.2, 0.1, 0.3))
    later = SimpleNamespace(seconds=(0.4,), rmse=(0.05, 0.02, 0.1), rel_mse=(0.1, 0.05, 0.2))
    return SimpleNamespace(
        scene=SimpleNamespace(name="cornell"),
        base=tracer.Settings(width=8, height=8),
        spps=(1, 4),
        workers=2,
        label=lambda one: one,
        curves={"path-mis": [point, later]},
        reference=SimpleNamespace(mse=1e-3, rel_mse=0.15),
    )


def figures(say):
    yield plot_bench.figure([curves()], say)
    for name in ("dielectric", "roughdielectric"):
        yield plot_bsdf.figure(*report(name, {}), say)


def words(page):
    return [text.get_text() for text in page.findobj(Text) if text.get_text()]


def test_every_word_of_a_plot_is_in_the_language_that_was_asked_for(tmp_path):
    with plots.lettered("zh") as say:
        if say.language != "zh":
            pytest.skip("no font here has Chinese letters")
        for page in figures(say):
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # a letter that is missing
                plots.write(page, tmp_path / "page.png")
            said = words(page)
            assert [text for text in said if not CHINESE.search(text) and not OWN.fullmatch(text)] == []
    with plots.lettered("en") as say:
        assert not any(CHINESE.search(text) for page in figures(say) for text in words(page))


def test_without_a_font_that_has_the_letters_the_words_are_english(monkeypatch):
    monkeypatch.setattr(plots, "CHINESE", ())
    with plots.lettered("zh") as say:
        assert say.language == "en"

"""The table of commands."""

import importlib
import inspect
import itertools
import json
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from rich.cells import cell_len
from suite import castray

import tracer
from viewer import spoken_help
from viewer.cli import COMMANDS, EXAMPLES, main
from viewer.folded import ends_of_lines
from viewer.spoken_help import name_of
from viewer.words import LANGUAGES, Speaker, areas
from viewer.words.language import ENVIRONMENT


def first_clause(text):
    return re.match(r"[^.,:?(]+", " ".join(text.split()))[0].strip()


@pytest.mark.parametrize("name", COMMANDS)
def test_what_the_table_says_of_a_command_is_what_its_own_help_begins_with(name):
    module = importlib.import_module(f"viewer.commands.{name}")
    said = Speaker("en")(f"command.{name}")
    assert first_clause(inspect.getdoc(getattr(module, name))) == first_clause(said)


def test_the_list_of_commands_waits_for_no_command():
    code = (
        "import sys\n"
        "from viewer.cli import command_line\n"
        "from viewer.words import Speaker\n"
        "command_line(Speaker())(['--help'], result_action='return_value')\n"
        "heavy = {'tracer.scene', 'tracer.engine', 'scipy', 'rich.markdown', 'lessons.zoo'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)\n"
    )
    ran = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True, timeout=60
    )
    assert ran.stderr.splitlines()[-1] == "[]"


def test_a_command_that_is_not_there_is_named_with_one_that_is():
    ran = castray("rendr")
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1
    assert "rendr" in ran.stderr and "render" in ran.stderr


@pytest.mark.parametrize(("command", "said"), [*EXAMPLES.items()])
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_command_without_what_it_needs_says_an_example(command, said, language, capsys):
    with pytest.raises(SystemExit) as ended:
        main([command, "--lang", language])
    line = capsys.readouterr().err
    assert ended.value.code == 2 and line.count("\n") == 1 and line.endswith(f"castray {command} {said}\n")


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_list_of_commands_says_where_to_begin(language, capsys):
    assert "castray view cornell_unit" in " ".join(helped(capsys, "--lang", language).split())


@pytest.mark.parametrize(
    ("words", "environment", "language"),
    [
        ((), {}, "en"),
        ((), {"LANGUAGE": "zh_CN:en"}, "zh"),
        ((), {"LANGUAGE": "fr:zh"}, "zh"),
        ((), {"LANG": "zh_CN.UTF-8"}, "zh"),
        ((), {"LANG": "fr_FR.UTF-8"}, "en"),
        ((), {"LC_ALL": "C.UTF-8", "LANG": "zh_CN.UTF-8"}, "en"),
        (("--lang", "en"), {"LANG": "zh_CN.UTF-8"}, "en"),
        (("--lang=zh",), {}, "zh"),
    ],
)
def test_the_terminal_speaks_the_language_that_is_asked_for(
    words, environment, language, monkeypatch, capsys
):
    for name in ENVIRONMENT:
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    with pytest.raises(SystemExit):
        main([*words, "--help"])
    assert Speaker(language)("command.view") in capsys.readouterr().out


def test_the_path_options_of_a_command_speak_it_too(capsys):
    for language, other in (("zh", "en"), ("en", "zh")):
        with pytest.raises(SystemExit):
            main(["--lang", language, "inspect", "--help"])
        out = capsys.readouterr().out
        assert Speaker(language)("help.path_options") in out
        assert Speaker(other)("help.path_options") not in out
        assert Speaker(language).setting("spp") in out


CHINESE = re.compile(r"[\u4e00-\u9fff]")


def helped(capsys, *words):
    """What `castray WORDS --help` prints, an option a line."""
    with pytest.raises(SystemExit):
        main([*words, "--help"])
    return capsys.readouterr().out


@pytest.mark.parametrize("language", LANGUAGES.keys() - {"en"})
def test_no_option_of_any_command_is_explained_in_english_only(language, capsys, monkeypatch):
    """And the tables explain none that there is not."""
    monkeypatch.setenv("COLUMNS", "600")
    there = {}
    for command in ("", *COMMANDS):
        names = there[command] = set()
        monkeypatch.setattr(
            spoken_help, "name_of", lambda e, names=names: names.add(name_of(e)) or name_of(e)
        )
        out = helped(capsys, "--lang", language, *command.split())
        lines = [line for line in out.splitlines() if line.startswith("│")]
        assert len(lines) == len(names) > 0
        said = [re.sub(r"^│ +(\* +)?[-A-Z_[\]. ]+(?=  )", "", line) for line in lines]
        assert [line for line in said if not CHINESE.search(line)] == []
        assert re.findall(r"(?:\b[a-z]+ ){4,}", out) == []  # four English words in a row
    own = {f"option.{command}.{name}" for command, names in there.items() for name in names}
    any_ = {f"option.{name}" for names in there.values() for name in names}
    assert areas()["options"][language].keys() <= own | any_


def test_an_option_without_a_translation_would_be_seen(capsys, monkeypatch):
    """The test above can fail: English help has many words in a row."""
    monkeypatch.setenv("COLUMNS", "600")
    assert re.findall(r"(?:\b[a-z]+ ){4,}", helped(capsys, "render"))


def test_chinese_lines_end_anywhere_but_before_what_closes_a_sentence():
    text = "查看器地址栏里的链接；castray render 写出的文件夹（其中的位置：DIR#x=..），或别的。" * 3
    for width in range(24, 60):
        ends = [0, *ends_of_lines(text, width), len(text)]
        lines = [text[a:b] for a, b in itertools.pairwise(ends)]
        assert "".join(lines) == text
        assert all(cell_len(line.rstrip()) <= width for line in lines)
        assert all(line[0] not in "，。；：）" and line.rstrip()[-1] not in "（" for line in lines)
        assert not any("castray"[:k] == line.rstrip()[-k:] for line in lines for k in range(1, 7))


def test_a_word_longer_than_a_line_is_cut_into_lines_and_none_of_it_is_lost():
    text = "在 cast_ray 中：'very_long_attribute_name_that_does_not_exist'，见这里\n第二行"
    for width in range(12, 60):
        ends = [0, *ends_of_lines(text, width), len(text)]
        lines = [line for a, b in itertools.pairwise(ends) for line in text[a:b].split("\n")]
        assert "".join(lines) == text.replace("\n", "")
        assert all(cell_len(line.rstrip()) <= width for line in lines)


@pytest.mark.parametrize("words", [("--lang", "fr"), ("--lang",), ("--lang=",)])
def test_a_language_that_is_not_known_is_refused_with_those_that_are(words, capsys):
    with pytest.raises(SystemExit) as end:
        main(["bugs", *words])
    said = capsys.readouterr().err
    assert end.value.code == 2 and len(said.splitlines()) == 1
    assert all(language in said for language in LANGUAGES)


def test_a_vertex_without_a_direction_is_printed_as_json_all_the_same(capsys):
    words = ("inspect", "pool", "--bug", "S02", "--pixel", "175", "96", "--spp", "8", "--sample", "1")
    with pytest.raises(SystemExit):
        main([*words, "--event", "2", "--json"])
    document = json.loads(capsys.readouterr().out)
    assert document["lens"]["vectors"]["wi"] == [None, None, None]


def test_a_render_says_what_was_saved_only_where_something_was(capsys, tmp_path):
    said = []
    for words in ((), ("--adaptive", "mse")):
        main_of("render", "cornell_unit", "--size", 16, 16, "--spp", 64, *words, "-o", tmp_path / "a.png")
        said.append(capsys.readouterr().out)
    assert "samples per pixel" not in said[0]
    assert "median" in said[1] and "of 64 saved" not in said[1]


def test_a_stopped_render_says_how_much_is_there(monkeypatch, capsys, tmp_path):
    def stopped(*args, **options):
        samples = np.where(np.arange(256).reshape(16, 16) < 64, 64, 0)
        return replace(render(*args, **options), samples=samples, complete=False)

    render = tracer.render
    monkeypatch.setattr(tracer, "render", stopped)
    main_of("render", "cornell_unit", "--size", 16, 16, "--spp", 64, "-o", tmp_path / "a.png")
    out = capsys.readouterr().out
    assert "25% of the samples are there" in out and "of 64 saved" not in out


def main_of(*words):
    with pytest.raises(SystemExit):
        main([*map(str, words)])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("doctor", "mine.py"), "castray check mine.py judges it"),
        (("view", "box.cpp"), "castray log --header castray.h"),
        (("check", "trace.js"), "castray log --schema"),
        (("render", "mine.jsonl"), "castray doctor mine.jsonl --scene SCENE"),
        (
            ("inspect", "cornell"),
            "--pixel takes 2 numbers; for example: castray inspect cornell --pixel 50 57",
        ),
        (("render", "cornell", "--size", "8"), "castray render cornell --size 64 64"),
    ],
)
def test_who_gives_a_file_or_numbers_that_will_not_do_is_told_what_does(
    words, said, monkeypatch, tmp_path, capsys
):
    monkeypatch.chdir(tmp_path)
    for name in ("mine.py", "box.cpp", "trace.js", "mine.jsonl"):
        (tmp_path / name).write_text("// mine", encoding="utf-8")
    for language in LANGUAGES:
        with pytest.raises(SystemExit) as ended:
            main(["--lang", language, *words])
        out, err = capsys.readouterr()
        assert ended.value.code == 2 and not out and len(err.splitlines()) == 1
        assert said in err or language != "en"

"""`castray check FOLDER`: every submission is a row, whatever it does."""

import csv
import json
import os
import shlex
from html.parser import HTMLParser

import pytest
from logs import INNER, OUTER, write_log
from suite import castray

import tracer
from lessons.zoo import ZOO
from tracer.doctor.picture import Hypothesis
from tracer.learner import starter
from viewer.checking import report
from viewer.checking.limited import Judge
from viewer.checking.submission import FAILED, MAYBE, RIGHT, SKIPPED, WRONG, Row, files_in, row_of
from viewer.doctor_report import equation
from viewer.options import CheckOptions
from viewer.replay import of_scene
from viewer.words import Speaker

pytestmark = pytest.mark.slow

FEW = CheckOptions(size=(6, 6), spp=2)
SAY = Speaker("en")


def text():
    with open(starter.__file__, encoding="utf-8") as file:
        return file.read()


def row(tmp_path, name, content, seconds=30.0):
    path = tmp_path / name
    path.write_text(content, encoding="utf-8")
    return row_of(path, name, "cornell", FEW, seconds)


def test_a_right_tracer_passes_in_all_its_parts(tmp_path):
    found = row(tmp_path, "李雷 (1).py", text())
    assert (found.state, found.failed) == (RIGHT, ()) and {"light", "bounce", "hit"} <= {*found.passed}


def test_a_wrong_one_is_named_with_the_part_that_fails_and_the_command_that_proves_it(tmp_path):
    found = row(tmp_path, "追踪器.py", text().replace("* f * cos * cos_light", "* f * cos_light"))
    assert found.state == WRONG and found.failed == ("light",) and "light" not in found.passed
    assert found.found.bug == "D10" and "--size 6 6 --spp 2" in found.command


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("def cast_ray(scene:\n", "mine.py:1: "),
        pytest.param("import os\nos._exit(7)\n", "ended with code 7", marks=pytest.mark.slow),
        pytest.param(
            "raise ValueError('<script>')\n",
            "mine.py:1: in <module>: ValueError",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_what_fails_is_a_row_that_says_why(tmp_path, content, said):
    found = row(tmp_path, "mine.py", content)
    assert found.state == FAILED and said in found.error


def test_the_row_says_an_error_without_its_name_and_in_chinese():
    failed = Row(
        "a/b.py",
        FAILED,
        error="b.py: its process ended with code 7; it may take 4 GiB of memory",
        path="a/b.py",
    )
    assert report.finding(failed, SAY).startswith("its process ended")
    assert report.finding(failed, Speaker("zh")).startswith("它的进程以代码 7 结束")
    slip = Row("b.py", FAILED, error="b.py:19: '(' was never closed", path="a/b.py")
    assert report.finding(slip, SAY) == "line 19: '(' was never closed"
    assert report.finding(slip, Speaker("zh")).startswith("第 19 行：")
    log = Row(
        "c.jsonl",
        FAILED,
        error="c.jsonl: no line can be read; line 2: not JSON: x at column 1",
        path="c.jsonl",
    )
    assert report.finding(log, Speaker("zh")) == "没有一行能读取；第 2 行：不是 JSON：x，在第 1 列"
    parts = Row("d.py", WRONG, failed=("path", "escape"))
    assert report.cells(parts, Speaker("zh"))["failed"] == "路径、逃逸"


def test_numbers_that_are_none_are_told_in_the_readers_language():
    assert equation("t", [None, None], SAY) == "t = NaN or ∞"
    assert equation("t", [None, None], Speaker("zh")) == "t = NaN 或 ∞"


def test_names_of_what_is_never_met_are_listed_as_chinese_lists():
    assert Speaker("zh").clue("no ray meets floor, lamp") == "没有光线遇到 floor、lamp"


def test_a_tracer_that_hangs_is_ended_and_is_a_row(tmp_path):
    found = row(tmp_path, "hang.py", "while True:\n    print('spam')\n", seconds=1.0)
    assert found.state == FAILED and "not done after 1 s" in found.error


def test_a_log_that_takes_too_long_is_a_row_and_the_next_one_is_judged(tmp_path):
    for name in ("a.jsonl", "b.jsonl"):
        (tmp_path / name).write_text("nonsense", encoding="utf-8")
    with Judge("cornell", FEW, 1e-9) as judge:
        assert "not done after" in judge.row(tmp_path / "a.jsonl", "a.jsonl").error
        judge._asked = "cornell", FEW, 60.0
        assert "line 1" in judge.row(tmp_path / "b.jsonl", "b.jsonl").error


def test_a_picture_is_called_by_the_title_of_what_it_fits():
    found = Row("p.png", MAYBE, found=Hypothesis(("E01",)))
    assert report.finding(found, SAY) == f"E01 {ZOO['E01'].title}"
    assert "black" in report.finding(Row("p.png", MAYBE, found=Hypothesis(())), SAY)


def test_broken_logs_and_pictures_are_rows_and_other_files_are_skipped(tmp_path):
    assert row(tmp_path, "log.jsonl", "nonsense").state == FAILED
    assert row(tmp_path, "p.png", "nonsense").state == FAILED
    assert row(tmp_path, "essay.txt", "nonsense").state == SKIPPED


def test_files_are_found_below_and_hidden_ones_are_not(tmp_path):
    for name in ("b/我.py", "a.py", ".git/x.py", "__pycache__/y.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("", encoding="utf-8")
    assert [name for _, name in files_in(tmp_path)] == ["a.py", "b/我.py"]


NASTY = (
    "=1+1.py",
    "+x.py",
    "-x.py",
    "@SUM(A1).py",
    "  =x.py",
    "\t=x.py",
    "<script>alert(1)</script>.py",
    '"&\x1b[31m.py',
)


def test_no_cell_of_the_csv_is_a_formula():
    rows = [Row(name, FAILED, error=f"={name}") for name in NASTY]
    told = list(csv.reader(report.as_csv(rows, SAY).removeprefix("\ufeff").splitlines()))
    assert len(told) == len(NASTY) + 1
    assert not any(cell.lstrip().startswith(("=", "+", "-", "@")) for line in told for cell in line)


def test_names_and_errors_are_text_in_the_page():
    class Tags(HTMLParser):
        seen: set

        def handle_starttag(self, tag, attributes):
            self.seen.add((tag, *(name for name, _ in attributes if name.startswith("on"))))

    rows = [Row(name, FAILED, error="<img src=x onerror=alert(1)>") for name in NASTY]
    page, tags = report.as_html(rows, "<b>", "cornell", SAY), Tags()
    tags.seen = set()
    tags.feed(page)
    assert ("img", "onerror") not in tags.seen and ("img",) not in tags.seen and "\x1b" not in page
    assert "<script>alert(1)" not in page and "http://" not in page.replace("http://www.w3.org", "")


@pytest.mark.browser
def test_every_row_of_the_page_is_written_alike(tmp_path, visit):
    rows = [Row("a.py", state, passed=("hit", "bounce")) for state in (RIGHT, WRONG, MAYBE, FAILED, SKIPPED)]
    (tmp_path / "rows.html").write_text(report.as_html(rows, "a", "cornell", SAY), encoding="utf-8")
    tab = visit((tmp_path / "rows.html").as_uri(), ready=False)
    fonts = tab.locator("tbody td:nth-child(3)").evaluate_all(
        "all => all.map((e) => getComputedStyle(e).font)"
    )
    assert len(fonts) == len(rows) and len(set(fonts)) == 1


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder, bug = tmp_path_factory.mktemp("提交 1"), ZOO["D06"]
    wrong = text().replace("* f * cos * cos_light", "* f * cos_light")
    (folder / "wrong.py").write_text(wrong, encoding="utf-8")
    (folder / ("很长" * 30 + ".py")).write_text("1/0", encoding="utf-8")
    (folder / "notes.txt").write_text("", encoding="utf-8")
    settings = bug.asked(width=32, height=32, spp=8)
    tracer.write(tracer.render(tracer.load("cornell"), settings, steps=bug.steps), folder / "walls.npy")
    return folder


def test_the_command_writes_table_csv_and_page_and_says_1(folder, tmp_path):
    few = ("--size", 6, 6, "--spp", 2)
    written = ("--csv", tmp_path / "t.csv", "--html", tmp_path / "t.html")
    ran = castray("check", folder, *few, *written, env={"COLUMNS": "80"})
    assert ran.returncode == 1, ran.stderr
    said = ("wrong.py", "D10", "D06", "not judged", "looks wrong", "line 1:", "notes.txt", "castray check ")
    for words in (*said, "Written: "):
        assert words in ran.stdout
    assert "很长" in (tmp_path / "t.csv").read_text(encoding="utf-8")
    assert 'data-state="findings"' in (tmp_path / "t.html").read_text(encoding="utf-8")


def test_json_has_a_row_each(folder):
    said = json.loads(castray("check", folder, "--size", 6, 6, "--spp", 2, "--json").stdout)
    assert {r["state"] for r in said["rows"]} == {"findings", "failed", "hypotheses"}
    assert said["skipped"] == ["notes.txt"]


@pytest.mark.parametrize("words", [("{empty}",), ("{file}", "--csv", "x.csv"), ("{full}", "--scene", "no"),
                                   ("{full}", "--csv", "no/such/x.csv")])  # fmt: skip
def test_bad_input_is_one_line_and_code_2(folder, tmp_path, words):
    empty = tmp_path / "empty"
    empty.mkdir()
    places = {"empty": empty, "file": folder / "wrong.py", "full": folder}
    ran = castray("check", *(word.format(**places) for word in words), cwd=tmp_path)
    assert ran.returncode == 2 and len(ran.stderr.splitlines()) == 1 and not ran.stdout
    assert os.listdir(tmp_path) == ["empty"]


@pytest.mark.parametrize("file", ["mine.py", "my homework (2).py", "光线 追踪.jsonl", "it's.py"])
def test_a_command_that_is_printed_can_be_typed_whatever_the_file_is_called(file):
    assert shlex.split(of_scene(file, "cornell")) == [file, "--scene", "cornell"]


@pytest.mark.browser
def test_the_page_copies_the_command_of_a_finding(browser, tmp_path):
    log = write_log(tmp_path / "my log.jsonl", OUTER | {"direct": [0.9, 0.9, 0.9]}, INNER)
    found = row_of(log, log.name, "cornell", FEW, 60.0)
    (tmp_path / "t.html").write_text(report.as_html([found], tmp_path, "cornell", SAY), encoding="utf-8")
    context = browser.new_context()
    page = context.new_page()
    page.goto((tmp_path / "t.html").as_uri())
    section = page.locator(".finding").first
    section.get_by_role("button", name="copy").click()
    assert page.evaluate("getSelection().toString()") == found.found.command
    assert (
        found.found.command.startswith("castray view ")
        and section.locator("code").inner_text() == found.found.command
    )
    context.close()

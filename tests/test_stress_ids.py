"""Every stress case has a test with its id in its name: test_s01_..., ..._s08."""

import re
from collections import Counter
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parent
IDS = """
    S01 S02 S03 S04 S05 S08 S09 S10 S12 S13 S14 S16 S18 S19 S20 S22 S23 S25 S26 S28 S29 S30 S32 S33 S34
    S36 S37 S38 S40 S41 S42 S44 S46 S47 S48 S49 S50 S51 S52 S54 S55 S56 S58 S59 S60 S62 S63 S64 S67
""".split()
DEFINED = re.compile(r"^\s*def (test_\w+)", re.MULTILINE)
ID = re.compile(r"(?<=_)s[0-9]{2}(?=_|$)")


def named(folder):
    """How many tests carry each id in their name."""
    found = Counter()
    for path in sorted(folder.rglob("test_*.py")):
        for name in DEFINED.findall(path.read_text(encoding="utf-8")):
            found.update(case.upper() for case in ID.findall(name))
    return found


@pytest.fixture(scope="module")
def found():
    return named(TESTS)


def test_there_are_forty_nine_cases():
    assert len(IDS) == len(set(IDS)) == 49


@pytest.mark.parametrize("case", IDS)
def test_a_stress_case_has_a_test(found, case):
    assert found[case] > 0


def test_no_test_is_named_for_a_case_that_is_none(found):
    assert not set(found) - set(IDS)


def test_a_case_without_a_test_is_missed(tmp_path):
    """The broken twin."""
    (tmp_path / "test_one.py").write_text(
        "def test_s01_this():\n    pass\ndef this_s02():\n    pass\n", encoding="utf-8"
    )
    assert named(tmp_path) == {"S01": 1}

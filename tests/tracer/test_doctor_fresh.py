"""What only distributions show is tried again on fresh and larger data."""

import json

import numpy as np
import pytest
from mutants import changed, traced
from suite import castray, suite_seed

from tracer.doctor import examine
from tracer.doctor.fresh import TIMES, by_chance, confirmed, fresh
from viewer.doctor_report import chance
from viewer.words import Speaker


@pytest.mark.slow
@pytest.mark.statistical
def test_what_fresh_data_do_not_show_is_no_finding():
    odd = traced("lamps", spp=8, seed=suite_seed())
    first = examine(changed(odd, "light.u", np.sqrt))
    assert by_chance(first) and {f.rule for f in first.causes} >= {"numbers-uniform"}
    other = traced("lamps", spp=8 * TIMES, seed=fresh(odd.settings).seed)
    again = confirmed(first, other)
    assert not again.findings
    assert {v.rule.id: v.state for v in again.rules}["numbers-uniform"] == "clean"
    stays = confirmed(first, changed(other, "light.u", np.sqrt))
    assert {f.confirmed for f in stays.findings} == {True} and not by_chance(stays)
    said = [chance(d.findings[0], Speaker()) for d in (first, stays)]
    assert "not tried on fresh data" in said[0] and "show it again" in said[1]


def test_fresh_data_are_more_and_other_ones():
    settings = traced("room").settings
    other = fresh(settings)
    assert other.spp == TIMES * settings.spp and other.seed != settings.seed


@pytest.mark.slow
@pytest.mark.statistical
def test_the_command_tries_it_before_it_says_so():
    words = ("--size", 16, 16, "--spp", 8, "--bug", "D17", "--seed", suite_seed(), "--json")
    done = castray("doctor", "cornell", "--integrator", "direct", "--light-sampling", "area", *words)
    found = json.loads(done.stdout)["findings"]
    assert done.returncode == 1 and [(f["bug"], f["confirmed"]) for f in found if not f["follows"]] == [
        ("D17", True)
    ]

"""A learner's own cast_ray in Python: judged as any trace, named by what it does wrong, and never trusted."""

import json
from pathlib import Path

import numpy as np
import pytest
from suite import castray

import tracer
from tracer.learner import child, starter
from tracer.learner.calls import Looped
from tracer.learner.value import Vector, dot, known, named
from viewer.checking.learner import judged as held
from viewer.checking.learner import settings_of
from viewer.options import PathOptions

TEXT = Path(starter.__file__).read_text(encoding="utf-8")

LOOP = """
from tracer.learner import Ray, dot

def follow(scene, ray):
    total, beta = 0.0, 1.0
    while hit := scene.intersect(ray):
        light = scene.sample_light()
        scene.intersect(Ray(hit.p, light.p - hit.p))
        if scene.random() > 0.8:
            break
        wi = hit.material.sample(-ray.direction, hit.n)
        beta = beta * hit.material.eval(wi, -ray.direction, hit.n) * dot(hit.n, wi)
        ray = Ray(hit.p OFFSET, wi)
        total = total + beta * light.emission
    return total

def cast_ray(scene, ray, depth):
    return follow(scene, ray)
"""

# What is changed in the starter, and the mistake that it makes of it.
MISTAKES = {
    "E01": ("return hit.emission if depth == 0 else 0.0", "return hit.emission"),
    "E02": ("return hit.emission if depth == 0 else 0.0", "return 0.0"),
    "D01": ("0.999 * length(towards)", "length(towards)"),
    "D10": ("* f * cos * cos_light", "* f * cos_light"),
    "D20": ("wi = normalize(towards)", "wi = towards"),
    "D11": ("/ dot(towards, towards) /", "/ length(towards) /"),
    "R01": ("/ pdf / SURVIVAL", "/ pdf"),
    "R03": ("scene.random() < SURVIVAL", "scene.random() > SURVIVAL"),
    "B02": ("* dot(n, wi) / pdf / SURVIVAL", "* dot(n, wi) / SURVIVAL"),
}


def judged(path, **more):
    settings = settings_of(None).as_dict() | {"width": 8, "height": 8, "spp": 4} | more
    request = {"file": str(path), "scene": "cornell", "settings": settings}
    return held(*child.run(request))


def written(tmp_path, text):
    path = tmp_path / "my_tracer.py"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_starter_breaks_no_law(tmp_path):
    assert judged(written(tmp_path, TEXT)).findings == ()


@pytest.mark.slow
@pytest.mark.parametrize("bug", MISTAKES)
def test_a_mistake_in_plain_code_is_named_first(tmp_path, bug):
    right, wrong = MISTAKES[bug]
    assert TEXT.count(right) == 1
    found = judged(written(tmp_path, TEXT.replace(right, wrong)), width=10, height=10, spp=6)
    assert found.findings[0].bug == bug


@pytest.mark.slow
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("indirect = cast_ray(", "indirect = 2.0 * cast_ray("),
        ("cast_ray(scene, Ray(hit.p, wi), depth + 1)", "cast_ray(scene, Ray(light.p, wi), depth + 1)"),
        ("direct = light.emission * f", "direct = 3.0 * light.emission * f"),
    ],
)
def test_what_is_in_no_catalogue_is_found_all_the_same(tmp_path, right, wrong):
    assert TEXT.count(right) == 1
    assert judged(written(tmp_path, TEXT.replace(right, wrong))).findings


@pytest.mark.slow
@pytest.mark.parametrize(("mean", "rule"), [("direct / 2", None), ("direct", "light-term")])
def test_several_light_samples_are_one_if_their_mean_counts(tmp_path, mean, rule):
    begin, end = TEXT.index("    light = scene.sample_light()"), TEXT.index("    # Indirect light")
    once = TEXT[begin:end].replace("direct = ", "direct += ").replace("\n    ", "\n        ")
    text = f"{TEXT[:begin]}    for _ in range(2):\n    {once}\n    direct = {mean}\n\n{TEXT[end:]}"
    found = judged(written(tmp_path, text)).findings
    assert [f.rule for f in found][:1] == ([rule] if rule else [])


@pytest.mark.parametrize("offset", ["", "+ hit.n * 1e-4"])
def test_paths_within_one_call_are_told_and_not_judged(tmp_path, offset):
    with pytest.raises(Looped, match="be called for each bounce"):
        judged(written(tmp_path, LOOP.replace("OFFSET", offset)), width=4, height=4, spp=2)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("goes_on", "bug", "why"),
    [
        ("depth < 2", "R05", "end at depth 2: a cut"),
        ("False", None, "no path goes on after its first surface"),
    ],
)
def test_a_tracer_without_roulette_is_judged(tmp_path, goes_on, bug, why):
    text = TEXT.replace("scene.random() < SURVIVAL", goes_on).replace(" / SURVIVAL", "")
    first = judged(written(tmp_path, text)).findings[0]
    assert (first.rule, first.bug) == ("absorbed", bug)
    assert why in first.explanation


def test_a_ray_made_anew_is_the_calls_own(tmp_path):
    anew = "scene.intersect(Ray(ray.origin, normalize(ray.direction)))"
    text = TEXT.replace("scene.intersect(ray)", anew)
    assert anew in text
    assert judged(written(tmp_path, text), width=4, height=4, spp=2).findings == ()


def test_rays_that_go_on_through_what_blocks_them_are_no_path(tmp_path):
    further = "blocker = scene.intersect(Ray(hit.p, wi))\n    "
    text = TEXT.replace(further, f"{further}blocker and scene.intersect(Ray(blocker.p, wi))\n    ")
    assert text != TEXT
    never = text.replace("if scene.random() < SURVIVAL", "if False")  # so that it is no recursion
    judged(written(tmp_path, never), width=4, height=4, spp=2)


@pytest.mark.slow
@pytest.mark.slow
@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("cos * cos_light / dot(towards, towards)", "min(cos * cos_light / dot(towards, towards), 4e-6)",
         "as if cos cos_light / r^2 were never more than 4e-06"),
        ("/ dot(towards, towards)", "/ max(dot(towards, towards), 160000)",
         "as if r^2 were never less than 1.6e+05"),
    ],
)  # fmt: skip
def test_a_number_held_between_bounds_is_told_with_the_bound(tmp_path, right, wrong, said):
    assert TEXT.count(right) == 1
    found = judged(written(tmp_path, TEXT.replace(right, wrong)), width=16, height=16, spp=8)
    assert [(f.rule, f.explanation) for f in found.causes][:1] == [("light-term", said)]


@pytest.mark.slow
@pytest.mark.parametrize("missed", ["1.0", "scene.sample_light().emission * float('nan')"])
def test_what_a_ray_brings_that_meets_nothing_is_the_cause_of_what_comes_of_it(tmp_path, missed):
    """A record that keeps the last hit is not seen where that hit is used, only by what then comes back."""
    text = TEXT.replace(
        "    if hit is None:\n        return 0.0", f"    if hit is None:\n        return {missed}"
    )
    found = judged(written(tmp_path, text))
    assert [f.rule for f in found.causes] == ["environment-term"]
    assert found.findings[0].explanation.startswith("nothing is met there")


def test_a_density_asked_before_the_bounce_is_told_as_the_light_samples(tmp_path):
    sample, density = "wi = material.sample(wo, n)", "pdf = material.pdf(wi, wo, n)"
    early = TEXT.replace(f"{sample}\n        {density}", f"{density}\n        {sample}")
    assert early != TEXT
    first, *others = judged(written(tmp_path, early)).findings
    assert first.rule == "bounce-pdf"
    assert "the density of the light sample's direction" in first.explanation
    assert not any("= 1 x" in found.explanation for found in others)  # which explains nothing


@pytest.mark.slow
@pytest.mark.statistical
def test_the_starter_draws_what_castray_draws():
    """Mean of the picture within 4 standard errors; one that is twice as bright is off by more than 40."""
    settings = settings_of(None).as_dict() | {"width": 16, "height": 16, "spp": 4}
    trace, _ = child.run({"file": starter.__file__, "scene": "cornell", "settings": settings})
    pixels = np.lexsort((trace.paths["x"], trace.paths["y"]))
    found = trace.paths["radiance"].mean(axis=0)[pixels].reshape(-1, 4)
    error = np.sqrt(found.var(axis=1, ddof=1).sum() / 4) / len(found)  # within pixels
    right = tracer.render(tracer.load("cornell"), tracer.Settings(width=16, height=16, spp=256, jitter=False))
    right = right.rgb.mean(dtype=np.float64)
    assert abs(found.mean() - right) < 4.0 * error
    assert abs(2.0 * found.mean() - right) > 40.0 * error


def test_values_remember_their_factors():
    f, pdf = named("f", np.array([0.2, 0.4, 0.6])), named("pdf", 0.5)
    n, wi = Vector(0, 0, 1), Vector(0, 0.6, 0.8)
    found = 2.0 * f * max(dot(n, wi), 0.0) / pdf + 0.0
    ((factor, powers),) = found.terms
    assert factor == 2.0 and {(leaf.kind, power) for leaf, power in powers} == {
        ("f", 1),
        ("dot", 1),
        ("pdf", -1),
    }
    assert np.allclose(found.value, 2.0 * np.array([0.2, 0.4, 0.6]) * 0.8 / 0.5)
    assert (f / f).terms[0][1] == ()  # what cancels is gone
    assert len((f + f * pdf).terms) == 2
    assert known(0.0).terms == ()


def test_a_random_number_remembers_with_what_it_was_compared():
    u = named("random", 0.3)
    assert u < 0.8
    assert u.terms[0][1][0][0].of == {"against": 0.8, "outcome": True}


def test_what_is_made_from_a_random_number_is_no_roulette():
    u = named("random", 0.25)
    assert max(0.0, 1.0 - u).value == 0.75 and 2.0 * u < 1.0
    ((leaf, _),) = u.terms[0][1]
    assert "against" not in leaf.of
    assert u < 0.8 and leaf.of["against"] == 0.8


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "def cast_ray(scene, ray, depth):\n    return 1 / 0\n",
            "my_tracer.py:2: in cast_ray: ZeroDivisionError",
        ),
        ("def cast_ray(scene ray):\n    pass\n", "my_tracer.py:1: invalid syntax"),
        ("def cast_ray(scene, ray, depth):\n    return cast_ray(scene, ray, depth)\n", "roulette"),
        ("def cast_ray(scene, ray, depth):\n    scene.intersect(ray)\n", "returned None"),
        ("def castray(scene, ray, depth):\n    return 0\n", "no function cast_ray"),
        ("import os\nos._exit(3)\n", "code 3"),
        ("import sys\nsys.exit('enough')\n", "SystemExit: enough"),
        ("def cast_ray(scene, ray, depth):\n    return (1, 2)\n", "colour of three"),
        ("import no_such_thing\n", "no_such_thing"),
    ],
    ids=str,
)
@pytest.mark.slow
def test_what_goes_wrong_in_the_file_is_one_line_with_its_place(tmp_path, text, said):
    ran = castray("check", written(tmp_path, text), "--size", 4, 4, "--spp", 1, cwd=tmp_path)
    assert ran.returncode == 2 and ran.stdout == ""
    assert len(ran.stderr.splitlines()) == 1 and said in ran.stderr


@pytest.mark.slow
def test_a_loop_without_end_is_stopped(tmp_path):
    ran = castray("check", written(tmp_path, "while True:\n    pass\n"), "--seconds", 2, cwd=tmp_path)
    assert ran.returncode == 2 and "not done after 2 s" in ran.stderr


@pytest.mark.slow
def test_memory_without_end_is_stopped(tmp_path):
    text = (
        "def cast_ray(scene, ray, depth):\n    x = []\n    while True:\n        x += [bytearray(1 << 26)]\n"
    )
    ran = castray("check", written(tmp_path, text), "--size", 4, 4, "--spp", 1, cwd=tmp_path)
    assert ran.returncode == 2 and "MemoryError" in ran.stderr


@pytest.mark.slow
def test_the_command_writes_a_starter_and_judges_it(tmp_path):
    small = ("--size", 6, 6, "--spp", 2, "--json")
    assert castray("check", "--new", "tracer.py", cwd=tmp_path).returncode == 0
    ran = castray("check", "tracer.py", *small, cwd=tmp_path)  # whatever it is called
    assert ran.returncode == 0 and json.loads(ran.stdout)["findings"] == []
    again = castray("check", "--new", "tracer.py", cwd=tmp_path)
    assert again.returncode == 2 and "already" in again.stderr


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["sky", "many_lights", "coloured_glass", "textures"])
def test_a_scene_that_it_cannot_be_given_is_refused_in_one_line(tmp_path, scene):
    ran = castray("check", written(tmp_path, TEXT), "--scene", scene, "--size", 4, 4, cwd=tmp_path)
    assert ran.returncode == 2 and scene in ran.stderr and len(ran.stderr.splitlines()) == 1


def test_each_law_is_held_once(tmp_path, monkeypatch):
    asked, examine = [], tracer.examine

    def counted(trace, only=None):
        diagnosis = examine(trace, only)
        asked.extend(v.rule.id for v in diagnosis.rules if v.state != "not_testable")
        return diagnosis

    monkeypatch.setattr(tracer, "examine", counted)
    judged(written(tmp_path, TEXT), width=4, height=4, spp=2)
    assert asked and len(asked) == len(set(asked))


def test_samples_that_were_said_are_taken_though_they_are_a_default_elsewhere():
    plain, said = (settings_of(options).spp for options in (PathOptions(size=(9, 9)), PathOptions(spp=16)))
    assert (plain, said) == (settings_of(None).spp, 16)


def test_numpys_functions_keep_what_vectors_and_values_remember():
    n, wi = Vector(0, 0, 1), Vector(0.6, 0, 0.8)
    for product in (np.dot(n, wi), np.inner(wi, n), np.dot(np.array([0, 0, 1]), wi)):
        assert float(product) == 0.8 and product.terms[0][1][0][0].kind == "dot"
    assert np.linalg.norm(wi).terms[0][1][0][0].kind == "length"
    assert tuple(np.cross(n, wi)) == (0, 0.6, 0)
    f = named("f", np.array([0.1, 0.2, 0.3]))
    total = np.zeros(3)
    total += np.float64(2.0) * f
    assert total.terms == ((2.0, f.terms[0][1]),)  # as without NumPy
    assert np.sqrt(np.dot(wi, wi)) == pytest.approx(1.0) and np.maximum(f, 0.2).tolist() == [0.2, 0.2, 0.3]
    assert (wi[0], n[2], len(wi), float(f[1])) == (0.6, 1.0, 3, 0.2)
    assert tuple(np.array([1, 2, 3]) - Vector(1, 1, 1)) == (0, 1, 2)


NUMPY = {  # the starter's own lines as somebody writes them who thinks in arrays
    "wo, n, material = -ray.direction": "wo, n, material = -np.array(ray.direction)",
    "wi = normalize(towards)": "wi = towards / np.sqrt(np.dot(towards, towards))",
    "cos, cos_light = max(dot(n, wi), 0.0), max(dot(light.n, -wi), 0.0)": (
        "cos, cos_light = max(0, np.dot(n, wi)), max(0, -np.dot(light.n, wi))"
    ),
    "length(towards)": "np.linalg.norm(np.array(light.p) - np.array(hit.p))",
    "    direct = 0.0": "    direct = np.zeros(3)",
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cosine", "rules"), [("-np.dot(light.n, wi)", []), ("np.dot(n, wi)", ["light-term"])]
)
def test_a_tracer_in_numpy_is_judged_as_any_other(tmp_path, cosine, rules):
    text = TEXT.replace("from tracer", "import numpy as np\nfrom tracer")
    for right, other in NUMPY.items():
        assert text.count(right) == 1
        text = text.replace(right, other)
    found = judged(written(tmp_path, text.replace("-np.dot(light.n, wi)", cosine)))
    assert [finding.rule for finding in found.causes] == rules

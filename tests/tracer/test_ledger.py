"""The ledger: a pixel is the mean of its samples, a sample the sum of its contributions, bit for bit.

The adding up is done here once more, from nothing but the JSON that `inspect` gives.
"""

import json

import numpy as np
import pytest
from cases import INTEGRATORS, SCENES, loaded, slow_but
from suite import castray

import tracer
from lessons import zoo
from tracer import Settings
from tracer.integrator.steps import light_term

SIDE = 18  # pixels; a square picture of these has more than 200
PIXELS = 200


def sample_from(entry, dtype):
    """A sample's radiance from its JSON: contributions added in order, in the precision given."""
    total = np.zeros(3, dtype)
    for event in entry["events"]:
        if "contribution" in event:
            total = total + np.array(
                [np.nan if v is None else float(v) for v in event["contribution"]], np.float64
            ).astype(dtype)
    return np.zeros(3, dtype) if entry["end"] == "invalid" else total


def pixel_from(document, dtype):
    """The pixel from its JSON: blocks of 16 samples added in order in float64, their mean rounded once."""
    samples, total = document["samples"], np.zeros(3)
    for start in range(0, len(samples), 16):
        block = np.zeros(3)
        for entry in samples[start : start + 16]:
            radiance = sample_from(entry, dtype)
            said = np.array([float(v) for v in entry["radiance"]]).astype(dtype)
            assert radiance.tobytes() == said.tobytes(), f"sample {entry['sample']}: {radiance} is not {said}"
            block = block + radiance.astype(np.float64)
        total = total + block
    return (total / len(samples)).astype(np.float32)


def adds_up(scene, settings, pixels, steps=zoo.RIGHT):
    """Compare the test's own sums with the render's pixels."""
    picture = tracer.render(scene, settings, steps=steps)
    for x, y in pixels:
        record = tracer.inspect(scene, settings, x, y, steps=steps)
        document = json.loads(json.dumps(record.as_dict(scene.at(settings)), allow_nan=False))
        value = pixel_from(document, settings.dtype)
        rendered = picture.rgb[y, x]
        assert value.tobytes() == rendered.tobytes(), f"pixel {x} {y}: {value} is not {rendered}"
        assert np.array(document["value"], np.float32).tobytes() == rendered.tobytes()
    return picture


def some_pixels(count, seed):
    """Different random pixels of the picture."""
    numbers = np.random.default_rng(seed).permutation(SIDE * SIDE)[:count]
    return [(int(n % SIDE), int(n // SIDE)) for n in numbers]


def square(spp, **options):
    return Settings(width=SIDE, height=SIDE, spp=spp, **options)


@pytest.mark.slow
@pytest.mark.parametrize("spp", [5, 16, 40])
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", SCENES)
def test_many_pixels_are_the_sums_of_their_events(suite_seed, scene, integrator, spp):
    """200 of them by the default integrator with one whole block of samples; fewer elsewhere."""
    depth = 3 if scene == "furnace" else 4  # the furnace's paths all live to the end
    settings = square(spp, integrator=integrator, seed=suite_seed, max_depth=depth)
    pixels = PIXELS if (spp, integrator) == (16, "path") else 10
    adds_up(loaded(scene), settings, some_pixels(pixels, suite_seed))


@pytest.mark.parametrize("precision", slow_but((32, 64), 32))
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", slow_but((*SCENES, "coloured_glass"), "coloured_glass"))
def test_a_pixel_is_the_sum_of_its_events(suite_seed, scene, integrator, precision):
    settings = square(18, integrator=integrator, seed=suite_seed, precision=precision)
    adds_up(loaded(scene), settings, some_pixels(3, suite_seed))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "integrator"), [*zip(SCENES, ("path", "direct", "path", "walk"), strict=True)]
)
def test_the_commands_tell_the_same(suite_seed, tmp_path, scene, integrator):
    """`castray inspect --json` adds up to the file that `castray render` wrote."""
    options = ["--size", "10", "10", "--spp", "18", "--seed", suite_seed, "--integrator", integrator]
    done = castray("render", scene, *options, "-o", "out.npy", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rgb = np.load(tmp_path / "out.npy")
    for x, y in ((0, 0), (4, 5), (9, 7)):
        done = castray("inspect", scene, *options, "--pixel", x, y, "--json", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert pixel_from(json.loads(done.stdout), np.float32).tobytes() == rgb[y, x].tobytes()


def sometimes_nan(beta, f, cos, light, w):
    """A light term that is not a number for a part of the lamp."""
    return np.where(light.q[0] > 0.1, np.nan, light_term(beta, f, cos, light, w)).astype(beta.dtype)


def test_a_sample_that_is_not_finite_counts_as_nothing_and_is_reported(suite_seed):
    settings = square(5, integrator="direct", seed=suite_seed, max_depth=4)
    scene, steps = loaded("cornell_unit"), zoo.changed(light_term=sometimes_nan)
    pixels = some_pixels(8, suite_seed)
    picture = adds_up(scene, settings, pixels, steps)
    ends = [p.end for x, y in pixels for p in tracer.inspect(scene, settings, x, y, steps=steps).paths]
    assert 0 < ends.count("invalid") < len(ends)
    assert picture.dropped > 0
    assert np.isfinite(picture.rgb).all()


def test_one_wrong_bit_in_a_contribution_is_seen(suite_seed):
    """The broken twin: the last bit of one number of one event."""
    settings = square(5, integrator="path", seed=suite_seed, max_depth=2)
    scene = loaded("cornell_unit")
    document = tracer.inspect(scene, settings, 9, 9).as_dict(scene.at(settings))
    right = pixel_from(document, np.float32)
    assert right.tobytes() == tracer.render(scene, settings).rgb[9, 9].tobytes()
    given = [
        [e for e in entry["events"] if e.get("contribution", [0.0])[0] > 0.0] for entry in document["samples"]
    ]
    # The only one of its sample: beside larger ones a bit may be lost when the sample is added up.
    (changed,) = next(events for events in given if len(events) == 1)
    up = np.nextafter(np.float32(changed["contribution"][0]), np.float32(np.inf))
    changed["contribution"][0] = float(str(up))
    with pytest.raises(AssertionError, match="is not"):
        pixel_from(document, np.float32)

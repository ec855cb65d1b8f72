"""Options out of their range are refused at the door, in one line that says what, where and what would do."""

import numpy as np
import pytest
from cases import loaded

import tracer
from tracer import Settings, TracerError

BAD = [
    ({"width": 0}, "width", "0"),
    ({"height": -3}, "height", "-3"),
    ({"width": 65536}, "width", "65535"),
    ({"width": 2.0}, "width", "2.0"),
    ({"spp": 0}, "spp", "0"),
    ({"spp": 1.5}, "spp", "1.5"),
    ({"spp": True}, "spp", "True"),
    ({"spp": "many"}, "spp", "many"),
    ({"spp": None}, "spp", "None"),
    ({"seed": -1}, "seed", "-1"),
    ({"seed": 2**32}, "seed", str(2**32 - 1)),
    ({"max_depth": -2}, "max_depth", "-2"),
    ({"integrator": "photon"}, "integrator", "walk"),
    ({"strategy": "both"}, "strategy", "mis"),
    ({"strategy": "light", "integrator": "walk"}, "strategy", "walk"),
    ({"heuristic": "cutoff"}, "heuristic", "balance"),
    ({"hemisphere": "cube"}, "hemisphere", "uniform"),
    ({"roulette": "2"}, "roulette", "auto"),
    ({"roulette": "0"}, "roulette", "off"),
    ({"roulette": "nan"}, "roulette", "auto"),
    ({"roulette": "off"}, "roulette", "max_depth"),
    ({"roulette": "1"}, "roulette", "max_depth"),
    ({"light_sampling": "volume"}, "light_sampling", "area"),
    ({"sampler": "sobel"}, "sampler", "independent"),
    ({"precision": 16}, "precision", "64"),
    ({"accel": "octree"}, "accel", "embree"),
    ({"accel": "embree", "precision": 64}, "accel", "bvh"),
    ({"jitter": "no"}, "jitter", "no"),
]


@pytest.mark.parametrize(
    ("options", "name", "said"), BAD, ids=lambda v: str(v) if isinstance(v, dict) else ""
)
def test_a_bad_value_is_refused_by_name(options, name, said):
    with pytest.raises(TracerError) as refused:
        Settings(**options)
    message = str(refused.value)
    assert message.startswith(f"{name}:") and said in message and "\n" not in message


def test_an_option_that_does_not_exist_is_refused():
    with pytest.raises(TypeError, match="bounces"):
        Settings(bounces=3)


@pytest.mark.parametrize(
    "options",
    [
        {"width": 1, "height": 65535},
        {"spp": 1, "seed": 2**32 - 1},
        {"max_depth": 0},
        {"max_depth": -1},
        {"roulette": "off", "max_depth": 3},
        {"roulette": "1", "max_depth": 3},
        {"roulette": 0.5},
        {"spp": np.int64(4)},
    ],
    ids=str,
)
def test_the_edges_of_each_range_are_let_through(options):
    Settings(**options)


def test_settings_survive_as_plain_values():
    settings = Settings(width=3, roulette="0.7", precision=64, max_depth=5)
    assert Settings(**settings.as_dict()) == settings


def test_the_size_comes_from_the_scene_where_none_is_asked_for():
    settings = Settings(height=20).at_size_of(loaded("furnace"))
    assert (settings.width, settings.height) == (64, 20)


@pytest.mark.parametrize("pixel", [(8, 0), (0, 6), (-1, 0)])
def test_a_pixel_outside_the_picture_is_refused(pixel):
    with pytest.raises(TracerError, match="from 0 to 7.*from 0 to 5"):
        tracer.inspect(loaded("furnace"), Settings(width=8, height=6, spp=1), *pixel)


@pytest.mark.parametrize("sample", [-1, 3])
def test_a_sample_that_is_not_there_is_refused(sample):
    with pytest.raises(TracerError, match="from 0 to 2"):
        tracer.inspect(loaded("furnace"), Settings(width=8, height=6, spp=3), 0, 0, sample=sample)


def test_paths_of_depth_nought_carry_nothing():
    picture = tracer.render(loaded("furnace"), Settings(width=4, height=4, spp=2, max_depth=0))
    assert not picture.rgb.any() and (picture.samples == 2).all()


def test_max_depth_counts_as_it_says():
    """1 shows the lamp alone, 2 adds direct light, and each further step only adds."""
    shown = [
        tracer.render(loaded("cornell_unit"), Settings(width=24, height=24, spp=8, max_depth=k)).rgb.mean()
        for k in (0, 1, 2, 3, 6)
    ]
    assert shown[0] == 0.0 and (np.diff(shown) > 0).all()


def test_progress_counts_all_paths_and_a_picture_says_what_it_cost():
    seen = []
    settings = Settings(width=16, height=16, spp=40, max_depth=3)
    picture = tracer.render(
        loaded("furnace"), settings, progress=lambda done, total: seen.append((done, total))
    )
    assert seen[-1] == (16 * 16 * 40, 16 * 16 * 40)
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)
    assert picture.complete and picture.dropped == 0 and picture.paths == 16 * 16 * 40
    assert picture.rays >= picture.paths


def test_a_render_that_is_stopped_is_a_whole_picture_with_fewer_samples():
    def stop(done, total):
        if done >= total // 2:
            raise KeyboardInterrupt

    settings = Settings(width=16, height=16, spp=48, max_depth=3)
    picture = tracer.render(loaded("furnace"), settings, progress=stop)
    assert not picture.complete
    assert (picture.samples == 32).all()
    fewer = tracer.render(loaded("furnace"), Settings(width=16, height=16, spp=32, max_depth=3))
    assert picture.rgb.tobytes() == fewer.rgb.tobytes()

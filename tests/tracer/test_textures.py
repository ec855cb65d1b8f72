"""Textures: what they say at a point, what they may stand for, and what is refused."""

import math

import checks
import numpy as np
import pytest
from cases import INTEGRATORS, loaded, slow_but
from PIL import Image

import tracer
from tracer import Settings, TracerError
from tracer.engine.needs import needs
from tracer.picture import from_srgb
from tracer.scene_file.materials import bsdf, textured
from tracer.scene_file.textures import Sources, texture

both = pytest.mark.parametrize("precision", [32, 64])
DTYPE = {32: np.float32, 64: np.float64}
TEXELS = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
CAMERA = {
    "type": "perspective",
    "fov": 40.0,
    "to_world": [{"look_at": {"origin": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0]}}],
    "film": {"width": 8, "height": 8},
}
CHECKER = {"type": "checkerboard", "color0": [0.9, 0.5, 0.2], "color1": [0.1, 0.2, 0.8]}

# Red of a grey picture of TEXELS at some coordinates, from Mitsuba 3.9.1 (scalar_rgb, raw).
PLACES = [(1 / 6, 0.25), (1 / 6, 0.75), (0.5, 0.25), (0.01, 0.01), (1.01, 0.25), (-0.2, 0.25), (1.3, 1.3)]
MITSUBA = {
    ("nearest", "repeat"): [0.1, 0.4, 0.2, 0.1, 0.1, 0.3, 0.1],
    ("nearest", "mirror"): [0.1, 0.4, 0.2, 0.1, 0.3, 0.1, 0.6],
    ("nearest", "clamp"): [0.1, 0.4, 0.2, 0.1, 0.3, 0.1, 0.6],
    ("bilinear", "repeat"): [0.1, 0.4, 0.2, 0.338, 0.194, 0.29, 0.17],
    ("bilinear", "mirror"): [0.1, 0.4, 0.2, 0.1, 0.3, 0.11, 0.53],
    ("bilinear", "clamp"): [0.1, 0.4, 0.2, 0.1, 0.3, 0.1, 0.6],
}
MOVES = [
    ([{"translate": [0.25, 0, 0]}], [0.2, 0.2, 0.5]),
    ([{"rotate": [0, 0, 1], "angle": 90}], [0.3, 0.3, 0.1]),
    ([{"translate": [0.25, 0, 0]}, {"rotate": [0, 0, 1], "angle": 30}], [0.1, 0.2, 0.6]),
]


@pytest.fixture
def folder(tmp_path):
    """A folder with a picture of TEXELS."""
    np.save(tmp_path / "grey.npy", TEXELS)
    return tmp_path


def read(folder, precision=64, **words):
    """A texture, ready for a precision."""
    description = {"type": "bitmap", "filename": "grey.npy"} | words
    return texture(description, "here", Sources(folder=folder)).astype(DTYPE[precision])


def at(made, places, precision=64):
    """Red at some coordinates."""
    found = made.at(np.array(places, DTYPE[precision]).T)
    assert found.dtype == DTYPE[precision] and found.shape == (3, len(places))
    return found[0]


@both
@pytest.mark.parametrize(("filter_type", "wrap_mode"), MITSUBA)
def test_a_lookup_is_mitsubas(folder, filter_type, wrap_mode, precision):
    made = read(folder, precision, filter_type=filter_type, wrap_mode=wrap_mode)
    assert np.abs(at(made, PLACES, precision) - MITSUBA[filter_type, wrap_mode]).max() < 1e-6


@pytest.mark.parametrize(("to_uv", "wanted"), MOVES)
def test_to_uv_moves_as_mitsuba_moves(folder, to_uv, wanted):
    made = read(folder, filter_type="nearest", to_uv=to_uv)
    assert np.allclose(at(made, [(0.1, 0.1), (0.4, 0.1), (0.1, 0.8)]), wanted)


def by_hand(texels, u, v, filter_type, wrap_mode):
    """One lookup, as slowly as it can be done."""
    height, width = texels.shape

    def texel(column, row):
        places = []
        for k, size in ((row, height), (column, width)):
            there = {
                "repeat": list(range(size)),
                "mirror": [*range(size), *reversed(range(size))],
                "clamp": [min(max(k, 0), size - 1)],
            }[wrap_mode]
            places.append(there[k % len(there)])
        return texels[places[0], places[1]]

    x, y = u * width, v * height
    if filter_type == "nearest":
        return texel(math.floor(x), math.floor(y))
    column, row = math.floor(x - 0.5), math.floor(y - 0.5)
    a, b = x - 0.5 - column, y - 0.5 - row
    weights = {(0, 0): (1 - a) * (1 - b), (1, 0): a * (1 - b), (0, 1): (1 - a) * b, (1, 1): a * b}
    return sum(w * texel(column + i, row + j) for (i, j), w in weights.items())


@both
@pytest.mark.parametrize(("filter_type", "wrap_mode"), MITSUBA)
def test_every_lookup_is_that_by_hand(tmp_path, suite_seed, filter_type, wrap_mode, precision):
    rng = np.random.default_rng(suite_seed)
    texels = rng.random((5, 7))
    np.save(tmp_path / "grey.npy", texels)
    made = read(tmp_path, precision, filter_type=filter_type, wrap_mode=wrap_mode)
    uv = rng.integers(-3000, 3000, (400, 2)) / 1024.0  # the same in both precisions
    wanted = [by_hand(texels, u, v, filter_type, wrap_mode) for u, v in uv]
    assert np.abs(at(made, uv, precision) - wanted).max() < {32: 4e-6, 64: 1e-13}[precision]


@both
@pytest.mark.parametrize("scale", [(1, 1), (8, 4), (2.5, -3)])
def test_a_checkerboard_is_that_by_hand(suite_seed, scale, precision):
    description = {**CHECKER, "to_uv": [{"scale": [*scale, 1]}]}
    made = texture(description, "here", Sources()).astype(DTYPE[precision])
    uv = np.random.default_rng(suite_seed).integers(-3000, 3000, (400, 2)) / 1024.0
    for (u, v), found in zip(uv, at(made, uv, precision), strict=True):
        both_or_neither = (u * scale[0] % 1.0 > 0.5) == (v * scale[1] % 1.0 > 0.5)
        assert found == DTYPE[precision](0.9 if both_or_neither else 0.1)
    assert np.allclose(made.mean(), [0.5, 0.35, 0.5])


def test_codes_in_srgb_are_made_linear_unless_they_are_raw(tmp_path):
    codes = np.arange(0, 252, 7, dtype=np.uint8).reshape(4, 3, 3)
    Image.fromarray(codes).save(tmp_path / "a.png")
    linear, raw = read(tmp_path, filename="a.png"), read(tmp_path, filename="a.png", raw=True)
    assert np.array_equal(raw.texels, codes.transpose(2, 0, 1) / 255.0)
    assert np.array_equal(linear.texels, from_srgb(raw.texels))
    assert np.allclose(linear.mean(), linear.texels.mean(axis=(1, 2)))


def test_coordinates_beyond_all_digits_still_find_a_texel(folder):
    for words in ({}, {"wrap_mode": "mirror"}, {"wrap_mode": "clamp"}, {"filter_type": "nearest"}):
        made = read(folder, 32, **words, to_uv=[{"scale": [1e6, 1e6, 1]}])
        found = at(made, [(1e24, -1e24), (-3.3e20, 1e-30), (0, -0.0)], 32)
        assert ((found >= 0.1) & (found <= 0.6)).all()


# Description of a bitmap or of a whole material, and what is said of it.
REFUSED = {
    "no file": ({"filename": "none.png"}, "filename: .*none.png: there is no such file"),
    "no picture": ({"filename": "text.png"}, "filename: .*text.png: is not a picture"),
    "cut off": ({"filename": "cut.exr"}, "filename: .*cut.exr"),
    "no name": ({"filename": 7}, "filename: 7 is not the name of a file"),
    "too bright": (
        {"filename": "bright.npy"},
        "bright.npy has 0.2, 1.5, 0.2 in row 1, column 2; .* from 0 to 1",
    ),
    "negative": ({"filename": "dark.npy"}, "dark.npy has 0.2, -0.1, 0.2 in row"),
    "not a number": ({"filename": "nan.npy"}, "nan.npy has 0.2, nan, 0.2 in row"),
    "filter": ({"filter_type": "bilinaer"}, "filter_type: 'bilinaer' is not known; did you mean 'bilinear'"),
    "wrap": ({"wrap_mode": "wrap"}, "wrap_mode: 'wrap' is not known; .*known: repeat, mirror, clamp"),
    "raw": ({"raw": "yes"}, "raw: 'yes' is neither true nor false"),
    "far": ({"to_uv": [{"scale": 1e7}]}, "to_uv: moves coordinates by more than 1e"),
    "word": ({"colour": 1}, "colour: unknown word"),
    "colour": ({**CHECKER, "color0": 1.5}, r"color0\[0\]: 1.5 is out of range"),
    "kind": (
        {"type": "marble"},
        "reflectance.type: 'marble' is not supported; known: rgb, bitmap, checkerboard",
    ),
    "reference": ({"type": "ref", "id": "wood"}, "no texture 'wood' in this scene; there are none"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_texture_is_refused_in_one_line(folder, name):
    values = np.full((3, 4, 3), 0.2)
    for file, wrong in (("bright", 1.5), ("dark", -0.1), ("nan", np.nan)):
        values[1, 2, 1] = wrong
        np.save(folder / f"{file}.npy", values)
    (folder / "text.png").write_text("no picture", encoding="utf-8")
    tracer.write(values.astype(np.float32), folder / "cut.exr")
    (folder / "cut.exr").write_bytes((folder / "cut.exr").read_bytes()[:-9])
    words, said = REFUSED[name]
    described = words if "type" in words else {"type": "bitmap", "filename": "grey.npy"} | words
    material = {"type": "diffuse", "reflectance": described}
    with pytest.raises(TracerError, match=said) as refused:
        tracer.load_dict({"eye": CAMERA, "thing": {"type": "sphere", "bsdf": material}}, folder=folder)
    assert str(refused.value).startswith("thing.bsdf.reflectance") and "\n" not in str(refused.value)


@pytest.mark.parametrize("words", [{"eta": CHECKER, "k": 1.0}, {"alpha": CHECKER}, {"k": CHECKER}])
def test_a_texture_cannot_stand_for_what_is_no_share_of_light(words):
    with pytest.raises(TracerError, match="here.(eta|k|alpha)"):
        bsdf({"type": "roughconductor", **words}, "here")


PAINTABLE = [
    ("diffuse", "reflectance"),
    ("plastic", "diffuse_reflectance"),
    ("plastic", "specular_reflectance"),
    ("roughplastic", "diffuse_reflectance"),
    ("roughplastic", "specular_reflectance"),
    ("conductor", "specular_reflectance"),
    ("roughconductor", "specular_reflectance"),
    ("dielectric", "specular_reflectance"),
    ("dielectric", "specular_transmittance"),
    ("thindielectric", "specular_reflectance"),
    ("thindielectric", "specular_transmittance"),
    ("roughdielectric", "specular_reflectance"),
    ("roughdielectric", "specular_transmittance"),
]
ROOM = {
    "eye": CAMERA,
    "sky": {"type": "constant", "radiance": [0.5, 0.6, 0.7]},
    "lamp": {
        "type": "rectangle",
        "to_world": [{"rotate": [1, 0, 0], "angle": 90}, {"translate": [0, 3, 0]}],
        "emitter": {"type": "area", "radiance": 5.0},
    },
    "other": {
        "type": "cube",
        "to_world": [{"scale": 0.3}, {"translate": [1, 1, 0]}],
        "bsdf": {"type": "diffuse", "reflectance": [0.7, 0.1, 0.2]},
    },
}


def seen_with(material, precision=32, **settings):
    """A picture of a ball of this material in the room."""
    scene = tracer.load_dict({**ROOM, "ball": {"type": "sphere", "bsdf": material}})
    wanted = Settings(spp=16, max_depth=5, precision=precision, **settings)
    return tracer.render(scene, wanted).rgb


@both
@pytest.mark.parametrize(("kind", "word"), slow_but(PAINTABLE, PAINTABLE[0], PAINTABLE[6]))
def test_a_texture_of_one_colour_is_that_colour_bit_for_bit(kind, word, precision):
    colour = [0.25, 0.5, 0.75]
    plain = seen_with({"type": kind, word: colour}, precision)
    board = {"type": "checkerboard", "color0": colour, "color1": colour}
    assert np.array_equal(seen_with({"type": kind, word: board}, precision), plain)
    two = seen_with({"type": kind, word: {**board, "color1": [0.5, 0.5, 0.5]}}, precision)
    assert not np.array_equal(two, plain)


def test_a_material_inside_another_and_two_textures_in_one(folder):
    colours = {"diffuse_reflectance": [0.25, 0.5, 0.75], "specular_reflectance": [0.5, 0.75, 0.25]}
    boards = {w: {"type": "checkerboard", "color0": c, "color1": c} for w, c in colours.items()}
    plain, painted = ({"type": "twosided", "bsdf": {"type": "plastic", **of}} for of in (colours, boards))
    assert np.array_equal(seen_with(plain), seen_with(painted))
    assert set(textured(painted, "here", Sources())[1]) == {f"bsdf.{word}" for word in colours}


def test_a_material_is_drawn_and_benched_with_the_mean_of_its_texture():
    scene = tracer.load_dict(
        {"eye": CAMERA, "ball": {"type": "sphere", "bsdf": {"type": "diffuse", "reflectance": CHECKER}}}
    )
    assert np.allclose(scene.display_colour(0), [0.5, 0.35, 0.5])
    assert np.allclose(
        bsdf({"type": "diffuse", "reflectance": CHECKER}, "x").reflectance[:, 0], [0.5, 0.35, 0.5]
    )


def test_textures_are_named_and_referred_to():
    room = {
        "eye": CAMERA,
        "board": CHECKER,
        "paint": {"type": "diffuse", "reflectance": {"type": "ref", "id": "board"}},
        "ball": {"type": "sphere", "bsdf": "paint"},
    }
    scene = tracer.load_dict(room)
    assert scene.bsdf.any_textured and np.allclose(scene.display_colour(0), [0.5, 0.35, 0.5])
    with pytest.raises(TracerError, match=r"spare.color0\[0\]: 2 is out of range"):
        tracer.load_dict({**room, "spare": {**CHECKER, "color0": 2.0}})
    with pytest.raises(TracerError, match="no material 'board'"):
        tracer.load_dict({**room, "ball": {"type": "sphere", "bsdf": "board"}})


def test_the_event_says_the_colour_that_the_texture_gave():
    scene, wanted = loaded("textures"), Settings(width=20, height=12, spp=4, max_depth=3)
    tiles = scene.bsdf_names.index("tiles")
    seen = set()
    for x in range(20):
        for path in tracer.inspect(scene, wanted, x, 11).paths:
            for hit, after in zip(path.events, path.events[1:], strict=False):
                if hit.kind.name == "hit" and hit.values["bsdf"] == tiles and after.kind.name == "light":
                    albedo = hit.values["albedo"]
                    assert np.allclose(after.values["f"] * np.pi, albedo * (after.values["f"] > 0), rtol=1e-6)
                    seen.add(tuple(np.round(albedo.astype(float), 3).tolist()))
    assert seen == {(0.72, 0.66, 0.56), (0.1, 0.12, 0.16)}


def test_d_and_g_of_an_event_are_of_the_frame_of_the_loop():
    """f = F D G2 / (4 cos_o cos_i) with the numbers of the event itself, on brushed metal."""
    scene, wanted = loaded("textures"), Settings(width=20, height=12, spp=4, max_depth=3, precision=64)
    metal = {scene.bsdf_names.index(name) for name in ("brushed", "brass")}
    found = 0
    for x in range(20):
        for path in tracer.inspect(scene, wanted, x, 8).paths:
            hit = None
            for event in path.events:
                v = event.values
                if event.kind.name == "hit":
                    hit = v
                elif event.kind.name in ("light", "bounce") and hit["bsdf"] in metal and v["f"].any():
                    f = v["F"] * v["D"] * v["G2"] / (4.0 * hit["cos_wo"] * v["cos"])
                    colour = (
                        np.array([1, 0.95, 0.8]) if hit["bsdf"] == scene.bsdf_names.index("brass") else 1.0
                    )
                    assert np.allclose(f, v["f"], rtol=1e-9) or np.allclose(f * colour, v["f"], rtol=1e-9)
                    found += 1
    assert found > 20


def test_explain_says_who_needs_coordinates():
    told = {need.name: need for need in needs(loaded("textures"), Settings())}
    assert told["textures"].why == "tiles, paper, ceramic"
    assert told["frames along the surface"].why == "brushed, brass"
    told = {need.name: need for need in needs(loaded("cornell_unit"), Settings())}
    assert not told["textures"].on and not told["frames along the surface"].on


def test_coordinates_are_worked_out_where_a_texture_is_met_and_nowhere_else(monkeypatch):
    plain = tracer.load("cornell_unit")
    tracer.render(plain, Settings(width=8, height=8, spp=1))
    assert "_charts" not in vars(plain)
    scene = loaded("textures").at(Settings())
    asked = []
    monkeypatch.setattr(
        scene, "uv", lambda p, k: asked.append(k) or type(scene).uv(scene, p, k), raising=False
    )
    checks.samples(scene, Settings(width=16, height=10, spp=2, max_depth=3))
    met = {scene.bsdf_names[k] for k in np.unique(scene.bsdf_of[np.concatenate(asked)])}
    assert met == {"tiles", "paper", "ceramic"}


@both
@pytest.mark.parametrize("integrator", slow_but(INTEGRATORS, "path"))
def test_a_path_among_textures_alone_is_the_path_in_the_wave(suite_seed, integrator, precision):
    wanted = Settings(width=16, height=10, spp=2, seed=suite_seed, integrator=integrator, precision=precision)
    whole = checks.samples(loaded("textures"), wanted)
    for pixel in np.random.default_rng(suite_seed).permutation(160)[:16]:
        alone = checks.samples(loaded("textures"), wanted, pixels=[pixel])
        assert alone.tobytes() == whole[:, [pixel]].tobytes()

"""Pictures to files and back, and files that are none."""

import numpy as np
import pytest
from cases import loaded
from PIL import Image

import tracer
from tracer import Settings, TracerError
from tracer.picture import from_srgb, to_srgb

SIZE = (5, 7, 3)


@pytest.fixture
def rgb(suite_seed):
    return np.random.default_rng(suite_seed).lognormal(-1.0, 1.0, SIZE).astype(np.float32)


def test_an_exr_keeps_everything(suite_seed, tmp_path):
    picture = tracer.render(loaded("cornell_unit"), Settings(width=9, height=6, spp=17, seed=suite_seed))
    tracer.write(picture, tmp_path / "a.exr", scene="cornell_unit")
    stored = tracer.read(tmp_path / "a.exr")
    for name in ("rgb", "variance", "samples"):
        assert np.array_equal(getattr(stored, name), getattr(picture, name)), name
    assert stored.notes == {"scene": "cornell_unit", "settings": picture.settings.as_dict()}
    tracer.write(stored, tmp_path / "b.exr", **stored.notes)
    again = tracer.read(tmp_path / "b.exr")
    assert again.notes == stored.notes and np.array_equal(again.variance, stored.variance)


def test_one_sample_and_what_is_not_finite_survive_an_exr(tmp_path):
    picture = tracer.render(loaded("cornell_unit"), Settings(width=4, height=4, spp=1))
    picture.rgb[0, 0] = np.nan, np.inf, -np.inf
    tracer.write(picture, tmp_path / "a.exr")
    stored = tracer.read(tmp_path / "a.exr")
    assert np.array_equal(stored.rgb, picture.rgb, equal_nan=True)
    assert np.isnan(stored.variance).all() and (stored.samples == 1).all()


@pytest.mark.parametrize("suffix", ["exr", "npy"])
def test_linear_numbers_come_back_bit_for_bit_without_variance(tmp_path, rgb, suffix):
    tracer.write(rgb, tmp_path / f"a.{suffix}")
    stored = tracer.read(tmp_path / f"a.{suffix}")
    assert np.array_equal(stored.rgb, rgb) and stored.variance is None and not stored.eight_bits


def test_a_foreign_variance_is_not_believed(tmp_path, rgb):
    """Other programs' channels of that name may be the samples', not the mean's."""
    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    channels = {"RGB": rgb, "variance": rgb, "samples": np.full(SIZE[:2], 16, np.uint32)}
    with OpenEXR.File(header, channels) as file:
        file.write(str(tmp_path / "a.exr"))
    stored = tracer.read(tmp_path / "a.exr")
    assert np.array_equal(stored.rgb, rgb) and stored.variance is None


@pytest.mark.parametrize("kind", ["half", "grey"])
def test_other_kinds_of_exr(tmp_path, rgb, kind):
    import OpenEXR

    values = {"half": {"RGB": rgb.astype(np.float16)}, "grey": {"Y": np.ascontiguousarray(rgb[..., 0])}}[kind]
    header = {"compression": OpenEXR.PIZ_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, values) as file:
        file.write(str(tmp_path / "a.exr"))
    stored = tracer.read(tmp_path / "a.exr").rgb
    expected = rgb.astype(np.float16) if kind == "half" else np.repeat(rgb[..., :1], 3, axis=2)
    assert np.array_equal(stored, expected.astype(np.float32))


@pytest.mark.parametrize("suffix", ["png", "ppm"])
def test_eight_bits_keep_their_codes(tmp_path, rgb, suffix):
    Image.fromarray(to_srgb(rgb)).save(tmp_path / f"a.{suffix}")
    stored = tracer.read(tmp_path / f"a.{suffix}")
    assert stored.eight_bits and np.array_equal(to_srgb(stored.rgb), to_srgb(rgb))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("channels", [1, 3])
def test_a_portable_float_map(tmp_path, rgb, order, channels):
    head = f"{'PF' if channels == 3 else 'Pf'}\n{SIZE[1]} {SIZE[0]}\n{-1.0 if order == '<' else 1.0}\n"
    data = rgb[::-1, :, :channels].astype(order + "f4").tobytes()
    (tmp_path / "a.pfm").write_bytes(head.encode("ascii") + data)
    expected = rgb if channels == 3 else np.repeat(rgb[..., :1], 3, axis=2)
    assert np.array_equal(tracer.read(tmp_path / "a.pfm").rgb, expected)


def bad_files(folder, rgb):
    """name -> bytes of files that hold no picture."""
    tracer.write(np.tile(rgb, (20, 20, 1)), folder / "whole.exr")
    np.save(folder / "whole.npy", rgb)
    np.save(folder / "words.npy", np.array(["a", "b"]))
    np.save(folder / "objects.npy", np.array([{}, None], object))
    np.save(folder / "flat.npy", np.zeros(7))
    np.save(folder / "none.npy", np.zeros((0, 4, 3)))
    exr, npy = (folder / "whole.exr").read_bytes(), (folder / "whole.npy").read_bytes()
    spoilt = bytearray(exr)
    spoilt[len(exr) // 2 : len(exr) // 2 + 40] = b"\xff" * 40
    return {
        "empty.exr": b"",
        "nonsense.exr": b"no picture at all",
        "cut.exr": exr[:-20],
        "spoilt.exr": bytes(spoilt),
        "head.exr": exr[:100],
        "empty.npy": b"",
        "cut.npy": npy[:-20],
        "empty.png": b"",
        "nonsense.png": b"\x89PNG\r\n\x1a\nand no more",
        "short.pfm": b"PF\n4 4\n-1.0\n" + bytes(20),
        "scale.pfm": b"PF\n1 1\n0\n" + bytes(12),
        "words.pfm": b"PF\nwide high\n-1\n" + bytes(12),
        "text.txt": b"hello",
        "empty.hdr": b"",
        "nonsense.hdr": b"#?RADIANCE",
        "short.hdr": b"#?RADIANCE\n\n-Y 4 +X 4\n" + bytes(20),
        "turned.hdr": b"#?RADIANCE\n\n+X 2 -Y 2\n" + bytes(16),
        "vast.hdr": b"#?RADIANCE\n\n-Y 99999999 +X 99999999\n" + bytes(16),
        "run.hdr": b"#?RADIANCE\n\n-Y 1 +X 9\n" + bytes((2, 2, 0, 9, 137)),
    }


def test_bad_files_are_refused_in_one_line_that_names_them(tmp_path, rgb, capfd):
    for name, content in bad_files(tmp_path, rgb).items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / "folder.exr").mkdir()
    for path in sorted(tmp_path.iterdir()):
        if path.stem != "whole":
            with pytest.raises(TracerError) as refused:
                tracer.read(path)
            assert str(path) in str(refused.value) and "\n" not in str(refused.value)
    with pytest.raises(TracerError, match="no such file"):
        tracer.read(tmp_path / "nowhere.exr")
    assert capfd.readouterr() == ("", "")


def hdr(rgbe, packed):
    """A Radiance picture of (H, W, 4) bytes; packed: each line's components in runs and in pieces."""
    height, width = rgbe.shape[:2]
    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode()
    if not packed:
        return head + rgbe.tobytes()
    lines = b""
    for line in rgbe:
        lines += bytes((2, 2, width >> 8, width & 255))
        for component in line.T:
            first, rest = int(component[0]), component[1:]
            lines += bytes((129, first, rest.size)) + rest.tobytes()
    return head + lines


@pytest.mark.parametrize("packed", [True, False])
def test_a_radiance_picture_means_mantissa_times_power_of_two(tmp_path, packed):
    rgbe = np.random.default_rng(3).integers(0, 256, (4, 9, 4)).astype(np.uint8)
    rgbe[0, 0] = 128, 64, 0, 129  # 128/256 * 2
    rgbe[1, 1, 3] = 0
    (tmp_path / "a.hdr").write_bytes(hdr(rgbe, packed))
    stored = tracer.read(tmp_path / "a.hdr", np.float64)
    assert stored.rgb.dtype == np.float64 and np.array_equal(stored.rgb[0, 0], [1.0, 0.5, 0.0])
    assert np.array_equal(stored.rgb[1, 1], np.zeros(3))
    assert np.array_equal(stored.rgb[2], rgbe[2, :, :3] * 2.0 ** (rgbe[2, :, 3:].astype(float) - 136.0))


def test_numbers_in_srgb_are_made_linear_unless_they_are_wanted_raw(tmp_path):
    codes = np.arange(0, 240, 5, dtype=np.uint8).reshape(4, 4, 3)
    Image.fromarray(codes).save(tmp_path / "a.png")
    raw = tracer.read(tmp_path / "a.png", np.float64, raw=True).rgb
    assert np.array_equal(raw, codes / 255.0)
    assert np.array_equal(tracer.read(tmp_path / "a.png", np.float64).rgb, from_srgb(raw))

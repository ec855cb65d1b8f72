"""Pictures that scenes are lit with: OpenEXR, Radiance, NumPy, and what Pillow reads."""

import numpy as np

from tracer.picture import from_srgb
from tracer.settings import TracerError


def read(path, place):
    """A linear picture (H, W, 3) in float64. Raises TracerError naming the place.

    OpenEXR, Radiance (.hdr) and .npy hold linear numbers; all else is taken for 8-bit sRGB.
    """
    if not path.is_file():
        raise TracerError(f"{place}: there is no file {path}")
    reader = {".exr": _exr, ".hdr": _radiance, ".npy": _npy}.get(path.suffix.lower(), _srgb)
    try:
        image = np.asarray(reader(path), np.float64)
    except Exception as error:  # each library raises its own
        raise TracerError(
            f"{place}: {path} cannot be read as a picture: {type(error).__name__}: {error}"
        ) from None
    if image.ndim == 2:
        image = np.repeat(image[:, :, None], 3, axis=2)
    if image.ndim != 3 or image.shape[2] < 3:
        raise TracerError(f"{place}: {path} is no colour picture")
    return np.ascontiguousarray(image[:, :, :3])


def _exr(path):
    import OpenEXR

    with OpenEXR.File(str(path)) as file:
        channels = file.channels()
        for name in ("RGB", "RGBA"):
            if name in channels:
                return np.array(channels[name].pixels)
        return np.stack([np.array(channels[name].pixels) for name in "RGB"], axis=2)


def _npy(path):
    return np.load(path, allow_pickle=False)


def _srgb(path):
    from PIL import Image

    with Image.open(path) as image:
        return from_srgb(np.asarray(image.convert("RGB"), np.float64) / 255.0)


def _radiance(path):
    """Radiance's RGBE, plain or with each scan line's four components in runs (Ward 1991)."""
    data = path.read_bytes()
    head, _, rest = data.partition(b"\n\n")
    if not head.startswith(b"#?"):
        raise ValueError("is no Radiance picture")
    size, _, pixels = rest.partition(b"\n")
    down, height, right, width = size.split()
    if (down, right) != (b"-Y", b"+X"):
        raise ValueError(f"rows run {size.decode('ascii', 'replace')}; only -Y +X is supported")
    height, width = int(height), int(width)
    runs = pixels[:4] == bytes((2, 2, width >> 8, width & 255))
    rgbe = _unpacked(pixels, height, width) if runs else np.frombuffer(pixels, np.uint8, 4 * height * width)
    rgbe = rgbe.reshape(height, width, 4).astype(np.float64)
    scale = np.where(rgbe[..., 3:] > 0.0, np.exp2(rgbe[..., 3:] - 136.0), 0.0)
    return rgbe[..., :3] * scale


def _unpacked(data, height, width):
    """Bytes (H, W, 4) of scan lines in runs."""
    lines, at = np.empty((height, 4, width), np.uint8), 0
    for line in lines:
        at += 4
        for component in line:
            filled = 0
            while filled < width:
                count, at = data[at], at + 1
                if count > 128:
                    count -= 128
                    component[filled : filled + count] = data[at]
                    at += 1
                else:
                    component[filled : filled + count] = np.frombuffer(data, np.uint8, count, at)
                    at += count
                filled += count
    return lines.transpose(0, 2, 1)

"""Radiance's pictures (.hdr): a common exponent for three colours, plain or in runs (Ward 1991)."""

import numpy as np


def decoded(data):
    """The linear picture (H, W, 3) in the bytes of a file; ValueError or IndexError where there is none."""
    head, _, rest = data.partition(b"\n\n")
    if not head.startswith(b"#?"):
        raise ValueError("is no Radiance picture")
    size, _, pixels = rest.partition(b"\n")
    down, height, right, width = size.split()
    if (down, right) != (b"-Y", b"+X"):
        raise ValueError("rows run otherwise than -Y +X")
    height, width = int(height), int(width)
    if not 0 < height * width <= 32 * len(pixels):  # two bytes of a run stand for 127 of four a pixel
        raise ValueError("holds less than its header says")
    runs = pixels[:4] == bytes((2, 2, width >> 8 & 255, width & 255))
    rgbe = _unpacked(pixels, height, width) if runs else np.frombuffer(pixels, np.uint8, 4 * height * width)
    rgbe = rgbe.reshape(height, width, 4).astype(np.float64)
    scale = np.where(rgbe[..., 3:] > 0.0, np.exp2(rgbe[..., 3:] - 136.0), 0.0)
    return rgbe[..., :3] * scale


def _unpacked(data, height, width):
    """Bytes (H, W, 4) of scan lines whose four components stand in runs."""
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

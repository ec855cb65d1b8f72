"""`castray doctor PICTURE`: what a picture alone says."""

from pathlib import Path

from lessons.zoo import ZOO
from lessons.zoo.pictures import album, mixtures, suited
from tracer.doctor.picture import judged, opened
from tracer.picture import check_path
from tracer.settings import TracerError
from viewer.options import DoctorOptions, scene_of
from viewer.progress import watched
from viewer.words import Speaker

KINDS = (".png", ".ppm", ".pgm", ".exr", ".npy", ".hdr", ".pfm", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff")


def is_picture(text):
    """Whether a command line argument names a picture."""
    return Path(text).suffix.lower() in KINDS


def opinion_of(path, scene, options=None, gamma=None, output=None):
    """The Opinion on a picture, its scene and the Album it was compared with. Raises TracerError."""
    if scene is None:
        raise TracerError(f"{path}: give --scene, the scene that this picture is of")
    spp = _spp(path, options)
    if output is not None:
        check_path(output)
    values, eight_bits, curves = opened(path, gamma)
    loaded = scene_of(scene, options)
    with watched(Speaker()("pic.rendering")) as progress:
        known = album(loaded, suited(loaded, ZOO.values()), progress)
    return judged(values, eight_bits, curves, loaded, known, mixtures(loaded, ZOO), spp), loaded, known


def _spp(path, options):
    """Samples per pixel that the command was told; None if it was not. Other path options decide nothing."""
    if options is None:
        return None
    usual = DoctorOptions()
    odd = [name for name, value in vars(options).items() if value != getattr(usual, name)]
    if set(odd) - {"spp", "set"}:
        name = min(set(odd) - {"spp", "set"}).replace("_", "-")
        raise TracerError(
            f"{path}: --{name} decides nothing in a picture that is there already; --spp and --set may"
        )
    return None if odd == ["set"] else options.spp

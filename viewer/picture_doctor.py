"""`castray doctor PICTURE`: what a picture alone says."""

from dataclasses import replace
from functools import cache

from lessons.zoo import ZOO
from lessons.zoo.pictures import album, mixtures, straight_and_all, suited
from tracer.doctor.picture import clues, features, judged, likelier_curve, opened
from tracer.picture import check_path
from tracer.settings import TracerError
from viewer.options import DoctorOptions, scene_of
from viewer.progress import watched
from viewer.words import Speaker


def opinion_of(path, scene, options=None, gamma=None, output=None):
    """The Opinion on a picture, its scene and the Album it was compared with. Raises TracerError."""
    if scene is None:
        raise TracerError(f"{path}: give --scene, the scene that this picture is of, as in --scene cornell")
    spp = _spp(path, options)
    if output is not None:
        check_path(output)
    given, loaded = opened(path, gamma), scene_of(scene, options)
    with watched(Speaker()("pic.rendering")) as progress:
        opinion, known = opinion_on(given, loaded, spp, progress)
    if gamma is not None and given[1]:
        opinion = replace(opinion, likelier=likelier_curve(given[0], opinion, known, spp))
    return opinion, loaded, known


@cache
def album_of(text):
    """A scene by its name or file, and the Album of it, made once: for many pictures of one scene."""
    scene = scene_of(text, None)
    return scene, album(scene, suited(scene, ZOO.values()))


def opinion_on(given, scene, spp=None, progress=None, known=None):
    """The Opinion on what `opened` gives of a picture of a scene, and the Album it was compared with; known:
    that Album, if it is made already."""
    if known is None:
        known = album(scene, suited(scene, ZOO.values()), progress)
    values, eight_bits, curves = given
    opinion = judged(values, eight_bits, curves, scene, known, mixtures(scene, ZOO, progress), spp)
    if not opinion.is_right and not opinion.hypotheses:
        reading, right = opinion.reading, known.rights[0]
        seen = features(reading.rgb, reading.eight_bits)
        found = clues(opinion, seen, right.near(max(right.at)), scene, *straight_and_all(scene))
        opinion = replace(opinion, clues=found)
    return opinion, known


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

"""From paths to pixels."""

import numpy as np

from lessons.zoo.bug import Bug
from tracer.integrator.steps import camera

THREADS = 11  # among which the rows of the picture are dealt
BANDS = 4  # threads that write to one picture


def clamped(radiance, wave, lane):
    """White dots are cut off, and their light with them."""
    return np.minimum(radiance, 1.0).astype(radiance.dtype)


def curved(radiance, wave, lane):
    """Each sample is bent for the screen before the mean is taken."""
    return (np.maximum(radiance, 0.0) ** (1.0 / 2.2)).astype(radiance.dtype)


def sum_of_samples(radiance, wave, lane):
    """The pixel is the sum of its samples."""
    return radiance * radiance.dtype.type(wave.settings.spp)


def rest_forgotten(radiance, wave, lane):
    """Every thread gets height / threads rows; the rest is nobody's."""
    height = wave.settings.height
    return np.where(wave.y[lane] < height - height % THREADS, radiance, 0.0).astype(radiance.dtype)


def centres(draw, pixel, sample, depth, use):
    """Every sample goes through its pixel's centre."""
    u = draw(pixel, sample, depth, use)
    return np.full_like(u, 0.5) if use == "film" else u


def aspect_of_whole_numbers(scene, settings, film, lens):
    """width / height is rounded down before it is used."""
    width, height = settings.width, settings.height
    aspect = max(width // height, 1)
    middle, tall = settings.dtype(0.5 * height), settings.dtype(width / (height * aspect))
    return camera(scene, settings, np.stack((film[0], middle + (film[1] - middle) * tall)), lens)


def one_counter(scene, settings, film, lens):
    """Each thread renders a band of rows, and all write to the next free row of the picture."""
    height = settings.height
    row = np.floor(film[1]).astype(int)
    meant = np.minimum((row % BANDS) * -(-height // BANDS) + row // BANDS, height - 1)
    return camera(scene, settings, np.stack((film[0], film[1] + (meant - row))).astype(film.dtype), lens)


BUGS = (
    Bug(
        "F01",
        "Each sample clamped",
        "No white dots, and everything is too dark where rare paths bring the light.",
        "L = min(L, 1) per sample",
        "I14: a pixel is the mean of its samples",
        {"film": clamped},
    ),
    Bug(
        "F03",
        "Gamma before averaging",
        "The picture looks washed out, and its noise biases it.",
        "pow(L, 1/2.2) per sample",
        "I14: a pixel is the mean of its samples",
        {"film": curved},
    ),
    Bug(
        "F04",
        "Not divided by the number of samples",
        "The picture is brighter the more samples it has.",
        "pixel += L, without / spp",
        "I14: a pixel is the mean of its samples",
        {"film": sum_of_samples},
    ),
    Bug(
        "F05",
        "No jitter within the pixel",
        "Edges are jagged, however many samples there are: a pixel on an edge does not vary.",
        "x = (i + 0.5) / width for all samples",
        "I15: each random number is drawn for one purpose and is uniform",
        {"random": centres},
    ),
    Bug(
        "F06",
        "Aspect ratio by integer division",
        "The picture is squashed: an oblong one shows too much above and below.",
        "aspect = width / height with both of them int",
        "I13: camera rays go through their own place on the film",
        {"camera": aspect_of_whole_numbers},
        scene="materials",
        settings={},
    ),
    Bug(
        "P05",
        "One counter for the pixels of all threads",
        "The rows of the picture are shuffled.",
        "framebuffer[m++] = colour, with m shared by the threads",
        "I14: a pixel is the mean of its own samples",
        {"camera": one_counter},
        note="Four threads that keep step; a real race shuffles differently each time.",
    ),
    Bug(
        "P06",
        "Rows lost in the split among threads",
        "There is a black band at the bottom of the picture.",
        "rows_per_thread = height / threads, without the remainder",
        "I14: a pixel is the mean of its own samples",
        {"film": rest_forgotten},
        note="Eleven threads.",
    ),
)

"""The command `castray bsdf`: one material on the bench, as text, as JSON and as a picture."""

import tomllib
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter

from tracer import material_bench as bench
from tracer.bsdf.metals import METALS
from tracer.scene_file import materials
from tracer.settings import TracerError
from viewer.options import Json, print_json
from viewer.words import Speaker

ANGLES = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0)


def bsdf(
    name: str,
    /,
    *parameters: str,
    output: Annotated[Path | None, Parameter(name=["-o", "--output"])] = None,
    json: Json = False,
    **words: str,
):
    """Put one material on the bench: which properties hold, its albedo, its Fresnel curves, and a plot.

    Parameters
    ----------
    name
        A type of material (roughconductor), a metal (Au), or something clear (bk7, water).
    parameters
        The material's words as scenes have them: alpha=0.2, diffuse_reflectance=[0.8,0.2,0.1].
    output
        Where a plot goes, .png or .svg; none is drawn without it.
    words
        The same words written as options: --alpha 0.2.
    """
    from viewer import plot_bsdf, plots

    if output is not None:
        plots.check_path(output)
    document, material = report(name, split(parameters, words))
    if output is not None:
        with plots.lettered() as say:
            plots.write(plot_bsdf.figure(document, material, say), output)
        document["out"] = str(output)
    if json:
        print_json(document)
        return
    print_report(document)
    if output is not None:
        print(f"\n{Speaker()('bench_bsdf.plot', path=output)}")


def described(name, words):
    """The description of a material: a type, or the name of a metal or of something clear; and its words.

    words: {word: text}; a text is read as a scene file would, else as a plain word.
    """
    rough = "rough" if words.keys() & {"alpha", "alpha_u", "alpha_v"} else ""
    if name in METALS:
        start = {"type": f"{rough}conductor", "material": name}
    elif name in materials.INDICES:
        start = {"type": f"{rough}dielectric", "int_ior": name}
    elif name in materials.BSDFS:
        start = {"type": name}
    else:
        known = ", ".join((*materials.BSDFS, *METALS, *materials.INDICES))
        raise TracerError(f"bsdf: {name!r} is not a material; known: {known}")
    if name == "twosided" and not words:
        start["bsdf"] = {"type": "diffuse"}
    return start | {word: _value(text) for word, text in words.items()}


def _value(text):
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def split(parameters, options):
    """{word: text} of `word=value` parameters and `--word value` options."""
    words = {}
    for parameter in parameters:
        word, equals, value = parameter.partition("=")
        if not equals or not word:
            raise TracerError(f"bsdf: {parameter!r} is no parameter; write word=value, as in alpha=0.2")
        words[word] = value
    return words | {word.replace("-", "_"): value for word, value in options.items()}


def report(name, words):
    """Everything the bench finds out about a material: (document for JSON, the material)."""
    description = described(name, words)
    material = materials.bsdf(description, name)
    angles = [side for a in ANGLES for side in ((a,) if material.one_sided else (a, 180.0 - a))]
    angles = sorted(angles)
    reflected, transmitted, error = bench.albedo(material, angles)
    curves = bench.fresnel_curves(material)
    document = {
        "name": name,
        "material": description,
        "properties": [p._asdict() for p in bench.properties(material)],
        "albedo": [
            {
                "degrees": angle,
                "reflected": [float(v) for v in reflected[:, k]],
                "transmitted": [float(v) for v in transmitted[:, k]],
                "standard_error": [float(v) for v in error[:, k]],
            }
            for k, angle in enumerate(angles)
        ],
        "fresnel": None if curves is None else curves[1] | _errors(curves[0]),
    }
    return document, material


def _errors(curves):
    gap = curves["schlick"] - curves["exact"]
    worst = int(np.argmax(np.abs(gap)))
    return {
        "head_on": float(curves["exact"][0]),
        "schlick_error": float(gap[worst]),
        "schlick_error_degrees": float(np.degrees(np.arccos(np.clip(curves["cos"][worst], 0.0, 1.0)))),
    }


def print_report(document):
    """The report as text."""
    from rich.console import Console
    from rich.table import Table

    console, say = Console(highlight=False, soft_wrap=True), Speaker()
    words = ", ".join(f"{word} = {value}" for word, value in document["material"].items())
    console.print(f"{document['name']}: {words}\n", markup=False)
    table = Table(box=None, title=say("bench_bsdf.properties"), title_justify="left", title_style="bold")
    for column in ("property", "", "figure", "which"):
        head = say(f"bench_bsdf.{column}") if column else ""
        table.add_column(head, justify="right" if column == "figure" else "left")
    for p in document["properties"]:
        holds = say("value.yes" if p["holds"] else "value.no")
        name, meaning = (say.optional(f"property.{p[key]}", p[key]) for key in ("name", "meaning"))
        table.add_row(name, holds, f"{p['figure']:.3g}", meaning)
    console.print(table)
    table = Table(box=None, title=f"\n{say('bench_bsdf.albedo')}", title_justify="left", title_style="bold")
    for column in ("angle", "reflected", "transmitted", "error"):
        table.add_column(say(f"bench_bsdf.{column}"), justify="right")
    for row in document["albedo"]:
        shares = (" ".join(f"{v:.4f}" for v in row[key]) for key in ("reflected", "transmitted"))
        table.add_row(f"{row['degrees']:g}°", *shares, f"{max(row['standard_error']):.1e}")
    console.print(table)
    if document["fresnel"]:
        marks = document["fresnel"]
        numbers = {"head_on": f"{marks['head_on']:.4f}", "off": f"{marks['schlick_error']:+.4f}"}
        said = [say("bench_bsdf.fresnel", degrees=f"{marks['schlick_error_degrees']:.1f}", **numbers)]
        angles = (key for key in ("brewster", "critical") if key in marks)
        said += [say(f"bench_bsdf.{key}", degrees=f"{marks[key]:.2f}") for key in angles]
        console.print(f"\n{say.clauses(*said)}", markup=False)

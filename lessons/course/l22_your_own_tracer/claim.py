"""A tracer of one's own, judged: the starter with one factor left out, as `castray check` runs it."""

import tempfile
from pathlib import Path

import numpy as np

import tracer
from tracer.learner import child, starter
from tracer.settings import Settings

SIDE, SPP = 8, 4  # of the small picture
RIGHT, WRONG = "/ pdf / SURVIVAL", "/ pdf"


def experiment(run):
    """What the doctor says of a starter without its last division; the terms of one light sample in red."""
    found = judged().findings[0]
    assert found.bug == "R01" and found.count == found.checked

    light = run.event("start")
    beta, f, Le = (light[name][0] for name in ("beta", "f", "Le"))
    product = beta * f * Le * light["cos"] * light["w"] / light["pdf"]
    assert np.isclose(product, light["contribution"][0], rtol=1e-4)
    bounce = run.event("bounce")
    grown = bounce["beta_before"][0] * bounce["f"][0] * bounce["cos"] / bounce["pdf"]
    assert np.isclose(grown, bounce["beta"][0], rtol=1e-4)
    went, chose = (np.array(value) for value in (run.event("local")["d"], bounce["wi"]))
    assert not np.allclose(went, chose, atol=0.1)
    assert np.allclose(run.event("next")["wo"], -chose, atol=1e-4)
    return {
        "product": product,
        "without_cos": product / light["cos"],
        "without_pdf": product * light["pdf"],
        "by_area": product * light["pdf"] / light["pdf_area"],
        "bug": found.bug,
        "rule": found.rule,
        "count": found.count,
        "checked": found.checked,
        "side": SIDE,
        "spp": SPP,
    }


def judged():
    """The Diagnosis of the starter with the mistake."""
    text = Path(starter.__file__).read_text(encoding="utf-8")
    assert text.count(RIGHT) == 1
    settings = Settings(
        width=SIDE,
        height=SIDE,
        spp=SPP,
        precision=64,
        integrator="direct",
        light_sampling="area",
        jitter=False,
    )
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "my_tracer.py"
        file.write_text(text.replace(RIGHT, WRONG), encoding="utf-8")
        traces = child.run({"file": str(file), "scene": "cornell", "settings": settings.as_dict()})
    return tracer.examine(traces[0])

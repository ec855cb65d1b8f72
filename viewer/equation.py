"""The formula of an event: in symbols, with this path's own numbers put in, and the result, as MathML."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from viewer.numerals import several, short, tex
from viewer.session import throughput

CHANNELS = ("R", "G", "B")
MOST_TERMS = 5
WORTH_SAYING = (
    1e-4  # relative difference above which the formula's own result is shown beside the recorded one
)


@dataclass(frozen=True)
class Factor:
    """One symbol of a product. field: where the schema explains it."""

    symbol: str
    field: str
    value: object


@dataclass(frozen=True)
class Product:
    """target = over / under; recorded is what the event says came out."""

    target: str
    over: tuple
    under: tuple
    recorded: np.ndarray

    @property
    def value(self):
        """What the factors give, in float64."""
        top = np.prod([np.broadcast_to(np.asarray(f.value, float), 3) for f in self.over], axis=0)
        bottom = np.prod([np.broadcast_to(np.asarray(f.value, float), 3) for f in self.under], axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(top == 0, 0.0, top / bottom)

    @property
    def agrees(self):
        """Whether the formula gives what was recorded."""
        return bool(np.allclose(self.value, np.asarray(self.recorded, float), rtol=WORTH_SAYING, atol=1e-12))


def formulas(path, index, settings, say):
    """Everything the equation panel shows for one event, ready to send."""
    event = path.events[index]
    product = PRODUCTS.get(event.kind.name, lambda v, beta: None)(
        event.values, throughput(path.events, index - 1)
    )
    if product is None:
        plain = {"legend": [], "result": "", "differs": "", "weight": None}
        return {"symbolic": _special(path, event), "rows": _sum_rows(path, event), **plain}
    return {
        "symbolic": mathml(_symbolic(product)),
        "rows": [{"channel": c, "math": mathml(_numeric(product, k))} for k, c in enumerate(CHANNELS)],
        "result": several(product.recorded),
        "differs": "" if product.agrees else several(product.value),
        "legend": [_explained(factor, event.kind, say) for factor in (*product.over, *product.under)],
        "weight": _weight(event, settings, say),
    }


def _hit(v, beta):
    """beta: throughput before the way here."""
    arriving: tuple = (Factor(r"\beta", "beta", v["beta"]),)
    if _absorbed(v):
        arriving = (Factor(r"\beta", "beta_before", beta), Factor("T", "transmittance", v["transmittance"]))
        if not np.any(v["Le"] > 0):
            return Product(r"\beta' = ", arriving, (), v["beta"])
    return Product(
        "L += ", (*arriving, Factor("L_e", "Le", v["Le"]), Factor("w", "w", v["w"])), (), v["contribution"]
    )


def _absorbed(v):
    """Whether anything was lost on the way."""
    return np.any(v["transmittance"] != 1.0)


def _light(v, beta):
    over: tuple = (
        Factor(r"\beta", "beta", v["beta"]),
        Factor("f", "f", v["f"]),
        Factor(r"\cos\theta", "cos", v["cos"]),
        Factor("L_e", "Le", v["Le"]),
        Factor("V", "visible", v["visible"]),
        Factor("w", "w", v["w"]),
    )
    if _absorbed(v):
        over = (*over[:4], Factor("T", "transmittance", v["transmittance"]), *over[4:])
    return Product("L += ", over, (Factor("p", "pdf", v["pdf"]),), v["contribution"])


def _bounce(v, beta):
    over: tuple = (Factor(r"\beta", "beta_before", v["beta_before"]), Factor("f", "f", v["f"]))
    if not v["delta"]:  # at a Dirac lobe the cosine cancels
        over += (Factor(r"\cos\theta", "cos", v["cos"]),)
    return Product(r"\beta' = ", over, (Factor("P" if v["delta"] else "p", "pdf", v["pdf"]),), v["beta"])


def _roulette(v, beta):
    if not v["survived"]:
        return None
    q = np.asarray(v["probability"], float)
    return Product(
        r"\beta' = ",
        (Factor(r"\beta", "beta", np.asarray(v["beta"], float) * q),),
        (Factor("q", "probability", q),),
        v["beta"],
    )


def _escape(v, beta):
    over = (Factor(r"\beta", "beta", beta), Factor("L_e", "Le", v["Le"]), Factor("w", "w", v["w"]))
    return Product("L += ", over, (), v["contribution"])


PRODUCTS = {"hit": _hit, "light": _light, "bounce": _bounce, "roulette": _roulette, "escape": _escape}


def _symbolic(product):
    top = r" \, ".join(f.symbol for f in product.over)
    return product.target + _fraction(top, r" \, ".join(f.symbol for f in product.under))


def _numeric(product, channel):
    top = r" \cdot ".join(_number(f, channel) for f in product.over)
    bottom = r" \cdot ".join(_number(f, channel) for f in product.under)
    return f"{_fraction(top, bottom)} = {tex(product.recorded[channel])}"


def _number(factor, channel):
    return tex(np.broadcast_to(factor.value, 3)[channel])


def _fraction(top, bottom):
    return rf"\frac{{{top}}}{{{bottom}}}" if bottom else top


def _explained(factor, kind, say):
    names = {f.name for f in kind.fields}
    meaning = say.meaning(kind, factor.field) if factor.field in names else say("symbol." + factor.field)
    return {"symbol": mathml(factor.symbol), "meaning": meaning, "value": several(factor.value)}


def _special(path, event):
    """Events without a product: the camera's start, a lost roulette, the sum at the end."""
    if event.kind.name == "camera":
        return mathml(r"\beta = 1")
    if event.kind.name == "roulette":
        v = event.values
        return mathml(rf"u = {tex(v['u'])} \geq q = {tex(v['probability'])}")
    terms = [rf"\Delta L_{{{e.step}}}" for e in _giving(path)]
    return mathml("L = " + _some(terms))


def _sum_rows(path, event):
    """At the end: what every contribution added, one row a channel."""
    if event.kind.name != "end":
        return []
    given, total = _giving(path), event.values["radiance"]
    sums = [_some([tex(e.values["contribution"][k]) for e in given]) for k in range(3)]
    return [{"channel": c, "math": mathml(f"{sums[k]} = {tex(total[k])}")} for k, c in enumerate(CHANNELS)]


def _giving(path):
    return [e for e in path.events if np.any(e.values.get("contribution", 0) > 0)]


def _some(terms):
    """A sum of at most MOST_TERMS terms."""
    return " + ".join(terms[:MOST_TERMS] + [r"\cdots"] * (len(terms) > MOST_TERMS)) or "0"


def _weight(event, settings, say):
    """The MIS weight's own formula, or one sentence on why there is none."""
    v, name = event.values, event.kind.name
    if name not in ("hit", "light", "escape") or not np.any(np.asarray(v["Le"]) > 0):
        return None
    if settings.integrator != "path" or settings.strategy != "mis":
        return {"math": "", "note": say(f"weight.{settings.integrator}.{settings.strategy}", w=short(v["w"]))}
    if "pdf_bsdf" not in v:
        return {"math": "", "note": say("weight.is", w=short(v["w"]))}
    mine, other = ("p", r"p_{\text{bsdf}}") if name == "light" else (r"p_{\text{bsdf}}", r"p_{\text{light}}")
    ours, theirs = (v["pdf"], v["pdf_bsdf"]) if name == "light" else (v["pdf_bsdf"], v["pdf_light"])
    if np.isinf(ours):
        return {"math": "", "note": say("weight.certain")}
    two = "^2" if settings.heuristic == "power" else ""
    symbols = rf"w = \frac{{{mine}{two}}}{{{mine}{two} + {other}{two}}}"
    numbers = rf"\frac{{{_sq(ours, two)}}}{{{_sq(ours, two)} + {_sq(theirs, two)}}} = {tex(v['w'])}"
    return {"math": mathml(symbols) + mathml("= " + numbers), "note": say(f"weight.{settings.heuristic}")}


def _sq(value, power):
    number = tex(value)
    return rf"({number}){power}" if power and "times" in number else number + power


@lru_cache(512)
def mathml(latex):
    """LaTeX as MathML; the converter is loaded when the first formula is."""
    from latex2mathml.converter import convert

    plus, equals = "<mo>&#x0002B;</mo>", "<mo>&#x0003D;</mo>"
    return convert(latex, display="block").replace(plus + equals, "<mo>+=</mo>")

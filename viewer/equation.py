"""The formula of an event: in symbols, with this path's own numbers put in, and the result, as MathML.

Each factor knows the event that it came from, so that a click on it leads there.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracer.recorder import number
from viewer.mathml import fraction, mathml
from viewer.numerals import several, short, tex
from viewer.session import throughput

CHANNELS = ("R", "G", "B")
MOST_TERMS = 5
WORTH_SAYING = (
    1e-4  # relative difference above which the formula's own result is shown beside the recorded one
)


@dataclass(frozen=True)
class Factor:
    """One symbol of a product. field: where the schema explains it; came: the event that made it, None where
    it is this one."""

    symbol: str
    field: str
    value: object
    came: int | None = None


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
        with np.errstate(all="ignore"):
            top, bottom = _times(self.over), _times(self.under)
            return np.where(top == 0, 0.0, top / bottom)

    @property
    def agrees(self):
        """Whether the formula gives what was recorded."""
        return bool(np.allclose(self.value, np.asarray(self.recorded, float), rtol=WORTH_SAYING, atol=1e-12))


def _times(factors):
    """The product (3,) of factors, in float64."""
    product = np.ones(3)
    for factor in factors:
        product = product * np.asarray(factor.value, float)
    return product


def formulas(path, index, settings, say):
    """Everything the equation panel shows for one event, ready to send."""
    event = path.events[index]
    product = product_of(path, index)
    if not product:
        return {
            "symbolic": _special(path, event),
            "rows": _sum_rows(path, event),
            "legend": [_summand(e, say) for e in _giving(path)] if event.kind.name == "end" else [],
            "result": "",
            "differs": "",
            "weight": None,
        }
    product = _traced(product, path, index)
    factors = (*product.over, *product.under)
    known = not np.isnan(product.value).all()  # else factors are missing: a log need not have them
    return {
        "symbolic": _symbolic(product),
        "rows": [{"channel": c, "math": _numeric(product, k)} for k, c in enumerate(CHANNELS)],
        "result": several(product.recorded),
        "differs": several(product.value) if known and not product.agrees else "",
        "legend": [_explained(factor, path, event.kind, say) for factor in factors],
        "weight": _weight(event, settings, say),
    }


def product_of(path, index):
    """The Product that an event of a path works out, None where there is none."""
    event = path.events[index]
    make = PRODUCTS.get(event.kind.name)
    return make and make(event.values, throughput(path.events, index - 1))


def _traced(product, path, index):
    """The product with the event that each factor came from."""

    def sides(factors):
        return tuple(replace(f, came=origin(path, index, f.field)) for f in factors)

    return replace(product, over=sides(product.over), under=sides(product.under))


def origin(path, index, field):
    """Number of the event that a factor of an event's formula was made by; None where it is that one.

    The throughput is that of the last bounce, roulette or way through glass; what the surface does follows
    from where it was hit; the weight of a lamp that is met from the bounce that led there.
    """
    kind = path.events[index].kind.name
    if field in ("beta", "beta_before"):
        return _before(path, index, MAKERS, lambda e: e.kind.name != "hit" or _absorbed(e.values))
    if field in ("f", "cos") and kind in ("light", "bounce"):
        return _before(path, index, ("hit",))
    if field == "w" and kind in ("hit", "escape"):
        return _before(path, index, ("bounce",))
    return None


def _before(path, index, kinds, fits=lambda event: True):
    earlier = (e.step for e in reversed(path.events[:index]) if e.kind.name in kinds and fits(e))
    return next(earlier, None)


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
        (Factor(r"\beta", "beta", beta),),
        (Factor("q", "probability", q),),
        v["beta"],
    )


def _escape(v, beta):
    over = (Factor(r"\beta", "beta", beta), Factor("L_e", "Le", v["Le"]), Factor("w", "w", v["w"]))
    return Product("L += ", over, (), v["contribution"])


MAKERS = ("camera", "hit", "bounce", "roulette")  # of a throughput
PRODUCTS = {"hit": _hit, "light": _light, "bounce": _bounce, "roulette": _roulette, "escape": _escape}


def _symbolic(product):
    return fraction(product.target, _sides(product, lambda f: f.symbol), r"\,")


def _numeric(product, channel):
    sides = _sides(product, lambda f: tex(np.broadcast_to(f.value, 3)[channel]))
    return fraction("", sides, r"\cdot", f"= {tex(product.recorded[channel])}")


def _sides(product, spelled):
    """What stands above and below the line: (LaTeX, event it came from) of each factor."""
    return tuple([(spelled(f), f.came) for f in side] for side in (product.over, product.under))


def _explained(factor, path, kind, say):
    names = {f.name for f in kind.fields}
    meaning = say.meaning(kind, factor.field) if factor.field in names else say("symbol." + factor.field)
    line = _line(factor.symbol, factor.field, meaning, factor.value)
    return line | _place(None if factor.came is None else path.events[factor.came], say)


def _summand(event, say):
    """A term of the sum at the end of a path."""
    name = say(f"ledger.{event.kind.name}", depth=event.depth)
    return _line(_term(event), f"term-{event.step}", name, event.values["contribution"]) | _place(event, say)


def _line(symbol, field, meaning, value):
    """One line of the legend."""
    exact = [number(v) for v in np.ravel(value)]
    return {
        "symbol": mathml(symbol),
        "field": field,
        "meaning": meaning,
        "value": several(value),
        "exact": exact,
    }


def _place(event, say):
    """The event that a line of the legend leads to, None for no other."""
    if event is None:
        return {"came": None, "source": ""}
    kind = say(f"kind.{event.kind.name}")
    return {
        "came": event.step,
        "source": say("symbol.from", event=event.step, kind=kind),
    }


def _term(event):
    return rf"\Delta L_{{{event.step}}}"


def _special(path, event):
    """Events without a product: the camera's start, a lost roulette, the sum at the end."""
    if event.kind.name == "camera":
        return mathml(r"\beta = 1")
    if event.kind.name == "roulette":
        v = event.values
        return mathml(rf"u = {tex(v['u'])} \geq q = {tex(v['probability'])}")
    return mathml("L = " + _some([_term(e) for e in _giving(path)]))


def _sum_rows(path, event):
    """At the end: what every contribution added, one row a channel."""
    if event.kind.name != "end":
        return []
    given, total = _giving(path), event.values["radiance"]
    sums = [_some([tex(e.values["contribution"][k]) for e in given]) for k in range(3)]
    return [{"channel": c, "math": mathml(f"{sums[k]} = {tex(total[k])}")} for k, c in enumerate(CHANNELS)]


def _giving(path):
    return [e for e in path.events if np.any(e.values.get("contribution", 0) != 0)]


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

"""The values of truth.json: how near castray comes to them."""

import truth
from values import EVALUATORS, evaluated
from values.registry import kernel_error, off, to_a_percent

from figures.figure import Figure

TITLE = "Exact values"
CHUNKS = 30
OTHERS = "mitsuba rtol 1e-5; pbrt 4 ulp"


def kernels(bits):
    """Keys of the kernels that keep the usual bar."""
    usual = {64: truth.RELATIVE, 32: truth.ULPS}[bits]
    return [key for key, b in evaluated("kernel") if b == bits and truth.bar(key, b) == usual]


def _nearest(bits):
    def measure(seed):
        errors = {key: float(kernel_error(key, bits)) for key in kernels(bits)}
        return {"most_off": max(errors.values()), "where": [max(errors, key=errors.get)]}

    return measure


def _judge(bits):
    def judge(sums, chunks):
        most = sums["most_off"]
        text = f"{most:.2g}" if bits == 64 else f"{most:.2f} ulp"
        return f"{text}, {sums['where'][0]}", most <= {64: truth.RELATIVE, 32: truth.ULPS}[bits]

    return judge


def _estimates(bits):
    keys = [key for key, b in evaluated("estimator") if b == bits]

    def measure(seed):
        """A part of the keys, each to 1 %: its distance in 4 standard errors, and those relative."""
        found = []
        for key in keys[seed // 1000 % CHUNKS :: CHUNKS]:
            estimate, value = to_a_percent(key, bits, seed), truth.entry(key)[1]
            found.append([key, off(key, bits, estimate), truth.SIGMAS * estimate.error / abs(value)])
        return {"found": found}

    return measure


def _judge_estimates(sums, chunks):
    key, worst, _ = max(sums["found"], key=lambda row: row[1])
    widest = max(bound for _, _, bound in sums["found"])
    text = f"{truth.SIGMAS * worst:.2f} standard errors ({key}), the worst of {len(sums['found'])}; "
    text += f"{truth.SIGMAS:g} of them are at most {100 * widest:.2f} % of the value"
    return text, worst <= 1.0 and widest <= truth.PERCENT


def figures():
    for bits in (64, 32):
        what, bar = {
            64: ("largest relative error of deterministic kernels", f"{truth.RELATIVE:g}"),
            32: ("largest error of deterministic kernels, at the inputs float32 has", f"{truth.ULPS} ulp"),
        }[bits]
        n = len(kernels(bits))
        yield Figure(f"exact-{bits}", what, bar, OTHERS, f"float{bits}", 1, n, _nearest(bits), _judge(bits))
    for bits in (64, 32):
        yield Figure(
            f"exact-estimates-{bits}",
            "estimates of exact values",
            "4 standard errors, at most 1 %",
            "pbrt 2.5 %; nori 1 % of t-tests",
            f"float{bits}",
            CHUNKS,
            -(-sum(b == bits for _, b in evaluated("estimator")) // CHUNKS),
            _estimates(bits),
            _judge_estimates,
        )


def notes():
    """What is tested, what is not, and what keeps another bar."""
    tested = [key for key in truth.TRUTH if key in EVALUATORS]
    text = f"""
{len(tested)} of {len(truth.TRUTH)} values of tests/truth.json are tested:
{len(of_kind("kernel"))} by kernels that need no random numbers, {len(of_kind("estimator"))} by estimates,
{len(of_kind("bound"))} as bounds of rounding, {len(of_kind("refuted"))} as what a wrong formula would give.
Not tested: {"; ".join(f"`{start}` ({why})" for start, why in truth.UNTESTED.items()) or "none"}.

Kernels that keep another bar, and why:
"""
    for bits, unit in ((64, ""), (32, " ulp")):
        for start, (bar, why) in truth.EXCEPTIONS[bits].items():
            found = max(kernel_error(key, bits) for key in truth.keys(start))
            text += f"\n- `{start}`, float{bits}: {found:.2g}{unit}, at most {bar:g}{unit}: {why}"
    text += "\n\nValues that one precision only has:\n"
    for (bits, why), keys in one_precision().items():
        text += f"\n- float{bits}: {', '.join(f'`{key}`' for key in keys)}: {why}"
    for key, right in truth.MISPRINTS.items():
        text += f"\n\n`{key}` is {truth.TRUTH[key]['value']:.4g} in the table and {right:.4g} in truth."
    return text + "\n"


def of_kind(kind):
    return [key for key, evaluator in EVALUATORS.items() if evaluator.kind == kind]


def one_precision():
    """{(bits, reason): keys}."""
    found = {}
    for key, evaluator in EVALUATORS.items():
        if len(evaluator.bits) == 1:
            found.setdefault((evaluator.bits[0], evaluator.why), []).append(key)
    return found

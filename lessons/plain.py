"""Formulas as a terminal can show them: LaTeX spelled in Unicode, one line each."""

import re

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[{}^_]|\s+|[^\\{}^_\s]")
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "varepsilon": "ε", "eta": "η",
    "theta": "θ", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ",
    "sigma": "σ", "tau": "τ", "phi": "φ", "varphi": "φ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ",
    "Lambda": "Λ", "Sigma": "Σ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "ell": "ℓ",
}  # fmt: skip
SIGNS = {
    "cdot": "·", "times": "×", "pm": "±", "le": "≤", "leq": "≤", "ge": "≥", "geq": "≥", "ne": "≠", "neq": "≠",
    "approx": "≈", "to": "→", "infty": "∞", "int": "∫", "sum": "∑", "prod": "∏", "partial": "∂", "in": "∈",
    "circ": "°", "dots": "...", "cdots": "···", "ldots": "...", "quad": "  ", "qquad": "    ", "propto": "∝",
    "equiv": "≡", "sim": "~", "ll": "≪", "gg": "≫", "mid": "|", "vert": "|", "lVert": "‖", "rVert": "‖",
    "lvert": "|", "rvert": "|", "Rightarrow": "⇒", "rightarrow": "→", "perp": "⊥", "parallel": "∥",
    "langle": "⟨", "rangle": "⟩", "lfloor": "⌊", "rfloor": "⌋", "forall": "∀", "land": "∧", "lor": "∨",
    "div": "÷", "iff": "⇔",
}  # fmt: skip
NAMES = (
    "sin", "cos", "tan", "arcsin", "arccos", "arctan", "max", "min", "log", "ln", "exp", "lim", "arg", "det",
)  # fmt: skip
SPACES = {
    ",": " ",
    ";": " ",
    ":": " ",
    "!": "",
    " ": " ",
    "%": "%",
    "{": "{",
    "}": "}",
    "|": "‖",
    "_": "_",
    "$": "$",
}
SILENT = ("left", "right", "big", "Big", "bigl", "bigr", "Bigl", "Bigr", "displaystyle", "limits")
WORDS = ("text", "mathrm", "mathbf", "mathit", "operatorname", "mathsf", "boldsymbol", "mathcal")
ABOVE = {"hat": "\u0302", "bar": "\u0304", "tilde": "\u0303", "vec": "\u20d7"}
RAISED = dict(zip("0123456789+-()niT", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ⁿⁱᵀ", strict=True)) | {"°": "°", "'": "′"}
LOWERED = dict(zip("0123456789+-()aehijklmnoprstuvx", "₀₁₂₃₄₅₆₇₈₉₊₋₍₎ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ", strict=True))
LOOSE = "=<>≤≥≈≠→⇒⇔≡∝≪≫+−·×"


def spelled(latex):
    """A formula in one line of Unicode. ValueError names a command that the table lacks."""
    text, rest = _group(TOKEN.findall(latex), closed=False)
    return _tidy(text)


def _tidy(text):
    """One space between things, none inside brackets, none behind a minus that stands before one thing."""
    text = re.sub(r"(?:(?<=[(√⟨])|(?<=[ (]\|)|(?<=^\|)) ", "", re.sub(r" +", " ", text)).strip()
    return re.sub(r"(^|[(,=<>≤≥≈·×]) ?− ", lambda m: f"{m[1]}{' ' if m[1] not in ('', '(') else ''}−", text)


def _group(tokens, closed=True):
    """Text up to the brace that ends it, and the tokens behind."""
    said = ""
    while tokens:
        token, tokens = tokens[0], tokens[1:]
        if token == "}":
            return said, tokens
        if token in "^_":
            script, tokens = _one(tokens)
            said += _script(script, *((RAISED, "^") if token == "^" else (LOWERED, "_")))
            continue
        text, tokens = _one([token, *tokens])
        said += text
    if closed:
        raise ValueError("a brace is not closed")
    return said, tokens


def _one(tokens):
    """One thing, and the tokens behind it."""
    while tokens and tokens[0].isspace():
        tokens = tokens[1:]
    if not tokens:
        raise ValueError("something is missing at the end")
    token, tokens = tokens[0], tokens[1:]
    if token == "{":
        return _group(tokens)
    if token.startswith("\\"):
        return _command(token[1:], tokens)
    token = "−" if token == "-" else token
    return (", " if token == "," else f" {token} " if token in LOOSE else token), tokens


def _command(name, tokens):
    if name == "frac":
        top, tokens = _one(tokens)
        bottom, tokens = _one(tokens)
        return f"{_whole(top)}/{_whole(bottom)}", tokens
    if name == "sqrt":
        inside, tokens = _one(tokens)
        return f"√{_whole(inside)}", tokens
    if name in WORDS:
        return _one(tokens) if name not in ("text", "operatorname") else _literal(tokens)
    if name in ABOVE:
        inside, tokens = _one(tokens)
        return inside + ABOVE[name], tokens
    if name in SILENT:
        return "", tokens
    if name in NAMES:
        space = " " if tokens and tokens[0] not in "^_(" else ""
        return f" {name}{space}", tokens
    if name in SIGNS:
        sign = SIGNS[name]
        return (f" {sign} " if sign in LOOSE else sign), tokens
    known = GREEK | SPACES
    if name not in known:
        raise ValueError(f"\\{name} is not in the table of lessons/plain.py")
    return known[name], tokens


def _literal(tokens):
    """The words of a brace as they stand."""
    if not tokens or tokens[0] != "{" or "}" not in tokens:
        raise ValueError("words stand in braces")
    end = tokens.index("}")
    return "".join(tokens[1:end]), tokens[end + 1 :]


def _whole(text):
    """Text in brackets unless it is one thing, a function of something included."""
    text = text.strip()
    return text if re.fullmatch(r"[\w.₀-₉ₐ-ₜ⁰-⁹²³¹ᵢ°′]+(\([\w₀-₉ₐ-ₜᵢ]+\))?", text) else f"({text})"


def _script(text, table, mark):
    text = _tidy(text)
    plain = text.replace("−", "-")
    if len(plain) < 3 and all(letter in table for letter in plain):
        return "".join(table[letter] for letter in plain)
    return f"{mark}{text}" if text.isalnum() else f"{mark}({text})"

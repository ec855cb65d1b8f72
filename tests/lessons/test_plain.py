"""Formulas are readable in a terminal."""

import pytest

from lessons.plain import spelled


@pytest.mark.parametrize(
    ("latex", "said"),
    [
        (r"\sin\theta_o = \eta\,\sin\theta_i", "sin θₒ = η sin θᵢ"),
        (r"\theta_c = \arcsin\eta", "θ_c = arcsin η"),
        (r"r = d\tan\theta_c", "r = d tan θ_c"),
        (r"\sqrt{1 - \sin^2\theta_i}", "√(1 − sin²θᵢ)"),
        (r"\frac{1}{\pi}", "1/π"),
        (r"\frac{a + b}{2}", "(a + b)/2"),
        (r"\frac{L_{\text{water}}}{n^2}", "L_water/n²"),
        (r"f_r(\omega_i, \omega_o)", "fᵣ(ωᵢ, ωₒ)"),
        (r"\int_\Omega \, f \cos\theta \, d\omega \le 1", "∫_Ω f cos θ dω ≤ 1"),
        (r"\left(\frac{1-n}{1+n}\right)^2", "((1 − n)/(1 + n))²"),
        (r"e^{-\sigma_t x}", "e^(−σₜx)"),
        (r"\hat{n} \cdot \omega", "n\u0302 · ω"),
        ("x_{k+1}", "x_(k + 1)"),
        (r"90^\circ", "90°"),
        (r"|n_x p_x| + |n_y p_y|", "|nₓpₓ| + |n_yp_y|"),
        (r"p(\omega_i \mid \omega_o)", "p(ωᵢ|ωₒ)"),
        (r"\frac{1}{N}\,\sum_{k=1}^{N}\,\frac{f(x_k)}{p(x_k)}", "1/N ∑_(k = 1)^N f(xₖ)/p(xₖ)"),
    ],
)
def test_a_formula_in_one_line(latex, said):
    assert spelled(latex) == said


@pytest.mark.parametrize("latex", [r"\unheard{x}", r"\frac{1}", "{x", r"\text x"])
def test_what_the_table_lacks_is_told(latex):
    with pytest.raises(ValueError, match=r"."):
        spelled(latex)

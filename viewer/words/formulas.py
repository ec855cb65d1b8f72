"""Words in the formulas of the doctor's laws, and what its numbers are called, in other languages.

formula.RULE where there are words in it, quantity.NAME; the English stands beside each rule in tracer/doctor/.
"""

_LIGHT_PDF = "P(灯) pdf_area r^2 / cos_light，或 P(灯) / 立体角"
_MET = "若只有反弹能找到光源，w = 1；若光源样本计入并且能找到它，w = 0；否则 w = MIS(pdf_bsdf, pdf_light)"
WORDS = {
    "zh": {
        "formula.on-surface": "n . p = c，且在边界之内",
        "formula.shading-normal": "n = normalize(Σ b_i n_i)",
        "formula.first-surface": "t = 对所有表面的最小值",
        "formula.light-point": "q 在灯上",
        "formula.light-pick": "Σ P(灯) = 1",
        "formula.light-radiance": "Le(q, -wi)；cos_light <= 0 时为 0",
        "formula.light-pdf": f"pdf = {_LIGHT_PDF}",
        "formula.light-visible": "若 0 < t < r 处没有表面，V = 1",
        "formula.light-due": "每个顶点 1 个",
        "formula.bounce-side": "反射时 (n . wi)(n . wo) > 0，透射时 < 0",
        "formula.bounce-mirror": "wi = 2 (n . wo) n - wo；sin i = eta sin t",
        "formula.bounce-mirror-f": "f = F，或 (1 - F) / eta^2",
        "formula.bounce-mirror-pdf": "pdf = F，或 1 - F",
        "formula.pdf-of-last-bounce": "pdf_bsdf = pdf；在相机或狄拉克波瓣之后为 inf",
        "formula.pdf-of-light": f"pdf_light = {_LIGHT_PDF}",
        "formula.pdf-of-environment": "pdf_light = P(环境) pdf(d)",
        "formula.emission-weight": _MET,
        "formula.environment-weight": _MET,
        "formula.light-weight": "若不计入找到它的反弹，w = 1；否则 w = MIS(pdf, pdf_bsdf)",
        "formula.roulette-probability": "q 等于声明的值",
        "formula.dead": "survived = false 时路径结束",
        "formula.throughput": "beta' = beta f cos / pdf；狄拉克波瓣处 beta' = beta f / pdf",
        "formula.throughput-on-arrival": "beta_k+1 = 反弹和轮盘赌之后的 beta × 透射率",
        "formula.absorbed": "n . wi > 0、n . wo > 0 时 f > 0、pdf > 0",
        "formula.end": "凡终止都有补偿",
        "formula.ledger": "L = Σ contribution",
        "formula.light-nothing": "cos_light < 0 或 f = 0 时 contribution = 0",
        "formula.film": "E[胶片位置 - 像素] = 1/2",
        "formula.lamp-choice": "N(灯) = n P(灯)",
        "formula.lamp-points": "p(q) = 1 / A，或 p(wi) = 1 / Omega",
        "formula.directions": "p(wi) = cos / pi，或 1 / (2 pi)",
        "formula.roulette-share": "N(survived) = Σ q",
        "formula.mean": "E[contribution] = E[参考的 contribution]",
        "formula.variance": "Var[L] = Var[参考的 L]",
        "quantity.distance of p from its surface": "p 到它的表面的距离",
        "quantity.distance of q from its lamp": "q 到它的灯的距离",
        "quantity.n . wi on the side it belongs to": "朝所属一侧的 n . wi",
        "quantity.light samples": "光源样本数",
        "quantity.roulette played": "是否用轮盘赌",
    },
}

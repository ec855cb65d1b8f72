"""The picture of `castray bsdf`: lobes, albedo, Fresnel's curves, and samples against their density."""

import numpy as np

from tracer import material_bench as bench
from viewer.plots import COLOURS, GREY

TILTS = (0.0, 30.0, 60.0)
CHANNELS = ("#c1272d", "#3a923a", "#2f5fb3")


def figure(document, material, say):
    """A matplotlib Figure with four plots of a material; document: from bench_bsdf.report."""
    from matplotlib.figure import Figure

    page = Figure(figsize=(11, 8.6), layout="constrained")
    words = ", ".join(f"{w} = {v}" for w, v in document["material"].items() if w != "type")
    page.suptitle(document["material"]["type"] + (f"  ({words})" if words else ""), fontsize=14)
    _lobes(page.add_subplot(2, 2, 1, projection="polar"), material, say)
    _albedo(page.add_subplot(2, 2, 2), material, say)
    curves = bench.fresnel_curves(material)
    if curves:
        values, marks = curves
        conductor = hasattr(getattr(material, "bsdf", material), "k")
        _fresnel(page.add_subplot(2, 2, 3), values, marks, conductor, say)
    _samples(page.add_subplot(2, 2, 4 if curves else (3, 4)), material, say)
    return page


def _lobes(axes, material, say):
    """f |cos| against the angle, each direction's own largest value at the rim; Dirac lobes as arrows."""
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    for tilt, colour in zip(TILTS, COLOURS, strict=False):
        angles, value = bench.lobes(material, tilt, 3601)
        mean = value.mean(axis=0)
        label = say("plot.wo", tilt=f"{tilt:.0f}")
        if mean.max() > 0.0:
            axes.plot(np.radians(angles), mean / mean.max(), color=colour, lw=1.6)
            axes.fill(np.radians(angles), mean / mean.max(), color=colour, alpha=0.12, lw=0)
            label = say("plot.wo_largest", tilt=f"{tilt:.0f}", most=f"{mean.max():.3g}")
        for _, angle, fraction in bench.dirac_lobes(material, tilt):
            axes.annotate(
                "",
                (np.radians(angle), max(float(fraction.mean()) ** 0.5, 0.12)),
                (0.0, 0.0),
                arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0, "shrinkB": 0},
            )
        axes.plot(np.radians([-tilt, -tilt]), [0.0, 1.1], color=colour, lw=1, ls=":", label=label)
    if material.one_sided:
        axes.set_thetamin(-90)
        axes.set_thetamax(90)
    else:
        axes.set_thetagrids(range(0, 360, 45), [f"{a if a <= 180 else a - 360}°" for a in range(0, 360, 45)])
    axes.set_rlim(0, 1.1)
    axes.set_rticks([])
    title = say("plot.lobes")
    axes.set_title(say("plot.arrows", lobes=title) if _has_dirac(material) else title, fontsize=10)
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0.02 if material.one_sided else -0.06),
        fontsize=8,
        ncols=3,
        frameon=False,
    )


def _has_dirac(material):
    return bool(bench.dirac_lobes(material, 30.0))


def _albedo(axes, material, say):
    """Share of light sent back, and on, against the angle, with 4 standard errors."""
    degrees = np.linspace(0.0, 89.0, 30)
    reflected, transmitted, error = bench.albedo(material, degrees, 4000)
    for name, share, style in (("reflected", reflected, "-"), ("transmitted", transmitted, "--")):
        if not share.any():
            continue
        grey = np.ptp(share, axis=0).max() < 1e-9
        for k, colour in enumerate(("black",) if grey else CHANNELS):
            label = say(f"plot.{name}")
            label = label if grey else say(f"plot.{'red green blue'.split()[k]}", share=label)
            axes.plot(degrees, share[k], style, color=colour, label=label)
            low, high = share[k] - 4 * error[k], share[k] + 4 * error[k]
            axes.fill_between(degrees, low, high, color=colour, alpha=0.15, lw=0)
    if transmitted.any():
        axes.plot(
            degrees, (reflected + transmitted).mean(axis=0), color=GREY, lw=1, ls=":", label=say("plot.both")
        )
    _angles(axes, say("plot.albedo"), say)
    axes.set_ylim(0.0, 1.05)
    axes.set_ylabel(say("plot.share"))
    axes.legend(fontsize=8)


def _fresnel(axes, curves, marks, conductor, say):
    """Rs, Rp, their mean and Schlick's approximation against the angle of incidence, from outside."""
    degrees = np.degrees(np.arccos(np.clip(curves["cos"], 0.0, 1.0)))
    axes.plot(degrees, curves["Rs"], color=COLOURS[0], lw=1, label=say("plot.across"))
    axes.plot(degrees, curves["Rp"], color=COLOURS[2], lw=1, label=say("plot.within"))
    axes.plot(degrees, curves["exact"], color="black", lw=1.8, label=say("plot.mean"))
    axes.plot(degrees, curves["schlick"], color=COLOURS[1], lw=1.4, ls="--", label=say("plot.schlick"))
    for name in ("brewster", "critical"):
        if name in marks:
            axes.axvline(marks[name], color=GREY, lw=0.8, ls=":")
            axes.text(
                marks[name] - 1.2,
                0.47,
                say(f"plot.{name}", angle=f"{marks[name]:.1f}"),
                rotation=90,
                fontsize=8,
                ha="right",
                va="center",
                color=GREY,
            )
    _angles(axes, say("plot.fresnel_green" if conductor else "plot.fresnel"), say)
    axes.set_ylim(0.0, 1.05)
    axes.legend(fontsize=8, loc="lower left" if conductor else "upper left")


def _samples(axes, material, say):
    """Samples of three directions against their density, by the angle from the normal."""
    found = [bench.histogram(material, tilt) for tilt in TILTS]
    if material.delta:
        _dirac_shares(axes, found, say)
        return
    for tilt, colour, h in zip(TILTS, COLOURS, found, strict=False):
        width, middle = np.diff(h.edges), 0.5 * (h.edges[1:] + h.edges[:-1])
        label = say("plot.fits", tilt=f"{tilt:.0f}", p=f"{h.p:.2f}")
        for lobe, (share, said) in h.dirac.items():
            told = {
                "share": f"{share:.4f}",
                "said": f"{said:.4f}",
                "lobe": say.optional(f"choice.{lobe}", lobe),
            }
            label += "\n" + say("plot.dirac", **told)
        axes.stairs(h.counted / width, h.edges, fill=True, color=colour, alpha=0.25)
        axes.plot(middle, h.expected / width, ".-", color=colour, lw=1, ms=3.5, label=label)
    tops = [line.get_ydata().max() for line in axes.get_lines()]
    if max(tops) > 0.5:  # lobes of a few degrees: what is beside them shows only so
        axes.set_yscale("log")
        axes.set_ylim(1e-6 * max(tops), 3.0 * max(tops))
    else:
        axes.set_ylim(0.0, (1.5 if found[0].dirac else 1.15) * max(tops))
    axes.legend(fontsize=8)
    axes.set_ylabel(say("plot.per_degree"))
    _angles(axes, say("plot.samples"), say, 90 if material.one_sided else 180)


def _dirac_shares(axes, found, say):
    """Bars of how often each Dirac lobe was chosen, and dots where its probability says."""
    rows = [
        (say("plot.lobe", tilt=f"{tilt:.0f}", lobe=say.optional(f"choice.{lobe}", lobe)), share, said, colour)
        for tilt, colour, h in zip(TILTS, COLOURS, found, strict=False)
        for lobe, (share, said) in h.dirac.items()
    ]
    names, shares, said, colours = zip(*reversed(rows), strict=True)
    axes.barh(names, shares, color=colours, alpha=0.35, label=say("plot.sampled"))
    axes.plot(said, names, "o", color="black", ms=4, label=say("plot.probability"))
    for name, share in zip(names, shares, strict=True):
        axes.text(max(share, 0.0) + 0.015, name, f"{share:.4f}", va="center", fontsize=8)
    axes.set_xlim(0.0, 1.15)
    axes.set_title(say("plot.chosen"), fontsize=10)
    axes.set_xlabel(say("plot.of_samples"))
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, frameon=False)


def _angles(axes, title, say, most=90):
    axes.set_title(title, fontsize=10)
    axes.set_xlim(0, most)
    axes.set_xticks(range(0, most + 1, 15 if most == 90 else 30))
    axes.set_xlabel(say("plot.angle"))
    axes.grid(alpha=0.25)

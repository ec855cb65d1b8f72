"""The picture of `castray bench`: error against run time, log-log, with the slope of independent samples."""

import math

from viewer.plots import COLOURS, GREY

MARKS = "osD^vPX"
STEEPNESS = {"rmse": -0.5, "rel_mse": -1.0}  # exponent of run time in the error of independent samples


def figure(studies, say):
    """A matplotlib Figure, a row a scene: RMSE and relMSE against seconds; medians, with bars from the
    smallest to the largest of the seeds."""
    from matplotlib.figure import Figure

    page = Figure(figsize=(11, 0.8 + 4.2 * len(studies)), layout="constrained")
    for row, study in enumerate(studies):
        for column, what in enumerate(STEEPNESS):
            axes = page.add_subplot(len(studies), 2, 2 * row + column + 1)
            _curves(axes, study, what, say)
            if column == 0:
                handles, labels = axes.get_legend_handles_labels()
                lines = sum(label not in map(study.label, study.curves) for label in labels)
                axes.legend(handles[lines:] + handles[:lines], labels[lines:] + labels[:lines], fontsize=8)
    return page


def _curves(axes, study, what, say):
    axes.set_xscale("log")
    axes.set_yscale("log")
    for k, (one, points) in enumerate(study.curves.items()):
        seen = [p for p in points if getattr(p, what)[0] > 0.0]
        if not seen:
            continue
        middle, low, high = zip(*(getattr(p, what) for p in seen), strict=True)
        below = [m - low_ if low_ > 0.0 else 0.0 for m, low_ in zip(middle, low, strict=True)]
        above = [high_ - m for m, high_ in zip(middle, high, strict=True)]
        axes.errorbar(
            [p.seconds[0] for p in seen],
            middle,
            (below, above),
            color=COLOURS[k % len(COLOURS)],
            marker=MARKS[k % len(MARKS)],
            label=study.label(one),
            lw=1.6,
            ms=5,
            elinewidth=0.9,
            capsize=2,
            zorder=3,
        )
    _slope(axes, what, say)
    _own_error(axes, study.reference, what, say)
    base, spps = study.base, say.listed(*map(str, study.spps))
    said = {"scene": study.scene.name, "width": base.width, "height": base.height, "spps": spps}
    axes.set_title(say("plot.points", **said), fontsize=10)
    axes.set_xlabel(say("plot.processes" if study.workers > 1 else "plot.process", n=study.workers))
    axes.set_ylabel(say(f"plot.{what}"))
    axes.grid(which="both", alpha=0.2)


def _slope(axes, what, say):
    """Lines that fall as the error of N independent samples does, 1 / sqrt(N)."""
    (x0, x1), (y0, y1), s = axes.get_xlim(), axes.get_ylim(), STEEPNESS[what]
    x, middle = (x0 / 1.2, x1 * 1.2), math.sqrt(y0 * y1)
    axes.set_xlim(x)
    axes.set_ylim(y0 / 1.2, y1 * 1.2)
    for k in range(-8, 9):
        start = middle * (x[1] / x[0]) ** (-0.5 * s) * 10.0 ** (0.5 * k)
        label = say("plot.slope") if k == 0 else None
        axes.plot(x, [start, start * (x[1] / x[0]) ** s], color=GREY, lw=0.8, ls=":", zorder=1, label=label)


def _own_error(axes, reference, what, say):
    """Where the reference's own error lies."""
    own = math.sqrt(reference.mse) if what == "rmse" else reference.rel_mse
    if own > 0.0 and own > axes.get_ylim()[0]:
        axes.axhline(own, color=GREY, lw=0.8, label=say("plot.own"))

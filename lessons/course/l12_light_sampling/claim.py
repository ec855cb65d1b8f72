"""A point on a lamp: its density per area and per solid angle, what it brings, what a lost factor does."""

import numpy as np

SPP = 4096
GREEN = 1  # the channel that the text speaks of


def experiment(run):
    """Densities, contributions and spreads at one point of the green wall."""
    e = run.event("start")
    area, r, cos_light = 1.0 / e["pdf_area"], e["distance"], e["cos_light"]
    pdf = e["pdf_area"] * r * r / cos_light
    assert np.isclose(pdf, e["pdf"], rtol=1e-5)

    brings = e["f"][GREEN] * e["Le"][GREEN] * e["cos"] * cos_light / (r * r * e["pdf_area"])
    assert np.isclose(brings, e["contribution"][GREEN], rtol=1e-5)

    # "more than twice as far", "sixty lamps"
    assert (
        2.0 * r < run.event("floor")["distance"] < 3.0 * r and len(run.scene("many_lights").light_names) == 60
    )

    by_area, by_angle = (run.wave(m, spp=SPP).radiance[GREEN].astype(float) for m in ("start", "angle"))
    error = np.hypot(by_area.std(), by_angle.std()) / np.sqrt(SPP)
    assert abs(by_area.mean() - by_angle.mean()) < 5.0 * error
    assert by_angle.std() < by_area.std()

    assert np.isclose(run.event("mistake")["contribution"][GREEN], r * brings, rtol=1e-5)
    return {
        "area": area,
        "share": cos_light * area / (r * r),
        "spread_area": by_area.std() / by_area.mean(),
        "spread_angle": by_angle.std() / by_angle.mean(),
        "times": (by_area.std() / by_angle.std()) ** 2,
        "as_area": e["f"][GREEN] * e["Le"][GREEN] * e["cos"] / e["pdf_area"],
        "half": pdf / 4.0,
        "halved_once": pdf / 2.0,
        "same": pdf,
        "nearer_is_more": pdf * 4.0,
    }


def behind_the_lamp(run, x, y):
    """Whether all light samples of a pixel see the lamp from behind."""
    prepared = run.scene().at(run.settings())
    events = [e for path in run.pixel(x, y).paths for e in path.events if e.kind.name == "light"]
    return bool(events) and all(e.as_dict(prepared)["cos_light"] < 0.0 for e in events)

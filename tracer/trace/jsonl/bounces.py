"""The bounces of calls, and the throughput that they leave."""

import numpy as np

from tracer.events import LOBES
from tracer.frame import dot
from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.stages import Stages

_SAME = 256.0  # machine epsilons by which two ways to one factor may differ


class Bounces(Stages):
    """What is known of each bounce."""

    def _bounce(self):
        rows = self.rows["bounce"]
        said = lambda name, otherwise=None: self._said("bounce", name, otherwise)  # noqa: E731
        vertex, wi = self.places.vertex(rows), self.wi[:, rows]
        primitive = np.maximum(vertex["primitive"], 0)
        material = self.scene.bsdf_of.take(primitive)
        delta = said("delta", lambda: self.scene.bsdf.is_delta(material))
        see_through = np.array([bsdf.see_through for bsdf in self.scene.definition.bsdfs.values()])
        through = see_through.take(material) & (dot(vertex["n"], wi) * dot(vertex["n"], vertex["wo"]) < 0.0)
        other = np.where(delta.astype(bool), LOBES.index("reflection"), LOBES.index("diffuse"))
        found = {
            "lobe": said("lobe", lambda: np.where(through, LOBES.index("transmission"), other)),
            "wi": wi,
            "cos": said("cos", lambda: np.abs(dot(vertex["n"], wi))),
            "f": said("f", lambda: geometry.ask(self.scene, "eval", vertex, wi)),
            "pdf": said(
                "pdf", (lambda: geometry.ask(self.scene, "pdf", vertex, wi)) if self.sampler_known else None
            ),
            "delta": delta,
            "u": said("u"),
        }
        if not self.chain.given("bounce.wi").any():
            self.rebuilt.add("bounce.wi")
        return found

    def _throughputs(self, bounce):
        """Throughput (3, N) at each call, after its bounce, and after roulette.

        What a call multiplied the inner one's radiance with is indirect / returned where both are logged,
        else f cos / (pdf q). Where that ratio is f cos / pdf alone, roulette was not paid for; any other
        difference is the bounce's.
        """
        size, rows = self.chain.path.size, self.rows["bounce"]
        ratio = np.full((3, size), np.nan)
        if self.chain.given("indirect").any() and self.chain.given("returned").any():
            inner = np.roll(self.chain("returned"), -1, axis=1)
            inner[:, self.chain.last] = np.nan
            with np.errstate(all="ignore"):
                ratio = np.where(inner > 0.0, self.chain("indirect") / inner, np.nan)
            ratio[~np.isfinite(ratio)] = np.nan
        made = np.full((3, size), np.nan)
        cos, pdf = np.where(bounce["delta"].astype(bool), 1.0, bounce["cos"]), bounce["pdf"]
        if pdf is None:  # counts only where nothing came back, so that nothing depends on it
            pdf = geometry.ask(self.scene, "pdf", self.places.vertex(rows), bounce["wi"])
        with np.errstate(all="ignore"):
            made[:, rows] = bounce["f"] * cos / pdf
        if bounce["pdf"] is None:
            made = np.nan_to_num(made, nan=0.0, posinf=0.0)
        elif "bounce.pdf" in self.rebuilt:  # a mirror's are not to be asked for
            mirrors = rows[bounce["delta"].astype(bool)]
            made[:, mirrors] = np.where(np.isfinite(made[:, mirrors]), made[:, mirrors], 1.0)
        q = np.where(np.isfinite(self.q) & self.bounced, self.q, 1.0)
        known = np.isfinite(ratio)
        with np.errstate(all="ignore"):
            same = np.abs(ratio - made) <= _SAME * self.eps * made
            unpaid = (~known | same).all(axis=0) & known.any(axis=0)
            unpaid &= np.abs(q - 1.0) > _SAME * self.eps
            of_roulette = np.where(unpaid, 1.0, 1.0 / q)
            of_bounce = np.where(known, ratio / of_roulette, made)
        if "bounce.cos" in self.rebuilt:
            with np.errstate(all="ignore"):
                ratio = of_bounce[:, rows] / made[:, rows]
            self._as_near_as_directions_say(bounce, ratio)
        self.rebuilt |= {"bounce.beta", "roulette.beta", "hit.beta", "light.beta", "bounce.beta_before"}
        return self._multiplied(of_bounce, of_roulette)

    def _as_near_as_directions_say(self, bounce, ratio):
        """The same for a cosine that was worked out from two directions: it is what the logged terms have, if
        that lies within what the directions say."""
        with np.errstate(all="ignore"):
            implied = bounce["cos"] * ratio.max(axis=0)
            near = np.abs(implied - bounce["cos"]) <= 16.0 * self.eps
        bounce["cos"] = np.where(near, implied, bounce["cos"])

    def _multiplied(self, of_bounce, of_roulette):
        size = self.chain.path.size
        beta, after_bounce, after = (np.ones((3, size)) for _ in range(3))
        order = np.argsort(self.chain.level, kind="stable")
        begins = np.searchsorted(self.chain.level[order], np.arange(self.chain.level.max(initial=0) + 2))
        with np.errstate(all="ignore"):
            for begin, end in zip(begins[:-1], begins[1:], strict=True):
                rows = order[begin:end]
                after_bounce[:, rows] = beta[:, rows] * np.where(self.bounced[rows], of_bounce[:, rows], 1.0)
                after[:, rows] = after_bounce[:, rows] * np.where(self.played[rows], of_roulette[rows], 1.0)
                on = rows[~self.chain.last[rows]]
                beta[:, on + 1] = after[:, on]
        return beta, after_bounce, after

"""What calls of a recursive function say, as the events that castray's own loop would have yielded."""

import numpy as np

from tracer.events import CAMERA, END_REASONS, KINDS
from tracer.frame import dot, length
from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.bounces import Bounces
from tracer.trace.jsonl.lights import Lights

_END = {name: number for number, name in enumerate(END_REASONS)}
TERMS = ("emission", "direct", "indirect", "returned")


class Telling(Lights, Bounces):
    """Makes tables of events of calls."""

    def tables(self):
        """Name of a kind -> Table, made one after the other to hold little at once."""
        bounce, light = self._bounce(), self._light()
        beta, after_bounce, after = self._throughputs(bounce)
        columns = {
            "camera": self._camera,
            "hit": lambda: self._hit(beta),
            "light": lambda: self._lit_up(light, beta),
            "bounce": lambda: self._bounced(bounce, beta, after_bounce),
            "roulette": lambda: self._roulette(after),
            "escape": lambda: self._escaped(beta),
            "end": self._end,
        }
        return {kind.name: self._table(kind.name, columns[kind.name]()) for kind in KINDS}

    def _camera(self):
        rows = self.rows["camera"]
        if not self.chain.given("ray.o").any():
            self.rebuilt |= {"camera.o", "camera.d"}
        size = rows.size
        film = None
        if not self.settings.jitter and all(name in self.chain.columns.values for name in ("x", "y")):
            film = np.stack([self.chain.columns.values[name][rows] + 0.5 for name in ("x", "y")])
            self.rebuilt.add(f"{CAMERA.name}.film")
        return {
            "film": film,
            "o": self.places.o[:, rows],
            "d": self.places.d[:, rows],
            "beta": np.ones((3, size)),
        }

    def _own(self):
        """Emission that each call adds, (3, N): as logged; what one without other terms returned; else 0."""
        chain = self.chain
        if not any(chain.given(name).any() for name in ("direct", "indirect", "emission")):
            return None  # of the sum that was returned nothing can be told apart
        own = np.zeros((3, chain.path.size))
        if chain.given("returned").any():
            alone = chain.given("returned") & chain.last & ~chain.given("direct") & ~chain.given("indirect")
            np.copyto(own, chain("returned"), where=alone & ~self.lost)
        if chain.given("emission").any():
            np.copyto(own, chain("emission"), where=chain.given("emission"))
        return own

    def _hit(self, beta):
        rows, places = self.rows["hit"], self.places
        primitive, wo = places.primitive[rows], places.wo[:, rows]
        ng = places.ng[:, rows]
        found = {name: getattr(places, name)[..., rows] for name in ("p", "n", "ng", "wo", "primitive")}
        for name in found:
            if not self.chain.given(f"hit.{name}").any():
                self.rebuilt.add(f"hit.{name}")
        real, _ = geometry.surfaces(self.scene, found["p"], places.d[:, rows], primitive)
        front = dot(real, wo) > 0.0
        found["t"] = self._said("hit", "t", lambda: length(found["p"] - places.o[:, rows]))
        found["front"] = self._said("hit", "front", lambda: dot(ng, wo) > 0.0)
        found["Le"] = Le = self._said("hit", "Le", lambda: self._radiance(primitive, front))
        if not np.isfinite(beta).all() and not self.chain.given("bounce.pdf").any():
            beta = None
        found["beta"] = None if beta is None else beta[:, rows]
        found |= self._weighed(rows, Le, beta)
        before = np.maximum(rows - 1, 0)
        if self.chain.given("bounce.pdf").any():
            delta = self.scene.bsdf.is_delta(self.scene.bsdf_of.take(np.maximum(places.primitive[before], 0)))
            pdf = np.where((self.chain.level[rows] == 0) | delta, np.inf, self.chain("bounce.pdf")[before])
            found["pdf_bsdf"] = self._said("hit", "pdf_bsdf", lambda: pdf)
        found["pdf_light"] = self._said("hit", "pdf_light", lambda: self._found_by_light(rows, Le, front))
        for name in TERMS:
            if self._all_given(name, rows):
                found[name] = self.chain(name)[:, rows]
        return found

    def _weighed(self, rows, Le, beta):
        own = self._own()
        if own is None:
            return {"w": self._said("hit", "w")}
        own = own[:, rows]
        shining = Le.max(axis=0) > 0.0
        with np.errstate(all="ignore"):
            share = own.max(axis=0) / Le.max(axis=0)
            w = self._said("hit", "w", lambda: np.where(shining, share, 1.0), of_log=True)
            return {"w": w, "contribution": None if beta is None else beta[:, rows] * own}

    def _found_by_light(self, rows, Le, front):
        """Density with which a light sample at the vertex before gives each lamp that is met, 0 elsewhere."""
        primitive = self.places.primitive[rows]
        pdf = np.zeros(rows.size)
        lamp = (self.scene.light_of.take(np.maximum(primitive, 0)) >= 0) & (primitive >= 0) & front
        lit = np.flatnonzero(lamp)
        if lit.size:
            p, o = self.places.p[:, rows[lit]], self.places.o[:, rows[lit]]
            ng, _ = geometry.surfaces(self.scene, p, self.places.d[:, rows[lit]], primitive[lit])
            density = self.scene.lights.area.pdf(primitive[lit], o, p, ng)
            pdf[lit] = self._as_chosen(density, self.scene.light_of.take(primitive[lit]))
        return pdf

    def _as_chosen(self, density, light):
        """Densities (N,) of light samples, with the logged probabilities of the lights (N,)."""
        return density if self.picks is None else density * (self.picks / self.scene.lights.pick)[light]

    def _bounced(self, bounce, beta, after):
        rows = self.rows["bounce"]
        return bounce | {"beta_before": beta[:, rows], "beta": after[:, rows]}

    def _roulette(self, after):
        rows = self.rows["roulette"]
        if not self.chain.given("roulette.survived").any():
            self.rebuilt.add("roulette.survived")
        return {
            "probability": self.q[rows],
            "u": self._said("roulette", "u"),
            "survived": self.bounced[rows] if self.ends_known else None,
            "beta": after[:, rows],
        }

    def _escaped(self, beta):
        rows = self.rows["escape"]
        own = self._own()
        d = self.places.d[:, rows]
        around = self.scene.environment(d) if rows.size else None
        Le = around[0] if around is not None else np.zeros(d.shape)
        shining = Le.max(axis=0) > 0.0
        pdf = np.zeros(rows.size)
        if around is not None:
            pdf = self._as_chosen(around[1], self.scene.lights.surrounding)
        found = {"d": d, "Le": Le, "pdf_light": pdf}
        if own is None:
            return found
        with np.errstate(all="ignore"):
            found["w"] = np.where(shining, own[:, rows].max(axis=0) / Le.max(axis=0), 1.0)
            found["contribution"] = beta[:, rows] * own[:, rows]
        return found

    def _end(self):
        rows = self.rows["end"]
        reason = np.full(rows.size, -1)
        reason[~self.places.hit[rows]] = _END["escaped"]
        reason[self.places.hit[rows] & self.dark[rows]] = _END["black"]
        reason[self.lost[rows]] = _END["roulette"]
        open_ = np.flatnonzero(reason < 0)
        level = self.chain.level[rows]
        if open_.size and (level[open_] == level.max()).all() and (self.roulette_known or level.max() > 0):
            reason[open_] = _END["max_depth"]
        elif open_.size and self.roulette_known and self.ends_known:
            reason[open_] = _END["absorbed"]
        self.rebuilt.add("end.reason")
        found = {"reason": reason if (reason >= 0).all() else None, "radiance": None}
        root = self.rows["camera"]
        if self._all_given("returned", root):
            found["radiance"] = self.chain("returned")[:, root]
        return found

"""The light samples of calls."""

import numpy as np

from tracer.events import TECHNIQUES
from tracer.frame import dot, length, normalize
from tracer.integrator.steps import mis_weight
from tracer.light import choice
from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.stages import Stages


class Lights(Stages):
    """What is known of each light sample."""

    def _light(self):
        """Columns of light samples but for throughput and contribution."""
        rows = self.rows["light"]
        found = {
            name: self._of_light(name) for name in ("u", "transmittance", "q", "f", "Le", "wi", "visible")
        }
        if found["q"] is not None:
            self._pointed(found, rows)
        found["pick"] = found.get("pick", self._of_light("pick"))
        self.picks = self._picks(found)
        wi = found["wi"]
        if wi is not None:
            vertex = self.places.vertex(rows)
            found["cos"] = self._of_light("cos", lambda: np.abs(dot(vertex["n"], wi)))
            found["f"] = self._of_light("f", lambda: geometry.ask(self.scene, "eval", vertex, wi))
        found["pdf_bsdf"] = self._of_light("pdf_bsdf", self._counting(lambda: self._bounced_there(rows, wi)))
        only = self.settings.integrator == "direct" or self.settings.strategy == "light"
        weights = (lambda: np.ones(rows.size)) if only else self._counting(lambda: self._balanced(found), "w")
        found["w"] = self._of_light("w", weights)
        by_area = self.chain.given("light.pdf_area").any() or self.settings.light_sampling == "area"
        way = TECHNIQUES.index("area" if by_area else "solid_angle")
        found["technique"] = self._of_light("technique", lambda: np.full(rows.size, way))
        if self._all_given("direct", rows):
            direct = self.chain("direct")[:, rows]
            found["visible"] = self._of_light("visible", lambda: (direct != 0.0).any(axis=0), True)
            self._as_near_as_points_say(found, direct, rows)
        self._beneath(found, rows)
        return found

    def _of_light(self, name, *otherwise):
        return self._said("light", name, *otherwise)

    def _counting(self, otherwise, name="pdf_bsdf"):
        """otherwise, for a number that is logged only where light arrives, as many programs work it out there
        alone; None where it is not logged at all, or not where it counts."""
        rows = self.rows["light"]
        given = self.chain.given(f"light.{name}")[rows]
        if not given.any() or not self._all_given("direct", rows):
            return None
        return None if (self.chain("direct")[:, rows] != 0.0)[:, ~given].any() else otherwise

    def _bounced_there(self, rows, wi):
        """Density with which a bounce would have gone to each light point, (K,)."""
        return None if wi is None else geometry.ask(self.scene, "pdf", self.places.vertex(rows), wi)

    def _balanced(self, found):
        """The weight (K,) of each light sample; None where a density is not known."""
        pdf, other = found.get("pdf"), found["pdf_bsdf"]
        if pdf is None or other is None:
            return None
        with np.errstate(all="ignore"):
            return mis_weight(self.settings, pdf, other)

    def _pointed(self, found, rows):
        """Add what follows from the point on the light: where it lies, its radiance and its density."""
        said, q, p = self._of_light, found["q"], self.places.p[:, rows]
        gap = q - p
        found["wi"] = said("wi", lambda: normalize(gap))
        found["distance"] = said("distance", lambda: length(gap))
        primitive = self._lamps(q, found["wi"])
        found["primitive"] = said("primitive", lambda: primitive)
        primitive = found["primitive"].astype(np.intp)
        found["light"] = said("light", lambda: np.maximum(self.scene.light_of.take(primitive), 0))
        ng, _ = geometry.surfaces(self.scene, q, found["wi"], primitive)
        found["nq"] = nq = said("nq", lambda: ng)
        front = (-dot(ng, found["wi"]) > 0.0) | self._edge_on(q, p, ng, rows)
        found["Le"] = said("Le", lambda: self._radiance(primitive, front)) * front
        by_area = bool(self.chain.given("light.pdf_area")[rows].all())
        found["pdf"] = said("pdf", lambda: self._density(found, p, ng), by_area)
        found["cos_light"] = said("cos_light", lambda: -dot(nq, found["wi"]))
        if len(self.scene.light_names) == 1:
            found["pick"] = said("pick", lambda: np.ones(rows.size))

    def _picks(self, found):
        """The probability of each light (L,), as it is logged; None where it is castray's own, or none."""
        light, pick = found.get("light"), found["pick"]
        if pick is None or light is None or not self.scene.has_lights:
            return None
        return choice.said(light.astype(np.intp), pick, self.scene.lights.pick.astype(np.float64), self.eps)

    def _off(self):
        """How far each coordinate of a logged point may be off by its printing."""
        return self.eps * max(geometry.scale(self.scene), float(np.abs(self.scene.camera.origin).max()))

    def _edge_on(self, q, p, nq, rows):
        """Where a vertex lies in the lamp's plane as far as points say, and the logged term is not 0, (K,):
        there only the program knew on which side it was."""
        if not self._all_given("direct", rows):
            return np.zeros(rows.size, bool)
        something = (self.chain("direct")[:, rows] != 0.0).any(axis=0)
        return something & (np.abs(dot(nq, q - p)) <= 4.0 * self._off())

    def _as_near_as_points_say(self, found, direct, rows):
        """A density, or a cosine, that was worked out from two points is as uncertain as they are, which is
        much where one lies near the plane of the other's surface. Within that it is the logged term's."""
        parts = ("f", "Le", "cos", "w", "pdf", "visible", "q", "wi", "nq")
        if "light.pdf" not in self.rebuilt or any(found.get(name) is None for name in parts):
            return
        gap = found["q"] - self.places.p[:, rows]
        height, above = (np.abs(dot(n, gap)) for n in (found["nq"], self.places.n[:, rows]))
        off = 32.0 * self._off()
        with np.errstate(all="ignore"):
            term = found["f"] * found["Le"] * found["cos"] * found["w"] * found["visible"]
            implied = term.max(axis=0) / direct.max(axis=0)
            ratio = np.where(np.isfinite(implied), implied / found["pdf"], np.nan)
            apart = np.where(np.isnan(ratio), np.inf, np.abs(ratio - 1.0))
            near = np.isfinite(implied) & ((apart <= 2.0 * off / height) | (height <= off / 8.0))
            low = ~near & (apart <= 2.0 * off / above) & ("light.cos" in self.rebuilt)
            found["pdf"] = np.where(near, implied, found["pdf"])
            found["cos"] = np.where(low, found["cos"] / ratio, found["cos"])

    def _beneath(self, found, rows):
        """Below the horizon the cosine is its size, and where nothing could arrive nothing is seen: others
        log a cosine of 0 there, and shadow rays that count for nothing."""
        if any(found.get(name) is None for name in ("wi", "cos", "f")):
            return
        along = dot(self.places.n[:, rows], found["wi"])
        found["cos"] = np.where((along <= 0.0) & (found["cos"] <= 0.0), np.abs(along), found["cos"])
        self._f_that_counts_for_nothing(found, rows, along)
        if found.get("visible") is not None and found.get("Le") is not None:
            could = (found["f"] * found["Le"]).any(axis=0) & (found["cos"] > 0.0)
            found["visible"] = np.where(could, found["visible"], 0.0)

    def _f_that_counts_for_nothing(self, found, rows, along):
        """Below the horizon many programs still have albedo / pi at hand, which they do not use."""
        if not self._all_given("direct", rows) or not self.chain.given("light.f").any():
            return
        idle = np.flatnonzero((along <= 0.0) & (self.chain("direct")[:, rows] == 0.0).all(axis=0))
        vertex = self.places.vertex(rows[idle])
        found["f"][:, idle] = geometry.ask(self.scene, "eval", vertex, found["wi"][:, idle])

    def _lamps(self, q, wi):
        """The lamp's primitive (K,) that each light point lies on."""
        shining = np.flatnonzero(self.scene.light_of >= 0)
        if not shining.size:
            return np.full(q.shape[1], -1)
        if shining.size == 1:
            return np.full(q.shape[1], shining[0])
        reach = 0.1 * geometry.NEAR * geometry.scale(self.scene)
        t, primitive = geometry.met(self.scene, q - reach * wi, wi)
        shines = lambda of: (of >= 0) & (self.scene.light_of.take(np.maximum(of, 0)) >= 0)  # noqa: E731
        found = np.where((np.abs(t - reach) < reach) & shines(primitive), primitive, -1)
        rest = np.flatnonzero(found < 0)  # at a lamp's edge, or along it
        if rest.size:
            o, d = q[:, rest] - wi[:, rest], wi[:, rest]
            other = geometry.primitives_at(self.scene, o, d, q[:, rest])
            found[rest] = np.where(shines(other), other, -1)
        return np.where(found >= 0, found, shining[0])

    def _radiance(self, primitive, front):
        area = self.scene.lights.area if self.scene.lights is not None else None
        if area is None:
            return np.zeros((3, primitive.size))
        light = self.scene.light_of.take(np.maximum(primitive, 0))
        lit = (light >= 0) & front & (primitive >= 0)
        return np.where(lit, area.radiance.take(np.maximum(light, 0), axis=1, mode="clip"), 0.0)

    def _density(self, found, p, ng):
        """Density of light samples per solid angle, of that per area where it was logged."""
        rows = self.rows["light"]
        given = self.chain.given("light.pdf_area")[rows]
        cos = -dot(ng, found["wi"])
        with np.errstate(all="ignore"):
            if given.all():
                gap = found["q"] - p
                said = self.chain.given("light.cos_light")[rows]
                over = np.where(said, self.chain("light.cos_light")[rows], cos) if said.any() else cos
                over = np.where(over > 0.0, over, cos)
                pdf = self.chain("light.pdf_area")[rows] * dot(gap, gap) / over
                if self.chain.given("light.pick")[rows].all():
                    pdf = pdf * self.chain("light.pick")[rows]
                return np.where(cos > 0.0, pdf, 0.0)
            primitive = found["primitive"].astype(np.intp)
            if (primitive < 0).any():
                return None
            pdf = self.scene.lights.area.pdf(primitive, p, found["q"], ng)
        return np.where(cos > 0.0, pdf, 0.0)

    def _lit_up(self, light, beta):
        rows = self.rows["light"]
        light["beta"] = None if beta is None else beta[:, rows]
        if self._all_given("direct", rows):
            with np.errstate(all="ignore"):
                light["contribution"] = beta[:, rows] * self.chain("direct")[:, rows]
        elif all(light.get(name) is not None for name in ("f", "Le", "cos", "pdf", "w", "visible")):
            term = light["f"] * light["Le"] * light["cos"] * light["w"] * light["visible"]
            with np.errstate(all="ignore"):
                light["contribution"] = beta[:, rows] * np.where(light["pdf"] > 0.0, term / light["pdf"], 0.0)
            self.rebuilt.add("light.contribution")
            self.assumed.add("light.contribution")
        return light

"""What calls of a recursive function say, as the events that castray's own loop would have yielded."""

from dataclasses import dataclass, replace

import numpy as np

from tracer.events import CAMERA, END_REASONS, KINDS, LOBES, TECHNIQUES
from tracer.frame import dot, length, normalize
from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.calls import Places
from tracer.trace.jsonl.lines import Columns
from tracer.trace.trace import Table

_SAME = 256.0  # machine epsilons by which two ways to one factor may differ
_END = {name: number for number, name in enumerate(END_REASONS)}
TERMS = ("emission", "direct", "indirect", "returned")


def peeked(chain, places, scene):
    """Chain and Places with a call more where a path went on towards a lamp, or out of the scene, and the
    program looked there before it called itself again: that call would have returned nothing."""
    at = np.flatnonzero(chain.last & places.hit & chain.given("bounce.wi") & _survived(chain))
    if not at.size:
        return chain, places
    wi = chain("bounce.wi")[:, at]
    o = places.p[:, at]
    t, primitive = geometry.onward(scene, o, wi)
    out = primitive < 0
    lamp = ~out & (scene.light_of.take(np.maximum(primitive, 0)) >= 0)
    fits = out | lamp
    if fits.mean() < 0.9:  # then they end for another reason
        return chain, places
    out |= ~lamp  # by the program's own account nothing was met there
    p = o + np.where(out, 0.0, t) * wi
    primitive = np.where(out, -1, primitive)
    ng, n = geometry.surfaces(scene, p, wi, primitive)
    more = Places(places.p[:, at], wi, ~out, p, -wi, n, ng, primitive, np.zeros(at.size, bool))
    path, level = np.r_[chain.path, chain.path[at]], np.r_[chain.level, chain.level[at] + 1]
    order = np.lexsort((level, path))
    columns = _longer(chain.columns, at).take(order)
    path, level = path[order], level[order]
    last = np.ones(path.size, bool)
    last[:-1] = path[1:] != path[:-1]
    joined = Places(*(np.concatenate(pair, axis=-1)[..., order] for pair in zip(
        vars(places).values(), vars(more).values(), strict=True)))  # fmt: skip
    note = f"{at.size} paths look at what they meet next without a call: taken as calls that return nothing"
    return replace(chain, columns=columns, path=path, level=level, last=last, notes=[*chain.notes, note]), joined


def _survived(chain):
    said = chain.given("roulette.survived")
    return ~said | (chain.columns.values["roulette.survived"] == 1) if said.any() else np.ones(said.size, bool)


def _longer(columns, at):
    """Columns with lines at the end that return nothing, in the place of those after lines `at`."""
    values, given = {}, {}
    for name, column in columns.values.items():
        more = np.zeros((*column.shape[:-1], at.size), column.dtype)
        kept = name in ("path", "x", "y", "sample")
        if kept:
            more = column[..., at]
        values[name] = np.concatenate((column, more), axis=-1)
        given[name] = np.r_[columns.given[name], columns.given[name][at] & (kept or name == "returned")]
    return Columns(np.r_[columns.line, columns.line[at]], values, given)


@dataclass
class Telling:
    """Makes tables of events of calls. rebuilt: places "kind.field" that were not logged."""

    chain: object
    places: Places
    scene: object  # of 64 bits
    settings: object
    eps: float
    roulette_known: bool
    sampler_known: bool  # whether it was declared, or told from the numbers, how surfaces choose directions

    def __post_init__(self):
        chain, places = self.chain, self.places
        self.rebuilt = set()
        self.vertex = places.vertex(slice(None))
        self.dark = geometry.dark(self.scene, self.vertex)
        self.q = self._probability()
        worked = chain.any("light.") | chain.any("roulette.") | chain.given("direct")
        if not worked.any():
            worked = places.hit
        told_lost = np.zeros(chain.path.size, bool)
        if chain.given("roulette.survived").any():
            told_lost = chain.given("roulette.survived") & (chain.columns.values["roulette.survived"] == 0)
        bounced = ~chain.last | (chain.any("bounce.") & ~told_lost)
        guessed = chain.last & places.hit & ~self.dark & worked & np.isfinite(self.q)
        if chain.given("roulette.survived").any():
            guessed &= ~chain.given("roulette.survived")
        self.lost = (told_lost & chain.last) | guessed
        self.bounced = bounced & ~self.lost & places.hit
        self.played = np.isfinite(self.q) & (self.bounced | self.lost)
        self.lit = chain.any("light.") | (chain.given("direct") & places.hit)
        self.wi = self._directions()
        self._place_steps()

    def _probability(self):
        """Chance to go on at each call, (N,); NaN where none is known."""
        chain = self.chain
        q = np.full(chain.path.size, np.nan)
        try:
            q[:] = float(self.settings.roulette)
        except ValueError:
            pass
        if chain.given("roulette.probability").any():
            np.copyto(q, chain("roulette.probability"), where=chain.given("roulette.probability"))
        else:
            self.rebuilt.add("roulette.probability")
        return q

    def _directions(self):
        """Where each call went on, (3, N)."""
        wi = np.roll(self.places.d, -1, axis=1)
        given = self.chain.given("bounce.wi")
        if given.any():
            np.copyto(wi, self.chain("bounce.wi"), where=given)
        return wi

    def _place_steps(self):
        root = self.chain.level == 0
        parts = (root, np.ones_like(root), self.lit, self.bounced, self.played, self.chain.last)
        each = np.cumsum(np.array(parts, np.int64), axis=0)
        total = np.cumsum(each[-1])
        begin = np.repeat((total - each[-1])[root], np.bincount(self.chain.path))
        before = total - each[-1] - begin
        names = ("camera", "hit", "light", "bounce", "roulette", "end")
        self.steps = {name: before + each[k] - 1 for k, name in enumerate(names)}
        self.steps["escape"] = self.steps["hit"]
        self.rows = {name: np.flatnonzero(part) for name, part in zip(names, parts, strict=True)}
        self.rows["hit"] = np.flatnonzero(self.places.hit)
        self.rows["escape"] = np.flatnonzero(~self.places.hit)

    def _table(self, kind, columns):
        rows = self.rows[kind]
        depth = self.chain.level.copy()
        if self.chain.given("depth").any():
            np.copyto(depth, self.chain.columns.values["depth"], where=self.chain.given("depth"))
        kept = {name: column for name, column in columns.items() if column is not None}
        return Table(self.chain.path[rows], self.steps[kind][rows], depth[rows], kept)

    def _said(self, kind, name, otherwise=None):
        """A column of an event of a kind: as logged, where it is not as `otherwise` (made when needed) has it;
        None where neither is known."""
        rows, key = self.rows[kind], f"{kind}.{name}"
        given = self.chain.given(key)[rows]
        column = self.chain(key)[..., rows] if given.any() else None
        if column is not None and given.all():
            return column
        rest = otherwise() if otherwise is not None else None
        if rest is None:
            return None
        if column is None or np.count_nonzero(given) < 0.5 * given.size:
            self.rebuilt.add(key)
        if column is None:
            return rest
        np.copyto(column, rest, where=~given)
        return column

    def tables(self):
        """Name of a kind -> Table, and the radiance (3, P) that paths returned, None if not logged."""
        light = self._light()
        bounce = self._bounce()
        beta, after_bounce, after = self._throughputs(bounce)
        self.beta = beta
        found = {
            "camera": self._camera(),
            "hit": self._hit(beta),
            "light": self._lit_up(light, beta),
            "bounce": self._bounced(bounce, beta, after_bounce),
            "roulette": self._roulette(after),
            "escape": self._escaped(beta),
            "end": self._end(),
        }
        return {kind.name: self._table(kind.name, found[kind.name]) for kind in KINDS}

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
            "film": film, "o": self.places.o[:, rows], "d": self.places.d[:, rows], "beta": np.ones((3, size)),
        }  # fmt: skip

    def _light(self):
        """Columns of light samples but for throughput and contribution."""
        rows = self.rows["light"]
        said = lambda name, otherwise=None: self._said("light", name, otherwise)  # noqa: E731
        found = {name: said(name) for name in ("u", "transmittance")}
        q, p = said("q"), self.places.p[:, rows]
        found |= {"q": q, "f": said("f"), "Le": said("Le"), "wi": said("wi"), "visible": said("visible")}
        if q is not None:
            gap = q - p
            found["wi"] = said("wi", lambda: normalize(gap))
            found["distance"] = said("distance", lambda: length(gap))
            primitive = self._lamps(q, found["wi"])
            found["primitive"] = said("primitive", lambda: primitive)
            primitive = found["primitive"].astype(np.intp)
            found["light"] = said("light", lambda: np.maximum(self.scene.light_of.take(primitive), 0))
            ng, _ = geometry.surfaces(self.scene, q, found["wi"], primitive)
            found["nq"] = nq = said("nq", lambda: ng)
            front = -dot(ng, found["wi"]) > 0.0
            found["Le"] = said("Le", lambda: self._radiance(primitive, front)) * front
            found["pdf"] = said("pdf", lambda: self._density(found, p, ng))
            found["cos_light"] = said("cos_light", lambda: -dot(nq, found["wi"]))
            if len(self.scene.light_names) == 1:
                found["pick"] = said("pick", lambda: np.ones(rows.size))
        found["pick"] = found.get("pick", said("pick"))
        wi = found["wi"]
        if wi is not None:
            vertex = self.places.vertex(rows)
            found["cos"] = said("cos", lambda: np.abs(dot(vertex["n"], wi)))
            found["f"] = said("f", lambda: geometry.ask(self.scene, "eval", vertex, wi))
        found["pdf_bsdf"] = said("pdf_bsdf")
        only = self.settings.integrator == "direct" or self.settings.strategy == "light"
        found["w"] = said("w", (lambda: np.ones(rows.size)) if only else None)
        by_area = self.chain.given("light.pdf_area").any() or self.settings.light_sampling == "area"
        way = TECHNIQUES.index("area" if by_area else "solid_angle")
        found["technique"] = said("technique", lambda: np.full(rows.size, way))
        if self._all_given("direct", rows):
            direct = self.chain("direct")[:, rows]
            found["visible"] = said("visible", lambda: (direct != 0.0).any(axis=0))
            self._as_near_as_points_say(found, direct, rows)
        self._beneath(found, rows)
        return found

    def _all_given(self, name, rows):
        return rows.size > 0 and bool(self.chain.given(name)[rows].all())

    def _as_near_as_points_say(self, found, direct, rows):
        """A density that was worked out from two points is as uncertain as they are, which is much where one
        lies near the plane of the other's surface. Within that it is the one that the logged term has."""
        parts = ("f", "Le", "cos", "w", "pdf", "visible", "q", "wi", "nq")
        if "light.pdf" not in self.rebuilt or any(found.get(name) is None for name in parts):
            return
        off = 32.0 * self.eps * max(geometry.scale(self.scene), float(np.abs(self.scene.camera.origin).max()))
        height = np.abs(dot(found["nq"], found["q"] - self.places.p[:, rows]))
        if "light.cos" in self.rebuilt:
            height = np.minimum(height, np.abs(dot(self.places.n[:, rows], found["q"] - self.places.p[:, rows])))
        with np.errstate(all="ignore"):
            term = found["f"] * found["Le"] * found["cos"] * found["w"] * found["visible"]
            implied = term.max(axis=0) / direct.max(axis=0)
            near = np.abs(implied / found["pdf"] - 1.0) <= 2.0 * off / height
        found["pdf"] = np.where(near & np.isfinite(implied), implied, found["pdf"])

    def _beneath(self, found, rows):
        """Below the horizon the cosine is its size, and where nothing could arrive nothing is seen: others log
        a cosine of 0 there, and shadow rays that count for nothing."""
        if any(found.get(name) is None for name in ("wi", "cos", "f")):
            return
        along = dot(self.places.n[:, rows], found["wi"])
        found["cos"] = np.where((along <= 0.0) & (found["cos"] <= 0.0), np.abs(along), found["cos"])
        if found.get("visible") is not None and found.get("Le") is not None:
            could = (found["f"] * found["Le"]).any(axis=0) & (found["cos"] > 0.0)
            found["visible"] = np.where(could, found["visible"], 0.0)

    def _lamps(self, q, wi):
        """The lamp's primitive (K,) that each light point lies on."""
        shining = np.flatnonzero(self.scene.light_of >= 0)
        if not shining.size:
            return np.full(q.shape[1], -1)
        if shining.size == 1:
            return np.full(q.shape[1], shining[0])
        reach = 0.1 * geometry.NEAR * geometry.scale(self.scene)
        t, primitive = geometry.met(self.scene, q - reach * wi, wi)
        fine = (np.abs(t - reach) < reach) & (self.scene.light_of.take(np.maximum(primitive, 0)) >= 0)
        return np.where(fine & (primitive >= 0), primitive, shining[0])

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
                return np.where(cos > 0.0, pdf, 0.0)
            primitive = found["primitive"].astype(np.intp)
            if (primitive < 0).any():
                return None
            pdf = self.scene.lights.area.pdf(primitive, p, found["q"], ng)
        return np.where(cos > 0.0, pdf, 0.0)

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
            "pdf": said("pdf", (lambda: geometry.ask(self.scene, "pdf", vertex, wi)) if self.sampler_known else None),
            "delta": delta,
            "u": said("u"),
        }
        if not self.chain.given("bounce.wi").any():
            self.rebuilt.add("bounce.wi")
        return found

    def _throughputs(self, bounce):
        """Throughput (3, N) at each call, after its bounce, and after roulette.

        What a call multiplied the inner one's radiance with is indirect / returned where both are logged, else
        f cos / (pdf q). Where that ratio is f cos / pdf alone, roulette was not paid for; any other difference
        is the bounce's.
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
        q = np.where(np.isfinite(self.q) & self.bounced, self.q, 1.0)
        known = np.isfinite(ratio)
        with np.errstate(all="ignore"):
            unpaid = (~known | (np.abs(ratio - made) <= _SAME * self.eps * made)).all(axis=0) & known.any(axis=0)
            unpaid &= np.abs(q - 1.0) > _SAME * self.eps
            of_roulette = np.where(unpaid, 1.0, 1.0 / q)
            of_bounce = np.where(known, ratio / of_roulette, made)
        if "bounce.cos" in self.rebuilt:
            self._as_near_as_directions_say(bounce, of_bounce[:, rows] / made[:, rows])
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

    def _own(self):
        """Emission that each call adds, (3, N): as logged; what a call without other terms returned; else 0."""
        chain = self.chain
        if not chain.given("returned").any() and not chain.given("emission").any():
            return None
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
            w = self._said("hit", "w", lambda: np.where(shining, share, 1.0))
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
            pdf[lit] = self.scene.lights.area.pdf(primitive[lit], o, p, ng)
        return pdf

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
        return light

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
            "survived": self.bounced[rows],
            "beta": after[:, rows],
        }

    def _escaped(self, beta):
        rows = self.rows["escape"]
        own = self._own()
        d = self.places.d[:, rows]
        around = self.scene.environment(d) if rows.size else None
        Le = around[0] if around is not None else np.zeros(d.shape)
        shining = Le.max(axis=0) > 0.0
        found = {"d": d, "Le": Le, "pdf_light": around[1] if around is not None else np.zeros(rows.size)}
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
        elif open_.size and self.roulette_known:
            reason[open_] = _END["absorbed"]
        self.rebuilt.add("end.reason")
        found = {"reason": reason if (reason >= 0).all() else None, "radiance": None}
        root = self.rows["camera"]
        if self._all_given("returned", root):
            found["radiance"] = self.chain("returned")[:, root]
        return found

"""What a learner's cast_ray did, as a Trace.

A call becomes a HIT, its light samples LIGHTs, the call within it a BOUNCE, the comparison of a random number
before that a ROULETTE. What a term of the returned colour has as factors says what was used where: the term
with a light sample's radiance is that sample's contribution, the one with the inner call's colour carries on.
Where a term lacks a factor that belongs there, what that factor has to be stands in its place: the term
is then judged as a whole, and the ratio of the recorded to the right one tells what is missing. Of light
samples that bring nothing no factor is seen; so there are two traces: one with all light samples, to judge
how they were chosen and whether they are seen, and one with those that bring something, to judge what.
"""

from collections import Counter
from dataclasses import replace

import numpy as np

from tracer.events import BOUNCE, CAMERA, END, END_REASONS, ESCAPE, HIT, KINDS, LIGHT, ROULETTE
from tracer.learner.terms import SURE, Terms, cosine, used_or_right
from tracer.learner.value import Vector, dot
from tracer.trace.trace import Table, Trace

_AREA = LIGHT.field("technique").choices.index("area")
_REASON = END_REASONS.index


class Builder:
    """Collects paths; `trace` gives them all."""

    def __init__(self, world, settings):
        self.scene, self.settings, self._lamp_area = world.scene, settings, world.lamp_area
        self._rows = {kind.name: [] for kind in KINDS}
        self._paths = []
        self._going = Counter()  # outcomes of the comparisons after which a call followed
        self._stopped = []  # (outcome, number of the path, fields of its ROULETTE and its END)

    def add(self, x, y, sample, film, call):
        """One path: the outermost Call."""
        self._path, self._step = len(self._paths), 0
        ones, direction = np.ones(3), call.ray.direction.plain
        self._put(CAMERA, 0, film=film, o=call.ray.origin.plain, d=direction, beta=ones)
        end, vertices = self._call(call, ones, np.inf)
        radiance = call.returned.value
        self._put(END, max(vertices - 1, 0), reason=_REASON(end), radiance=radiance)
        self._paths.append([x, y, sample, film, radiance, _REASON(end), vertices])

    def _put(self, kind, depth, **fields):
        self._rows[kind.name].append((self._path, self._step, depth, fields))
        self._step += 1
        return fields

    def _call(self, call, beta, pdf):
        """The events of a call and of those within it; how the path ended, and how many vertices it has.

        pdf: density of the bounce that led to it.
        """
        terms = Terms(call)
        if call.hit is None:
            d, brought = call.ray.direction.plain, beta * call.returned.value
            self._put(ESCAPE, call.depth, d=d, Le=np.zeros(3), w=0.0, contribution=brought)
            return "escaped", 0
        self._hit(call, beta, pdf, terms)
        for sample in call.lights:
            self._light(call, beta, terms, sample)
        roll = _rolled(call)
        if not call.children:
            if roll is not None:
                fields = self._roll(call, beta, roll, False)
                self._stopped.append((roll.of["outcome"], self._path, fields))
            return _end_of(call), 1
        child = call.children[0]
        after = beta * terms.factor(child)
        right = self._bounce(call, child, terms.of_child(child), beta)
        q = roll.of["against"] if roll is not None else 1.0
        forgotten = np.allclose(after, right, rtol=SURE, atol=0.0)  # 1/q, but nothing else
        bounce = self._rows[BOUNCE.name][-1][-1]
        bounce["beta"] = after if forgotten else after * q
        if roll is not None:
            self._going[roll.of["outcome"]] += 1
            self._roll(call, after, roll, True)
        end, vertices = self._call(child, after, bounce["pdf"])
        return end, vertices + 1

    def _hit(self, call, beta, pdf, terms):
        hit = call.hit
        Le = np.broadcast_to(hit.emission.value, (3,))
        contribution = beta * terms.emission()
        given = float(np.max(contribution) > 0.0)
        cos = abs(dot(call.ray.direction, hit.n).value)
        pdf_light = hit.t * hit.t / (cos * self._lamp_area) if Le.any() and cos > 0.0 else 0.0
        self._put(
            HIT,
            call.depth,
            p=hit.p.plain,
            t=hit.t,
            primitive=hit.primitive,
            ng=hit.n.plain,
            n=hit.n.plain,
            wo=-call.ray.direction.plain,
            front=hit.front,
            beta=beta,
            Le=Le,
            pdf_bsdf=pdf,
            pdf_light=pdf_light,
            w=given if Le.any() else 1.0,
            contribution=contribution,
        )

    def _light(self, call, beta, terms, sample):
        away = sample.p.plain - call.hit.p.plain
        distance = np.linalg.norm(away)
        wi = away / max(distance, np.finfo(float).tiny)
        used, value = terms.of_light(sample)
        if not call.hit.front and not value.any():
            return  # none is due at the back of a surface, and none was used
        cos_light = float(-wi @ sample.n.plain)
        cos = float(wi @ call.hit.n.plain)
        pdf_area = float(sample.pdf.value)
        self._put(
            LIGHT,
            call.depth,
            light=self.scene.light_of[sample.primitive],
            primitive=sample.primitive,
            pick=1.0 if len(self.scene.light_names) == 1 else None,
            technique=_AREA,
            q=sample.p.plain,
            nq=sample.n.plain,
            wi=wi * _length(call.asked, wi),
            distance=distance,
            Le=sample.emission.value * (cos_light > 0.0),
            pdf=pdf_area * distance * distance / cos_light if cos_light > 0.0 else 0.0,
            f=used_or_right(used, "f", lambda: _f(call, Vector(*wi))),
            cos=_or(cosine(used, call.hit.n), abs(cos)),
            w=float(value.any() or cos > 0.0),  # 0 where nothing can arrive
            beta=beta,
            visible=bool(value.any()),
            contribution=beta * value,
        )

    def _bounce(self, call, child, used, beta):
        """The BOUNCE to the inner call, its `beta` still to come; what that would be by f, cos and pdf."""
        wi = child.ray.direction
        f = used_or_right(used, "f", lambda: _f(call, wi))
        pdf = used_or_right(
            used, "pdf", lambda: call.hit.material.pdf(wi, -call.ray.direction, call.hit.n).value
        )
        cos = _or(cosine(used, call.hit.n), abs(dot(wi, call.hit.n).value))
        self._put(
            BOUNCE, call.depth, wi=wi.plain, f=f, pdf=pdf, cos=cos, delta=False, beta_before=beta, beta=None
        )
        with np.errstate(all="ignore"):
            return beta * f * cos / pdf

    def _roll(self, call, beta, roll, survived):
        return self._put(
            ROULETTE, call.depth, probability=roll.of["against"], u=roll.value, survived=survived, beta=beta
        )

    def traces(self):
        """The Trace of all paths with all light samples, and with those only that bring something."""
        self._settle()
        columns = list(zip(*self._paths, strict=True))
        names = ("x", "y", "sample", "film", "radiance", "end", "vertices")
        paths = {name: np.array(column).T for name, column in zip(names, columns, strict=True)}
        rows = {name: [*of_kind] for name, of_kind in self._rows.items()}
        used = [row for row in rows[LIGHT.name] if row[-1]["visible"]]
        chosen = [(*at, {**fields, "f": None}) for *at, fields in rows[LIGHT.name]]
        settings = self._declared()
        found = []
        for lights in (chosen, used):
            tables = {kind.name: _table(kind, rows[kind.name]) for kind in KINDS}
            tables[LIGHT.name] = _table(LIGHT, lights)
            found.append(trace_of(self.scene, settings, paths, tables))
        return counted(found)

    def _declared(self):
        """The settings, with the survival probability that was used if it is one, and the kind of loop."""
        used = {float(fields["probability"]) for *_, fields in self._rows[ROULETTE.name]}
        roulette = self.settings.roulette
        if len(used) <= 1:
            none = "off" if self.settings.max_depth >= 0 else "auto"
            roulette = next((f"{q:.17g}" for q in used if 0.0 < q <= 1.0), none)
        integrator = "direct" if self._rows[LIGHT.name] else "walk"
        return replace(self.settings, roulette=roulette, integrator=integrator)

    def _settle(self):
        """Who did not go on after the outcome with which others go on, did so for another reason."""
        if self._going:
            goes_on = self._going.most_common(1)[0][0]
            for outcome, path, fields in self._stopped:
                if outcome == goes_on:
                    fields.update(survived=True, beta=fields["beta"] / fields["probability"])
                    self._rows[END.name][path][-1]["reason"] = self._paths[path][5] = _REASON("absorbed")


def trace_of(scene, settings, paths, tables):
    """The Trace; from where on roulette is played is free, and so is a survival probability that is not one
    number."""
    free = frozenset({"roulette", "roulette-start"} if settings.roulette == "auto" else {"roulette-start"})
    return Trace(scene, settings, paths, tables, float(np.finfo(np.float64).eps), free=free)


def counted(traces):
    """The traces, told how many light samples a vertex has: as most have in the first trace."""
    vertex = traces[0].hit_of(LIGHT.name)
    many = np.bincount(vertex[vertex >= 0])
    samples = int(np.bincount(many[many > 0]).argmax()) if vertex.size else 1
    return tuple(replace(trace, light_samples=samples) for trace in traces)


def _length(asked, wi):
    """Length of the direction along wi in which a ray was sent; 1 where none was."""
    for d in (direction.plain for direction in asked):
        size = float(np.linalg.norm(d))
        if abs(size - 1.0) > SURE and d @ wi > (1.0 - SURE) * size:
            return size
    return 1.0


def _rolled(call):
    """The random number that decided on going on: the last that was compared with anything; None if none."""
    return next((leaf for leaf in reversed(call.randoms) if "against" in leaf.of), None)


def _end_of(call):
    """Why no call followed."""
    if _rolled(call) is not None:
        return "roulette"
    return "black" if call.hit.emission else "absorbed"


def _f(call, wi):
    """What the BSDF has to be there, (3,)."""
    return call.hit.material.eval(wi, -call.ray.direction, call.hit.n).value


def _or(value, other):
    return other if value is None else value


def _table(kind, rows):
    """One table of rows (path, step, depth, fields), without the fields that some row lacks."""
    names = [f for f in kind.fields if all(fields.get(f.name) is not None for *_, fields in rows)]
    columns = {}
    for f in names if rows else [f for f in kind.fields if f.carried]:
        if not rows:
            columns[f.name] = np.empty((*f.shape, 0))
            continue
        values = [np.broadcast_to(fields[f.name], f.shape) for *_, fields in rows]
        columns[f.name] = np.stack(values, axis=-1)
    path, step, depth = (np.array([row[k] for row in rows], np.int64) for k in range(3))
    return Table(path, step, depth, columns)

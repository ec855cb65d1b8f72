"""Which events a call of a recursive function stands for, and in which order."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tracer.trace.jsonl import geometry
from tracer.trace.jsonl.compact import compact
from tracer.trace.jsonl.places import Places
from tracer.trace.trace import Table

_LEAKS = 1e-3  # share of calls that meet nothing because a ray slipped through an edge


@dataclass
class Stages:
    """Which events each call has, and what was logged of them; `rebuilt` are "kind.field" that were not, and
    `assumed` those of them that the law about them was asked for; `partly` has those that some events of a
    kind say and not all, (kind, how many do, of how many) -> "kind.field"."""

    chain: Any
    places: Places
    scene: Any  # of 64 bits
    dtype: Any  # of the tables
    settings: Any
    eps: float
    roulette_known: bool
    sampler_known: bool  # whether it was declared, or told from the numbers, how surfaces choose directions

    def __post_init__(self):
        chain, places = self.chain, self.places
        self.rebuilt, self.assumed, self.partly = set(), set(), {}
        self.vertex = places.vertex(slice(None))
        self.dark = geometry.dark(self.scene, self.vertex)
        self.q = self._probability()
        worked = self._worked()
        told_lost = np.zeros(chain.path.size, bool)
        if chain.given("roulette.survived").any():
            told_lost = chain.given("roulette.survived") & (chain.columns.values["roulette.survived"] == 0)
        bounced = ~chain.last | (chain.given("bounce.wi") & ~told_lost)
        guessed = chain.last & places.hit & ~self.dark & worked & np.isfinite(self.q)
        if chain.given("roulette.survived").any():
            guessed &= ~chain.given("roulette.survived")
        # Who looks ahead and calls himself at dark surfaces only has no calls that meet a lamp or nothing:
        # then what ends a path is not to be told from roulette, unless its outcome is logged.
        shining = self.scene.light_of.take(np.maximum(places.primitive, 0)) >= 0
        inner = chain.level > 0
        seen = np.count_nonzero(inner & (~places.hit | shining)) > _LEAKS * np.count_nonzero(inner)
        self.ends_known = (
            bool(chain.given("roulette.survived").any()) or bool(seen) or not self.scene.has_lights
        )
        guessed &= self.ends_known
        self.lost = (told_lost & chain.last) | guessed
        self.bounced = bounced & ~self.lost & places.hit
        self.played = np.isfinite(self.q) & (self.bounced | self.lost)
        self.lit = chain.any("light.") | (chain.given("direct") & places.hit & self._may_be_lit())
        self.wi = self._directions()
        self._place_steps()

    def _worked(self):
        """Whether each call came as far as to look for light or to play roulette, (N,): as its log tells, or
        where nothing is ever logged of that at surfaces of its material."""
        chain, places = self.chain, self.places
        told = chain.any("light.") | chain.any("roulette.") | chain.given("direct")
        material = self.scene.bsdf_of.take(np.maximum(places.primitive, 0))
        silent = np.bincount(material[places.hit & told], minlength=material.max() + 1) == 0
        return told | (places.hit & silent.take(material))

    def _probability(self):
        """Chance to go on at each call, (N,); NaN where none is known."""
        chain = self.chain
        q = np.full(chain.path.size, np.nan)
        try:
            q[:] = float(self.settings.roulette)
        except ValueError:
            pass
        given = chain.given("roulette.probability")
        if given.any():
            q[chain.level < chain.level[given].min()] = np.nan  # there it is not played yet
            np.copyto(q, chain("roulette.probability"), where=given)
        else:
            self.rebuilt.add("roulette.probability")
        return q

    def _may_be_lit(self):
        """Whether direct light can be that of a light sample, (N,): a 0 at a mirror or a black surface says
        that there was none."""
        if not self.chain.given("direct").any():
            return np.zeros(self.chain.path.size, bool)
        mirrors = self.scene.bsdf.is_delta(self.scene.bsdf_of.take(np.maximum(self.places.primitive, 0)))
        return ~(mirrors | self.dark) | (self.chain("direct") != 0.0).any(axis=0)

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
        kept = compact(kept, self.dtype)
        return Table(self.chain.path[rows], self.steps[kind][rows], depth[rows], kept)

    def _said(self, kind, name, otherwise=None, of_log=False):
        """A column of an event of a kind: as logged, elsewhere as `otherwise` (made when needed) has it; None
        where neither is known. of_log: whether that comes from other numbers of the log, not from the law."""
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
            if not of_log:
                self.assumed.add(key)
            return rest
        np.copyto(column, rest, where=~given)
        self.partly.setdefault((kind, int(np.count_nonzero(given)), given.size), []).append(key)
        return column

    def _all_given(self, name, rows):
        return rows.size > 0 and bool(self.chain.given(name)[rows].all())

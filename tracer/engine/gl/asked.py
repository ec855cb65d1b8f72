"""The lines of a shader that ask the shapes of a scene: as numbers one after the other, or as rows of tables.

As numbers the compiler drops what is multiplied by zero; many of them would take it too long. A shape that
was changed stands in a table, so that changing it further compiles nothing.
"""

from typing import NamedTuple

import numpy as np

WRITTEN_OUT = 128  # flat faces and spheres that stand in the source as numbers; more are asked in a loop
TRIANGLES = 48  # that stand there, too; more are asked by trees
RELATED = 512  # primitives of which all pairs are a table


def number(value):
    """A real number as GLSL writes it, all its bits kept."""
    written = f"{np.float32(value):.9g}"
    return written if "." in written or "e" in written else f"{written}.0"


def vector(values):
    """Three or four of them."""
    return f"vec{len(values)}({', '.join(map(number, values))})"


def struct(name, row):
    """A row of a table as a constant."""
    fields = [
        vector(row[f]) if row[f].dtype.kind == "f" else f"ivec4({', '.join(map(str, row[f]))})"
        for f in row.dtype.names
    ]
    return f"{name}({', '.join(fields)})"


class Shapes(NamedTuple):
    """The tables of shapes, as shape_tables has them."""

    quads: np.ndarray
    balls: np.ndarray
    meshes: np.ndarray
    triangles: np.ndarray
    turned: frozenset = frozenset()  # primitives that are rows of tables always, since they may change again

    @property
    def in_tree(self):
        """Whether triangles are looked for in their meshes' trees."""
        return self.meshes["number"][:, 1].sum() > TRIANGLES

    @property
    def related(self):
        """Whether what is decided for two faces is a table."""
        return len(self.quads) + len(self.balls) + self.meshes["number"][:, 1].sum() <= RELATED

    def text(self):
        """The functions meet_all, for the nearest hit, and blocked, for shadows."""
        for function, shadows in (
            ("void meet_all(Ray r, inout Near near)", False),
            ("bool blocked(Ray r, Near near)", True),
        ):
            lines = [*self._even(shadows), *self._meshes(shadows)]
            yield "\n".join((function, "{", "    bool close_by = false;", *lines, "}"))

    def _even(self, shadows):
        """Flat faces and spheres; shadows: only those that may hide a lamp."""
        asked = "k.number.y != 0" if shadows else "true"
        meet = f"meet_quad(r, near, k, {'0.0' if shadows else 'k.more.x'})"
        every = tuple(_loop(len(self.quads), "Quad", "quads", asked, meet))
        if len(self.quads) + len(self.balls) > WRITTEN_OUT:
            yield from every
            yield from _loop(len(self.balls), "Ball", "balls", asked, "meet_sphere(r, near, k)")
            return
        meet = "meet_quad(r, near" if self.related else "meet_far_quad(r, near, close_by"
        for k in np.flatnonzero(self.quads["number"][:, 1] >= shadows):
            row, again = self.quads[k], self.quads[k]["number"][0] in self.turned
            quad = f"quads_at({k})" if again else struct("Quad", row)
            hair = f"{quad}.more.x" if again else number(row["more"][0])
            yield f"    {meet}, {quad}, {'0.0' if shadows else hair});"
        for k in np.flatnonzero(self.balls["number"][:, 1] >= shadows):
            row, again = self.balls[k], self.balls[k]["number"][0] in self.turned
            yield f"    meet_sphere(r, near, {f'balls_at({k})' if again else struct('Ball', row)});"
        if not self.related:
            yield from ("    if (close_by) {", *every, "    }")

    def _meshes(self, shadows):
        if shadows:
            yield from ("    if (near.primitive >= 0)", "        return true;")
        if self.in_tree:
            asked, one_will_do = ("k.more.w != 0", "true") if shadows else ("true", "false")
            meet = f"meet_mesh(r, near, k, {one_will_do})"
            yield from _loop(len(self.meshes), "Mesh", "meshes", asked, meet)
        else:
            for row in self.meshes[self.meshes["more"][:, 3] >= shadows]:
                yield from _triangles(row, self.triangles)
        if shadows:
            yield "    return near.primitive >= 0;"


def _loop(count, type_, name, asked, meet):
    """All rows of a table."""
    yield f"    for (int row = 0; row < {count}; ++row) {{"
    yield f"        {type_} k = {name}_at(row);"
    yield f"        if ({asked})"
    yield f"            {meet};"
    yield "    }"


def _triangles(row, triangles):
    """Those of a mesh, as numbers."""
    first, count = row["number"][:2]
    yield "    {"
    yield f"        Sheared s = sheared_onto_axis(r, {first}, {count});"
    yield "        Crossing best = Crossing(INFINITE, INFINITE, near.t, -1);"
    numbers = triangles["plane"][:, 3]
    for triangle in triangles[(numbers >= first) & (numbers < first + count)]:
        primitive = int(triangle["plane"][3])
        yield f"        meet_triangle(r, s, best, {primitive}, {struct('Triangle', triangle)});"
    yield "        take(best, near);"
    yield "    }"

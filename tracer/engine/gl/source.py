"""The shader of one scene at one set of settings: files of glsl/ with what only this scene needs.

What a scene lacks is not in the source at all: materials of other kinds, lights of other kinds, a lens.
Few shapes stand in it as numbers (see asked).
"""

from functools import cache
from importlib.resources import files

import numpy as np

from tracer.bsdf.roughplastic import NODES
from tracer.engine.gl import material_tables, shape_tables, tables
from tracer.engine.gl.asked import Shapes, number, vector
from tracer.engine.gl.packed import Packed
from tracer.integrator.steps import AUTO_DEPTH, AUTO_MOST
from tracer.light.sample import Ball
from tracer.sampler.lattice import COMPONENTS, DEPTHS
from tracer.sampler.numbers import USES

_STRATEGIES = {"mis": "MIS", "light": "BY_LIGHT", "bsdf": "BY_BSDF"}


@cache
def text(name):
    """A file of glsl/."""
    return (files("tracer.engine.gl") / "glsl" / f"{name}.glsl").read_text(encoding="utf-8")


class Source:
    """A shader's text, and the `tables` it reads, Packed.

    stage: Compute or Fragments, which run it; watched: vertices of each path to keep.
    """

    def __init__(self, scene, settings, stage, watched=0):
        self.scene, self.settings, self.watched = scene, settings, watched
        self._stage = stage
        self.tables, self._accessors = Packed(), []
        self._kinds = [
            material_tables.KINDS[k] for k in np.unique(material_tables.materials(scene)["number"][:, 0])
        ]
        self._elsewhere = tables.elsewhere(scene)
        self._lamps = tables.lamp_faces(scene)
        self._in_leaves, triangles = shape_tables.triangles(scene)
        self._shapes = Shapes(
            shape_tables.quads(scene),
            shape_tables.balls(scene),
            shape_tables.meshes(scene),
            triangles,
            shape_tables.turned(scene),
        )
        self.text = "\n".join(self._parts())

    def _parts(self):
        yield f"#version {self._stage.version}"
        yield from (f"#define {name} {value}" for name, value in self._defines())
        yield "uniform uint seed; uniform int last_depth; uniform float said_survival;"
        for name in (f"{self._stage.folder}/tables", "tables", "frame", "warp", "sampler/numbers"):
            yield text(name)
        yield from self._sampler()
        for name in ("camera", "shape/rays", "shape/start", "shape/rectangle", "shape/sphere"):
            yield text(name)
        yield from self._what_rays_meet()
        yield from self._materials()
        yield from self._lights()
        yield text("scene")
        if self.scene.media is not None:
            yield f"#define CAMERA_MEDIUM {self.scene.media.camera}"
            self._table("media", "vec4", material_tables.media(self.scene))
            yield text("medium")
        if self.scene.bsdf.any_textured:
            self._textures()
            yield text("texture")
        for name in ("watching", "integrator/path", "main", f"{self._stage.folder}/main"):
            yield text(name)
        yield from self._accessors

    def _textures(self):
        of, texels = material_tables.textures(self.scene)
        self._table("charts", "Chart", tables.charts(self.scene))
        self._table("textures", "Texture", of)
        self._table("texels", "vec4", texels)

    def _table(self, name, type_, values):
        """A table that is read: its NAME_at comes last, the files declare it where they need it."""
        self._accessors.append(self.tables.add(name, type_, values))

    def _defines(self):
        scene, settings, camera, shapes = self.scene, self.settings, self.scene.camera, self._shapes
        strategy = {"direct": "light", "walk": "bsdf"}.get(settings.integrator, settings.strategy)
        upper = f"{settings.hemisphere}_hemisphere"
        surround = scene.lights is not None and scene.lights.surround
        fixed = settings.roulette not in ("auto", "off")
        yield from {
            **self._stage.defines, "WATCHED": self.watched,
            **{kind.upper(): k for k, kind in enumerate(tables.KINDS)},
            "PI": "3.14159265", "TINY": "1.17549435e-38", "INFINITE": "3.0e38",
            "MIS": 0, "BY_LIGHT": 1, "BY_BSDF": 2, "STRATEGY": _STRATEGIES[strategy],
            "POWER": int(settings.heuristic == "power"),
            "HEMISPHERE": upper, "HEMISPHERE_PDF": f"{upper}_pdf",
            "OFF": 0, "AUTO": 1, "FIXED": 2, "ROULETTE": "FIXED" if fixed else settings.roulette.upper(),
            "AUTO_DEPTH": AUTO_DEPTH, "AUTO_MOST": number(AUTO_MOST),
            "JITTER": int(settings.jitter), "LENS": int(camera.aperture_radius > 0.0),
            "PRIMITIVES": len(scene.shape_of), "ANY_DELTA": int(scene.bsdf.any_delta),
            "RELATIONS": int(shapes.related), "IN_TREE": int(shapes.in_tree),
            "ANY_TRIANGLE": int(shapes.meshes.size > 0),
            "DEEPEST": shapes.in_tree * int(shapes.meshes["more"][:, 0].max(initial=0)),
            "ANY_SMOOTH": int(scene.has_smooth_normals), "MEDIA": int(scene.media is not None),
            "TEXTURES": int(scene.bsdf.any_textured),
            "ANY_ANISOTROPIC": int(scene.bsdf.any_anisotropic),
            "FACES": len(self._lamps), "ELSEWHERE": len(self._elsewhere), "SURROUND": int(surround),
            "ENTRIES": len(self._lamps) + len(self._elsewhere),
            "USES": f"{len(USES)}u", "REPLICATES": f"{settings.replicates}u", "DEPTHS": f"{DEPTHS}u",
            "FILM": "0u", "LENS_USE": "1u", "LIGHT": "2u", "BSDF": "3u", "ROULETTE_USE": "4u",
        }.items()  # fmt: skip
        half = np.tan(np.radians(0.5 * camera.fov_x))
        yield "PER_PIXEL", number(2.0 / settings.width)
        yield "ASPECT", number(settings.height / settings.width)
        yield "HALF_WIDTH", number(half)
        for name in ("origin", "forward", "right", "up"):
            yield name.upper(), vector(getattr(camera, name))
        yield "APERTURE_RADIUS", number(camera.aperture_radius)
        yield "FOCUS_DISTANCE", number(camera.focus_distance)

    def _sampler(self):
        if self.settings.sampler == "lattice":
            triples = np.zeros((len(USES), DEPTHS, 3), np.uint32)
            for k, use in enumerate(USES):
                triples[k, :, : USES[use]] = COMPONENTS[use].T
            every = ", ".join(f"uvec3({x}u, {y}u, {z}u)" for x, y, z in triples.reshape(-1, 3))
            yield f"const uvec3 COMPONENTS[{len(USES) * DEPTHS}] = uvec3[]({every});"
        yield text(f"sampler/{self.settings.sampler}")

    def _what_rays_meet(self):
        scene, shapes = self.scene, self._shapes
        self._table("surfaces", "Surface", tables.surfaces(scene, self._in_leaves))
        if shapes.meshes.size:
            self._table("triangles", "Triangle", shapes.triangles)
            for name in ("bvh", "mesh_kernel", "mesh"):
                yield text(f"shape/{name}")
        if shapes.in_tree:
            self._table("meshes", "Mesh", shapes.meshes)
            self._table("nodes", "vec4", shape_tables.nodes(scene))
        if scene.has_smooth_normals:
            self._table("smooths", "Smooth", shape_tables.smooth(scene))
        if shapes.related:
            self._table("relations", "int", shape_tables.relations(self.scene.faces))
        else:
            self._table("definitions", "Definition", shape_tables.definitions(self.scene.faces))
        self._table("quads", "Quad", shapes.quads)
        self._table("balls", "Ball", shapes.balls)
        yield from shapes.text()

    def _materials(self):
        yield text("bsdf/sample")
        yield text("bsdf/fresnel")
        if any(kind in material_tables.ROUGH for kind in self._kinds):
            yield text("bsdf/ggx")
            yield text("bsdf/beckmann")
            yield text("bsdf/microfacet")
        if "RoughPlastic" in self._kinds:
            yield f"#define NODES {NODES}.0"
            self._table("through", "float", material_tables.through(self.scene))
        for kind in self._kinds:
            yield text(f"bsdf/{kind.lower()}")
        self._table("materials", "Material", material_tables.materials(self.scene))
        for type_, answer, arguments in (
            ("vec3", "eval", "wo, vec3 wi"),
            ("float", "pdf", "wo, vec3 wi"),
            ("Sample", "sample", "wo, vec3 u"),
        ):
            names = arguments.replace("vec3 ", "")
            *some, last = self._kinds
            lines = [
                f"    if (m.number.x == {material_tables.KINDS.index(kind)})\n"
                f"        return {kind.lower()}_{answer}(m, {names});"
                for kind in some
            ]
            lines.append(f"    return {last.lower()}_{answer}(m, {names});")
            yield "\n".join((f"{type_} any_{answer}(Material m, vec3 {arguments})", "{", *lines, "}"))
        yield text("bsdf/table")

    def _lights(self):
        yield text("light/sample")
        for name in ("rectangle", "sphere", "area"):
            yield text(f"light/{name}")
        self._table("faces", "Face", self._lamps)
        ball = Ball.around(*self.scene.bounds())
        if len(self._elsewhere):
            yield f"#define BALL elsewhere_at({len(self._elsewhere)}).where"
            for k, kind in enumerate(tables.ELSEWHERE):
                yield f"#define {kind.upper()} {k}"
            self._table("elsewhere", "Elsewhere", tables.with_ball(self._elsewhere, ball))
            for name in ("elsewhere", "point", "directional", "constant"):
                yield text(f"light/{name}")
            for k, row in enumerate(self._elsewhere):
                if row["number"][0] == tables.ELSEWHERE.index("Constant"):
                    yield f"#define SKY_LE elsewhere_at({k}).colour.rgb"
                    yield f"#define SKY_PDF (elsewhere_at({k}).colour.w / (4.0 * PI))"
        if len(self._lamps) + len(self._elsewhere):
            self._table("cdf", "float", self.scene.lights.cdf.astype(np.float32))
            yield text("light/table")

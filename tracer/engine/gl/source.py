"""The shader of one scene at one set of settings: files of glsl/ with what only this scene needs.

What a scene lacks is not in the source at all: materials of other kinds, lights of other kinds, a lens.
Shapes stand in it as numbers, asked one after the other without a loop, so that the compiler drops what is
multiplied by zero.
"""

from importlib.resources import files

import numpy as np

from tracer.bsdf.roughplastic import NODES
from tracer.engine.gl import material_tables, tables
from tracer.integrator.steps import AUTO_DEPTH, AUTO_MOST
from tracer.light.sample import Ball
from tracer.sampler.lattice import COMPONENTS, DEPTHS
from tracer.sampler.numbers import USES

GROUP = 64  # invocations side by side
WRITTEN_OUT = 48  # triangles that stand in the source as numbers; more are a table
_TABLES = (
    "surfaces",
    "materials",
    "faces",
    "cdf",
    "elsewhere",
    "relations",
    "through",
    "triangles",
    "smooths",
    "media",
    "charts",
    "textures",
    "texels",
)
_BINDINGS = {name: 4 + k for k, name in enumerate(_TABLES)}  # before them main.glsl, watching.glsl
_STRATEGIES = {"mis": "MIS", "light": "BY_LIGHT", "bsdf": "BY_BSDF"}


def text(name):
    """A file of glsl/."""
    return (files("tracer.engine.gl") / "glsl" / f"{name}.glsl").read_text(encoding="utf-8")


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


class Source:
    """A shader's text, and the tables it reads: {binding: bytes}. watched: vertices of each path to keep."""

    def __init__(self, scene, settings, watched=0):
        self.scene, self.settings, self.watched = scene, settings, watched
        self.faces, self.extent = tables.faces_of(scene)
        self.buffers = {}
        self._kinds = [
            material_tables.KINDS[k] for k in np.unique(material_tables.materials(scene)["number"][:, 0])
        ]
        self._elsewhere = tables.elsewhere(scene)
        self._lamps = tables.lamp_faces(scene)
        self.text = "\n".join(self._parts())

    def _parts(self):
        yield "#version 430"
        yield from (f"#define {name} {value}" for name, value in self._defines())
        yield "uniform uint seed;"
        for name in ("frame", "warp", "sampler/numbers"):
            yield text(name)
        yield from self._sampler()
        for name in ("camera", "shape/rays"):
            yield text(name)
        yield self._table("relations", "int", tables.relations(self.faces))
        for name in ("shape/start", "shape/rectangle", "shape/sphere", "shape/bvh", "shape/mesh_kernel"):
            yield text(name)
        yield from self._shapes()
        yield from self._materials()
        yield from self._lights()
        yield "struct Surface { ivec4 number; vec4 plane; vec4 more; vec4 u; vec4 v; };"
        yield self._table("surfaces", "Surface", tables.surfaces(self.scene, self.faces))
        if self.scene.has_smooth_normals:
            yield text("shape/mesh")
            yield self._table("smooths", "Smooth", tables.smooth(self.scene)[1])
        yield text("scene")
        if self.scene.media is not None:
            yield f"#define CAMERA_MEDIUM {self.scene.media.camera}"
            yield self._table("media", "vec4", material_tables.media(self.scene))
            yield text("medium")
        if self.scene.bsdf.any_textured:
            yield from self._textures()
        for name in ("watching", "integrator/path", "main"):
            yield text(name)

    def _textures(self):
        of, texels = material_tables.textures(self.scene)
        structs, functions = text("texture").split("#define NEAREST")
        yield structs
        yield self._table("charts", "Chart", tables.charts(self.scene))
        yield self._table("textures", "Texture", of)
        yield self._table("texels", "vec4", texels)
        yield f"#define NEAREST{functions}"

    def _table(self, name, type_, values):
        """The declaration of a table that is read from a buffer."""
        binding = _BINDINGS[name]
        self.buffers[binding] = np.ascontiguousarray(values).tobytes() or bytes(16)
        return f"layout(std430, binding = {binding}) readonly buffer Of_{name} {{ {type_} {name}[]; }};"

    def _defines(self):
        scene, settings, camera = self.scene, self.settings, self.scene.camera
        strategy = {"direct": "light", "walk": "bsdf"}.get(settings.integrator, settings.strategy)
        upper = f"{settings.hemisphere}_hemisphere"
        surround = scene.lights is not None and scene.lights.surround
        fixed = settings.roulette not in ("auto", "off")
        yield from {
            "GROUP": GROUP, "WATCHED": self.watched and f"{self.watched}u",
            "PI": "3.14159265", "TINY": "1.17549435e-38", "INFINITE": "3.0e38",
            "MIS": 0, "BY_LIGHT": 1, "BY_BSDF": 2, "STRATEGY": _STRATEGIES[strategy],
            "POWER": int(settings.heuristic == "power"),
            "HEMISPHERE": upper, "HEMISPHERE_PDF": f"{upper}_pdf",
            "OFF": 0, "AUTO": 1, "FIXED": 2, "ROULETTE": "FIXED" if fixed else settings.roulette.upper(),
            "SURVIVAL": number(settings.roulette) if fixed else "1.0",
            "AUTO_DEPTH": AUTO_DEPTH, "AUTO_MOST": number(AUTO_MOST),
            "LAST_DEPTH": settings.last_depth,
            "JITTER": int(settings.jitter), "LENS": int(camera.aperture_radius > 0.0),
            "PRIMITIVES": len(scene.shape_of), "ANY_DELTA": int(scene.bsdf.any_delta),
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

    def _shapes(self):
        """meet_all and blocked."""
        numbers, quads, hair = tables.quads(self.scene, self.extent, self.faces)
        balls, places = tables.spheres(self.scene)
        shadowed = set(tables.asked_for_shadows(self.scene))
        all_, some = [], []
        for k, row, h in zip(numbers, quads, hair, strict=True):
            quad = struct("Quad", row)
            all_.append(f"    meet_quad(r, near, {k}, {quad}, {number(h)});")
            if k in shadowed:
                some.append(f"    meet_quad(r, near, {k}, {quad}, 0.0);")
        for k, place in zip(balls, places, strict=True):
            line = f"    meet_sphere(r, near, {k}, {vector(place)});"
            all_.append(line)
            if k in shadowed:
                some.append(line)
        numbers, triangles = tables.triangles(self.scene, self.extent, self.faces)
        if len(numbers) > WRITTEN_OUT:
            yield self._table("triangles", "Triangle", triangles)
            begin = 0
            for low, high, count in tables.mesh_boxes(self.scene, self.extent, self.faces):
                lines = (
                    f"    if (passes(r, near, {vector(low)}, {vector(high)}))",
                    f"        for (int k = {begin}; k < {begin + count}; ++k)",
                    "            meet_triangle(r, near, int(triangles[k].plane.w), triangles[k]);",
                )
                all_ += lines
                some += lines
                begin += count
            numbers = []
        for k, row in zip(numbers, triangles, strict=False):
            line = f"    meet_triangle(r, near, {k}, {struct('Triangle', row)});"
            all_.append(line)
            if k in shadowed:
                some.append(line)
        yield "\n".join(("void meet_all(Ray r, inout Near near)", "{", *all_, "}"))
        yield "\n".join(
            ("bool blocked(Ray r, Near near)", "{", *some, "    return near.primitive >= 0;", "}")
        )

    def _materials(self):
        yield text("bsdf/sample")
        yield text("bsdf/fresnel")
        if any(kind in material_tables.ROUGH for kind in self._kinds):
            yield text("bsdf/ggx")
            yield text("bsdf/beckmann")
            yield text("bsdf/microfacet")
        if "RoughPlastic" in self._kinds:
            yield f"#define NODES {NODES}.0"
            yield self._table("through", "float", material_tables.through(self.scene))
        for kind in self._kinds:
            yield text(f"bsdf/{kind.lower()}")
        yield self._table("materials", "Material", material_tables.materials(self.scene))
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
        yield self._table("faces", "Face", self._lamps)
        ball = Ball.around(*self.scene.bounds())
        if len(self._elsewhere):
            yield "struct Elsewhere { ivec4 number; vec4 where; vec4 colour; };"
            yield f"#define BALL elsewhere[{len(self._elsewhere)}].where"
            for k, kind in enumerate(tables.ELSEWHERE):
                yield f"#define {kind.upper()} {k}"
            yield self._table("elsewhere", "Elsewhere", tables.with_ball(self._elsewhere, ball))
            for name in ("elsewhere", "point", "directional", "constant"):
                yield text(f"light/{name}")
            for k, row in enumerate(self._elsewhere):
                if row["number"][0] == tables.ELSEWHERE.index("Constant"):
                    yield f"#define SKY_LE elsewhere[{k}].colour.rgb"
                    yield f"#define SKY_PDF (elsewhere[{k}].colour.w / (4.0 * PI))"
        if len(self._lamps) + len(self._elsewhere):
            yield self._table("cdf", "float", self.scene.lights.cdf.astype(np.float32))
            yield text("light/table")

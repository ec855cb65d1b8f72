"""What the gl engine cannot do, by name: it is refused before anything is drawn, never drawn wrong."""

from dataclasses import fields

from tracer.engine.gl import material_tables, tables
from tracer.integrator.stages import refuse_unmeetable
from tracer.integrator.steps import RIGHT, Steps
from tracer.settings import TracerError
from tracer.shape import end

MOST = 512  # triangles, faces and spheres, which are asked one after the other


def refuse(scene, settings, steps):
    """TracerError with the first thing that only NumPy does."""
    found = next(reasons(scene, settings, steps), None)
    if found:
        raise TracerError(f"engine: gl cannot do {found}; choose engine numpy")
    if settings.integrator == "walk" or settings.strategy == "bsdf":
        refuse_unmeetable(scene, settings.integrator)


def reasons(scene, settings, steps):
    """All that stands against it."""
    replaced = [f.name for f in fields(Steps) if getattr(steps, f.name) is not getattr(RIGHT, f.name)]
    if replaced:
        whose = f"bug {settings.bug}, which replaces" if settings.bug else "a replaced step:"
        yield f"{whose} {', '.join(replaced)}"
    if settings.precision != 32:
        yield f"precision {settings.precision}"
    if settings.accel != "bvh":
        yield f"accel {settings.accel}"
    yield from _of_shapes(scene)
    for name, material in scene.definition.bsdfs.items():
        kind = type(getattr(material, "bsdf", material)).__name__
        if kind not in material_tables.KINDS:
            yield f"{name}, a material of kind {kind.lower()}"
    for light in scene.definition.emitters:
        if type(light).__name__ not in tables.ELSEWHERE:
            yield f"{light.name}, a light of kind {type(light).__name__.lower()}"


def _of_shapes(scene):
    if len(scene.shape_of) > MOST:
        yield f"{len(scene.shape_of)} triangles, faces and spheres (up to {MOST})"
        return
    shining = [k for k, surface in enumerate(scene.definition.surfaces) if surface.radiance is not None]
    faces, _ = tables.faces_of(scene)
    touching = end.beside(faces, scene.shape_of, shining)
    if touching is not None:
        lamp = int(touching.many.argmax())
        yield f"{scene.shapes[scene.shape_of[lamp]].name}, a lamp that touches another shape"

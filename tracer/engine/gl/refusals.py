"""What the gl engine cannot do, by name: it is refused before anything is drawn, never drawn wrong."""

from dataclasses import fields

from tracer.engine.gl import material_tables, tables
from tracer.integrator.stages import refuse_unmeetable
from tracer.integrator.steps import RIGHT, Steps
from tracer.settings import TracerError
from tracer.shape import end

_MB = 1 << 20


def refuse(scene, settings, steps):
    """TracerError with the first thing that only NumPy does."""
    _refuse(next(reasons(scene, settings, steps), None))
    if settings.integrator == "walk" or settings.strategy == "bsdf":
        refuse_unmeetable(scene, settings.integrator)


def refuse_size(size, most):
    """TracerError where a driver takes fewer bytes of tables than a scene has."""
    _refuse(of_size(size, most))


def _refuse(found):
    if found:
        raise TracerError(f"engine: gl cannot do {found}; choose engine numpy")


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
    shining = [k for k, surface in enumerate(scene.definition.surfaces) if surface.radiance is not None]
    touching = end.beside(scene.faces, scene.shape_of, shining)
    if touching is not None:
        lamp = int(touching.many.argmax())
        yield f"{scene.shapes[scene.shape_of[lamp]].name}, a lamp that touches another shape"


def of_size(size, most):
    """What stands against so many bytes of tables where a driver takes so many at most, or None."""
    if size <= most:
        return None
    return f"{-(-size // _MB)} MB of triangles and tables where the driver takes {most // _MB} MB"

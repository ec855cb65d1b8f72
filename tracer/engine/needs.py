"""What a picture needs of the tracer, and what is skipped because the scene or the question does not need it.

Only a report: each line asks the very flag that the loop, the scene or the arrangement decides by.
"""

from typing import NamedTuple


class Need(NamedTuple):
    """One feature of the tracer."""

    name: str
    on: bool
    why: str  # why it is needed, or why not


def needs(scene, settings):
    """All the features, as Needs, for a Scene at these Settings."""
    scene = scene.at(settings)
    samples = light_samples(scene, settings)
    yield samples
    yield from _shadows(scene, samples.on)
    weighted = samples.on and settings.integrator == "path" and settings.strategy == "mis"
    yield Need(
        "MIS weights", weighted, "lights are found in two ways" if weighted else "there is one way only"
    )
    lamps = len(scene.light_names)
    yield Need("choice of a light", lamps > 1, f"{lamps} lights" if lamps != 1 else "there is one")
    around = scene.has_lights and scene.lights.surround
    yield Need(
        "environment", around, "rays that leave find light" if around else "nothing shines from outside"
    )
    yield from _materials(scene)
    yield from _geometry(scene)
    yield from _paths(scene, settings)


def light_samples(scene, settings):
    """Whether points on lights are sampled."""
    if not scene.has_lights:
        return Need("light samples", False, "nothing shines")
    if settings.integrator == "walk" or (settings.integrator == "path" and settings.strategy == "bsdf"):
        return Need("light samples", False, "light is looked for by bounces only")
    if scene.bsdf.all_delta:
        return Need("light samples", False, "every material is a mirror or clear glass")
    if 0 <= settings.max_depth < 2:
        return Need("light samples", False, "max_depth 1 is emission seen directly")
    return Need("light samples", True, f"from {_some(scene.light_names)}")


def _shadows(scene, samples):
    arrangement = scene.arrangement
    asked = len(arrangement.blocking)
    spared = [scene.shapes[k].name for k in arrangement.harmless]
    if arrangement.walls_never_block:
        spared += [scene.shapes[k].name for k in arrangement.walls]
        asked -= 1
    why = f"{asked} to ask" + (f"; never in the way: {_some(spared)}" if spared else "")
    partly = [scene.shapes[k].name for k in arrangement.shading]
    why += f"; only where their shadow may fall: {_some(partly)}" if partly else ""
    yield Need("shadow rays", samples and asked > 0, why if samples else "no light samples")


def _materials(scene):
    materials = scene.definition.bsdfs
    kinds = {name: _inner(material) for name, material in materials.items()}
    for title, has in (
        ("Dirac lobes", lambda m: m.delta or type(m).__name__ == "Plastic"),
        ("facets", lambda m: hasattr(m, "facets")),
        ("light through surfaces", lambda m: m.see_through),
        ("frames along the surface", lambda m: m.anisotropic),
    ):
        names = [name for name, material in kinds.items() if has(material)]
        yield Need(title, bool(names), _some(names) if names else "no material has any")
    painted = [name for name in materials if scene.definition.textures.get(name)]
    yield Need("textures", bool(painted), _some(painted) if painted else "every material has one colour")
    count = len({material.kind for material in materials.values()})
    yield Need(
        "materials apart", count > 1, f"{count} kinds, a pass each" if count > 1 else "all of one kind"
    )
    filled = scene.media is not None
    yield Need("absorption", filled, "something is filled" if filled else "nothing is filled")


def _inner(material):
    return getattr(material, "bsdf", material)


def _geometry(scene):
    walls = [scene.shapes[k].name for k in scene.arrangement.walls]
    yield Need("walls met as one box", bool(walls), _some(walls) if walls else "no box is walled up")
    smooth = scene.has_smooth_normals
    yield Need(
        "smooth normals", smooth, "a mesh has its own" if smooth else "every surface is shaded as it is"
    )
    few = [scene.shapes[k].name for k in scene.arrangement.few]
    yield Need("meshes met by planes", bool(few), _some(few) if few else "no triangle mesh has few triangles")
    meshes = [s.name for s in scene.shapes if hasattr(s, "put_inside") and s.name not in few]
    yield Need("trees of boxes", bool(meshes), _some(meshes) if meshes else "no large triangle meshes")


def _paths(scene, settings):
    lens = scene.camera.aperture_radius > 0.0
    yield Need("lens", lens, "the camera has an aperture" if lens else "the camera is a pinhole")
    played = settings.roulette != "off"
    yield Need("Russian roulette", played, f"roulette {settings.roulette}")
    bounces = not 0 <= settings.max_depth < 2
    yield Need("bounces", bounces, f"max_depth {settings.max_depth}")


def _some(names, most=4):
    """The first few names in one line."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more

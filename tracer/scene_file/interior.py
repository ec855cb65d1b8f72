"""What fills a shape, in Mitsuba's words: a homogeneous medium that absorbs and does not scatter."""

from tracer.scene_file.words import LARGEST, Words, colour, real, shown
from tracer.settings import TracerError

ALBEDO = 0.75  # Mitsuba's where nothing is said: a medium that only absorbs has to say 0


def interior(description, place, shape, material):
    """Share of the light (3,) lost per metre inside a shape of this material; None where nothing is.

    Raises TracerError where light cannot get in, or it cannot be said what is inside.
    """
    if description is None:
        return None
    table = Words(description, place)
    if table.take("type") != "homogeneous":
        raise TracerError(f"{place}.type: {shown(description['type'])} is not supported; known: homogeneous")
    albedo = colour(table.take("albedo", ALBEDO), f"{place}.albedo", 1.0)
    sigma_t = colour(table.take("sigma_t", 1.0), f"{place}.sigma_t")
    scale = real(table.take("scale", 1.0), f"{place}.scale", 0.0, LARGEST * LARGEST)
    table.finish()
    if albedo.any():
        said = shown(description["albedo"]) if "albedo" in description else f"the default of {ALBEDO}"
        raise TracerError(
            f"{place}.albedo: {said} scatters light, which is not supported; say albedo = 0 to absorb only"
        )
    sigma_t = scale * sigma_t
    if sigma_t.max() > LARGEST:
        raise TracerError(
            f"{place}.scale: sigma_t is then {sigma_t.max():g} per unit of length; the limit is {LARGEST:g}"
        )
    _check_holds(shape, material, place)
    return sigma_t if sigma_t.any() else None


def _check_holds(shape, material, place):
    if not material.see_through:
        raise TracerError(
            f"{place}: no light gets into this material; use a dielectric or roughdielectric, or take it out"
        )
    if shape.turned == 0:
        raise TracerError(
            f"{place}: the shape is not closed, so it has no inside; use a cube, sphere or closed mesh"
        )
    if shape.turned < 0:
        raise TracerError(
            f"{place}: the normals point inwards, so the inside is outside; change flip_normals"
        )


def refuse_exterior(table):
    """TracerError if a shape says what is around it."""
    if "exterior" in table.table:
        raise TracerError(
            f"{table.place}.exterior: is not supported; take it out: where a shape is tells what is around it"
        )

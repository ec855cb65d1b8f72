"""The scene of the race, as each program wants it told."""

from xml.etree import ElementTree


def for_mitsuba(text, side, depth, sampler="independent", spp=16):
    """The XML of `castray export` with size, longest path and sampler put in."""
    root = ElementTree.fromstring(text)
    integrator, sensor = root.find("integrator"), root.find("sensor")
    ElementTree.SubElement(integrator, "integer", name="max_depth", value=str(depth))
    for name in ("width", "height"):
        sensor.find(f"film/integer[@name='{name}']").set("value", str(side))
    chosen = ElementTree.SubElement(sensor, "sampler", type=sampler)
    ElementTree.SubElement(chosen, "integer", name="sample_count", value=str(spp))
    return ElementTree.tostring(root, "unicode")

"""Whether the error of a picture is known, and how many independent numbers it comes from.

A pixel of independent samples has as many as samples. One of a low-discrepancy sampler has its replicates:
the spread of its samples is not its error (Celarek et al. 2019), and with one replicate it is not known.
"""

NO_ERROR = "samples of a low-discrepancy sampler are not independent: give --replicates for error bars"


def settings_of(picture):
    """A picture's settings as plain values, from a render or a file; None where it has none."""
    settings = getattr(picture, "settings", None)
    if settings is not None:
        return settings.as_dict()
    noted = getattr(picture, "notes", {}).get("settings")
    return noted if isinstance(noted, dict) and {"seed", "spp"} <= noted.keys() else None


def parts_of(picture):
    """Independent parts of each pixel, as Settings.parts; None where its samples are independent."""
    settings = settings_of(picture) or {}
    return None if settings.get("sampler", "independent") == "independent" else settings.get("replicates", 1)


def why_unknown(picture):
    """Why no variance is known of a picture with .rgb, in words; None where it is."""
    if getattr(picture, "variance", None) is None:
        return "no variance in it; only castray's .exr keeps it"
    return NO_ERROR if parts_of(picture) == 1 else None

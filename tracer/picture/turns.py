"""Ways in which a whole picture is the wrong way round."""

TURNS = {
    "left and right exchanged": lambda rgb: rgb[:, ::-1],
    "upside down": lambda rgb: rgb[::-1],
    "turned by half a turn": lambda rgb: rgb[::-1, ::-1],
    "red and blue exchanged": lambda rgb: rgb[..., ::-1],
}

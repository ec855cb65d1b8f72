"""The scene's shapes as triangles, made so that one sees what happens behind them, and where to look from."""

import numpy as np

from viewer.numerals import srgb

BACKGROUND = (0.055, 0.062, 0.078)
VIEW_ANGLE = 30.0
LAMP = (1.0, 0.97, 0.85)
FEW = 256  # so many faces are looked at one by one
WIDE = 8.0  # a floor that reaches so many times as far as what stands on it is ground
DIMMED = 0.62  # surfaces step back, so that the paths stand out


def rgb(text):
    """Red, green and blue from 0 to 1 of #rrggbb."""
    return tuple(int(text[k : k + 2], 16) / 255 for k in (1, 3, 5))


# Those of the page's style sheet where it has them, too.
COLOURS = {
    "others": rgb("#667286"),
    "walked": rgb("#ffffff"),
    "ahead": rgb("#99a8c2"),
    "lit": rgb("#ffd92e"),
    "blocked": rgb("#f0406a"),
    "what_if": rgb("#e36bff"),
    "twin": rgb("#33d9c7"),
    "idle": rgb("#8c94a3"),
    "here": rgb("#ffffff"),
    "n": rgb("#8ff5a8"),
    "wo": rgb("#66b8ff"),
    "wi": rgb("#f07f2c"),
    "light": rgb("#ffd92e"),
}


class Surface:
    """A shape of the scene, made so that one sees what happens behind it."""

    def __init__(self, scene, index, low, high):
        self.name = scene.shapes[index].name
        vertices, faces = scene.shapes[index].triangles()
        self.vertices, self.faces = np.asarray(vertices, float), np.asarray(faces, int)
        self.wall = _is_wall(self.vertices, low, high)
        # A room whose walls shine stays a room: the paths could not be seen before so much light.
        self.lamp = scene.is_light(index) and not _encloses(self.vertices, low, high)
        self.colour = LAMP if self.lamp else tuple(DIMMED * srgb(scene.display_colour(index)))
        self.opacity = 1.0 if self.wall else 0.3 if scene.is_see_through(index) else 0.55
        if self.wall:
            self.faces = self._turned((low + high) / 2)
        self.one_sided = self.wall or self._turn_outwards()

    def beside(self, planes, size):
        """This surface without what lies in the planes of walls: the two would fight for the pixel."""
        if not self.wall:
            self.faces = self.faces[~_pressed(self.vertices[self.faces], planes, size)]
        return self

    def _turned(self, point):
        """The faces, each turned towards a point."""
        away = self._lean(self.faces, point) < 0
        return np.where(away[:, None], self.faces[:, ::-1], self.faces)

    def _lean(self, faces, point):
        a, b, c = (self.vertices[faces[:, k]] for k in range(3))
        return np.einsum("ij,ij->i", np.cross(b - a, c - a), point - a)

    def _turn_outwards(self):
        """Turn the faces of a closed convex solid outwards; False, and nothing done, where it is none."""
        centre, slack = self.vertices.mean(axis=0), 1e-6 * np.ptp(self.vertices) ** 3
        if np.ptp(self.vertices, axis=0).min() == 0:
            return False
        if len(self.faces) > FEW:
            return bool(self._lean(self.faces, centre).max() <= slack)
        faces = self._turned(centre)[:, ::-1]
        if max(self._lean(faces, v).max() for v in self.vertices) > slack:
            return False
        self.faces = faces
        return True


def surfaces(scene):
    """Every shape of the scene; what is seen through comes last, over all the rest."""
    low, high = bounds(scene)
    shapes = [Surface(scene, index, low, high) for index in range(len(scene.shapes))]
    planes, size = walls(shapes, low, high), np.linalg.norm(high - low)
    return sorted((shape.beside(planes, size) for shape in shapes), key=lambda s: not s.wall)


def walls(surfaces, low, high):
    """The planes in which walls lie, as pairs of an axis and a coordinate."""
    found, slack = set(), 0.01 * np.linalg.norm(high - low)
    for surface in surfaces:
        if surface.wall:
            mine_low, mine_high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
            around = _encloses(surface.vertices, low, high)
            for axis in np.flatnonzero(around | (mine_high - mine_low < slack)):
                found |= {(int(axis), float(mine_low[axis])), (int(axis), float(mine_high[axis]))}
    return found


def bounds(scene):
    """The lowest and the highest corner of a scene."""
    low, high = (np.asarray(b, float) for b in scene.bounds())
    return low, high


def sight(scene):
    """The corners of what one looks at: of what stands on wide ground, of everything where there is no such
    ground."""
    low, high = bounds(scene)
    shapes = [np.asarray(shape.triangles()[0], float) for shape in scene.shapes]
    solid = [
        vertices
        for vertices in shapes
        if np.ptp(vertices, axis=0).min() > 0.01 * np.ptp(vertices, axis=0).max()
    ]
    if not solid:
        return low, high
    points = np.concatenate(solid)
    least, most = points.min(axis=0), points.max(axis=0)
    wide = np.linalg.norm(high - low) > WIDE * np.linalg.norm(most - least)
    return (least, most) if wide else (low, high)


def viewpoint(scene, low, high):
    """Where to look from: the scene's own camera, stepped aside and back until a box is seen."""
    camera = scene.camera
    forward, up = np.asarray(camera.forward, float), np.asarray(camera.up, float)
    side = np.cross(forward, up)
    back = -forward + 0.38 * side + 0.24 * up
    back /= np.linalg.norm(back)
    centre = (low + high) / 2
    distance = 0.5 * np.linalg.norm(high - low) / np.sin(np.radians(VIEW_ANGLE / 2)) * 0.8
    return {
        "position": (centre + distance * back).tolist(),
        "focalPoint": centre.tolist(),
        "viewUp": up.tolist(),
        "viewAngle": VIEW_ANGLE,
        "centerOfRotation": centre.tolist(),
    }


def _is_wall(vertices, low, high):
    """Whether a shape encloses the scene or lies flat on its bounds: then it must not hide what is inside."""
    slack = 0.01 * np.linalg.norm(high - low)
    mine_low, mine_high = vertices.min(axis=0), vertices.max(axis=0)
    flat = (mine_high - mine_low < slack) & ((mine_low - low < slack) | (high - mine_high < slack))
    return bool(flat.any()) or _encloses(vertices, low, high)


def _encloses(vertices, low, high):
    """Whether a shape stands around everything else."""
    return bool(np.all(np.ptp(vertices, axis=0) > 0.9 * (high - low)))


def _pressed(triangles, planes, size):
    """Which triangles (F, 3, 3) lie in one of some planes, in a scene of that size."""
    found = np.zeros(len(triangles), bool)
    for axis, place in planes:
        found |= (np.abs(triangles[..., axis] - place) < 1e-4 * size).all(axis=1)
    return found

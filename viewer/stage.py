"""The 3D view: the scene, the picked pixel's paths and the vectors of the current event, as vtk actors.

Nothing is rendered here: the browser draws. Every layer keeps its mesh, and new data is copied into it.
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkGenericOpenGLRenderWindow

from viewer.numerals import srgb
from viewer.traces import Strokes

BACKGROUND = (0.055, 0.062, 0.078)
VIEW_ANGLE = 30.0
LAMP = (1.0, 0.97, 0.85)
FEW = 256  # so many faces are looked at one by one
DIMMED = 0.62  # surfaces step back, so that the paths stand out
COLOURS = {
    "others": (0.36, 0.40, 0.48),
    "walked": (1.0, 1.0, 1.0),
    "ahead": (0.60, 0.66, 0.76),
    "lit": (1.0, 0.86, 0.35),
    "blocked": (1.0, 0.42, 0.38),
    "what_if": (0.89, 0.42, 1.0),
    "idle": (0.55, 0.58, 0.64),
    "here": (1.0, 1.0, 1.0),
    "n": (0.45, 0.90, 0.53),
    "wo": (0.40, 0.72, 1.0),
    "wi": (1.0, 0.62, 0.30),
    "light": (1.0, 0.90, 0.45),
}


class Layer:
    """One actor and the mesh it keeps."""

    def __init__(self, renderer, colour, opacity=1.0, lit=False, culled=False):
        self.mesh = vtkPolyData()
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(self.mesh)
        mapper.ScalarVisibilityOff()
        self.actor = vtkActor()
        self.actor.SetMapper(mapper)
        # blended over what is already there, in one pass: true transparency takes a software GL 40 ms more
        self.actor.SetForceOpaque(True)
        look = self.actor.GetProperty()
        self.look(colour, opacity)
        look.SetLighting(lit)
        look.SetBackfaceCulling(culled)
        look.SetAmbient(0.65)
        look.SetDiffuse(0.45)
        self.actor.SetVisibility(False)
        renderer.AddActor(self.actor)

    def look(self, colour, opacity):
        """Take on a colour."""
        look = self.actor.GetProperty()
        look.SetColor(*colour)
        look.SetOpacity(opacity)

    def show(self, points, cells):
        """Copy new data into the mesh. cells: triangles (F, 3), or line segments (F, 2)."""
        self.actor.SetVisibility(len(cells) > 0)
        if not len(cells):
            return
        self._points = np.ascontiguousarray(points, np.float32)  # vtk only borrows them
        corners = vtkPoints()
        corners.SetData(numpy_to_vtk(self._points))
        width = cells.shape[1]
        packed = np.column_stack([np.full(len(cells), width), cells]).astype(np.int64).ravel()
        array = vtkCellArray()
        array.ImportLegacyFormat(numpy_to_vtkIdTypeArray(packed, deep=True))
        fresh = vtkPolyData()
        fresh.SetPoints(corners)
        (fresh.SetPolys if width == 3 else fresh.SetLines)(array)
        self.mesh.DeepCopy(fresh)


class Surface:
    """A shape of the scene, made so that one sees what happens behind it."""

    def __init__(self, scene, index, low, high):
        self.name = scene.shapes[index].name
        vertices, faces = scene.shapes[index].triangles()
        self.vertices, self.faces = np.asarray(vertices, float), np.asarray(faces, int)
        self.wall = _is_wall(self.vertices, low, high)
        self.lamp = scene.is_light(index)
        self.colour = LAMP if self.lamp else tuple(DIMMED * srgb(scene.display_colour(index)))
        self.opacity = 1.0 if self.wall else 0.3 if scene.is_see_through(index) else 0.55
        if self.wall:
            self.faces = self._turned((low + high) / 2)
        self.one_sided = self.wall or self._turn_outwards()
        if not self.wall:
            self.faces = self.faces[~_pressed(self.vertices[self.faces], low, high)]

    def layer(self, renderer):
        """The actor: walls and solids show only the side they are made to be seen from."""
        layer = Layer(renderer, self.colour, self.opacity, lit=not self.lamp, culled=self.one_sided)
        layer.show(self.vertices, self.faces)
        return layer

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


class Stage:
    """Everything in the 3D view. window goes to the browser; labels are words at places, drawn in HTML."""

    def __init__(self, scene):
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(*BACKGROUND)
        self.window = vtkGenericOpenGLRenderWindow()
        self.window.AddRenderer(self.renderer)
        self._surfaces, self.layers = [], {}
        for name, colour in COLOURS.items():
            self.layers[name] = Layer(self.renderer, colour)
        self.labels = []
        self._light()
        self.furnish(scene)

    def _light(self):
        lamp = vtkLight()
        lamp.SetLightTypeToHeadlight()
        self.renderer.AddLight(lamp)

    def furnish(self, scene):
        """Put in another scene's surfaces and look at it."""
        for _, layer in self._surfaces:
            self.renderer.RemoveActor(layer.actor)
        low, high = (np.asarray(b, float) for b in scene.bounds())
        self.size = float(np.linalg.norm(high - low))
        self._bounds = low, high
        shapes = [Surface(scene, index, low, high) for index in range(len(scene.shapes))]
        shapes.sort(key=lambda s: not s.wall)  # what is seen through comes last, over all the rest
        self._surfaces = [(s, s.layer(self.renderer)) for s in shapes]
        self.strokes = Strokes(self.size)
        self.camera = viewpoint(scene, low, high)
        self._aim()

    def refit(self, scene):
        """Show the same scene with some words said differently, from where one looks."""
        if sorted(s.name for s, _ in self._surfaces) != sorted(shape.name for shape in scene.shapes):
            self.furnish(scene)
            return
        places = {shape.name: index for index, shape in enumerate(scene.shapes)}
        fitted = []
        for before, layer in self._surfaces:
            surface = Surface(scene, places[before.name], *self._bounds)
            if surface.vertices.tobytes() != before.vertices.tobytes():
                layer.show(surface.vertices, surface.faces)
            layer.look(surface.colour, surface.opacity)
            fitted.append((surface, layer))
        self._surfaces = fitted

    def _aim(self):
        eye = self.renderer.GetActiveCamera()
        eye.SetPosition(*self.camera["position"])
        eye.SetFocalPoint(*self.camera["focalPoint"])
        eye.SetViewUp(*self.camera["viewUp"])
        eye.SetViewAngle(VIEW_ANGLE)

    def draw(self, record, cursor, level, supposed=None, word=""):
        """Show the pixel's paths and the current event; level says what changed. supposed: the selected path
        as it would be, drawn beside it and marked by the word."""
        path = record.paths[cursor.path]
        drawn = self.strokes.event(path, cursor.event)
        if level != "event":
            drawn |= self.strokes.path(path) | self.strokes.others(record.paths, cursor.path)
            drawn |= self.strokes.what_if(supposed)
        for name, (points, cells) in drawn.items():
            self.layers[name].show(points, cells)
        self.labels = self.strokes.labels(path, cursor.event)
        if supposed is not None:
            self.labels.append({"text": word, "layer": "what_if", "at": self.strokes.parting(path, supposed)})


def viewpoint(scene, low, high):
    """Where to look from: the scene's own camera, stepped aside and back until everything is seen."""
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
    return bool(flat.any() or np.all(mine_high - mine_low > 0.9 * (high - low)))


def _pressed(triangles, low, high):
    """Which triangles (F, 3, 3) lie flat on the scene's bounds: there they would fight with a wall."""
    slack = 0.01 * np.linalg.norm(high - low)
    return ((triangles - low < slack).all(axis=1) | (high - triangles < slack).all(axis=1)).any(axis=1)

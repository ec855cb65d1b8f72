"""The 3D view: the scene's surfaces as vtk actors, the picked pixel's paths and vectors as bytes.

Nothing is rendered here: the browser draws. Surfaces go there by trame-vtk, which has it fetch each array in
a round trip of its own. What changes at every step is part of the page's state instead, so that words and
drawing come in one message; vtk only knows the actors it is drawn with.
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkGenericOpenGLRenderWindow

from viewer import hemisphere
from viewer.company import COMPANIONS
from viewer.solids import EMPTY
from viewer.surfaces import (
    BACKGROUND,
    COLOURS,
    VIEW_ANGLE,
    Surface,
    bounds,
    sight,
    surfaces,
    viewpoint,
    walls,
)
from viewer.traces import Strokes


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
        renderer.AddActor(self.actor)
        self.show(np.zeros((3, 3)), np.array([[0, 1, 2]]))  # of nothing at all the browser makes no actor

    def look(self, colour, opacity):
        """Take on a colour."""
        look = self.actor.GetProperty()
        look.SetColor(*colour)
        look.SetOpacity(opacity)

    def show(self, points, cells):
        """Copy new data into the mesh. cells: triangles (F, 3)."""
        self.actor.SetVisibility(len(cells) > 0)
        if not len(cells):
            return
        array = vtkCellArray()
        array.ImportLegacyFormat(numpy_to_vtkIdTypeArray(legacy(cells).astype(np.int64), deep=True))
        fresh = vtkPolyData()
        fresh.SetPoints(_points(points))
        fresh.SetPolys(array)
        self.mesh.DeepCopy(fresh)


def _points(places):
    """Places (N, 3) as vtk's points."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(places, np.float32), deep=True))
    return points


def legacy(cells):
    """Cells (F, K) as vtk has them: each with its length before it, one after another."""
    return np.column_stack([np.full(len(cells), cells.shape[1]), cells]).ravel()


def packed(points, cells):
    """Points and cells, triangles (F, 3) or line segments (F, 2), as bytes: float32 and uint32."""
    return np.asarray(points, "<f4").tobytes(), legacy(cells).astype("<u4").tobytes()


def layer_of(surface, renderer):
    """The actor of a Surface: walls and solids show only the side they are made to be seen from."""
    layer = Layer(renderer, surface.colour, surface.opacity, lit=not surface.lamp, culled=surface.one_sided)
    layer.show(surface.vertices, surface.faces)
    return layer


class Stage:
    """Everything in the 3D view. window goes to the browser; labels are words at places, drawn in HTML.

    strokes: {level: [(number of the actor, *packed), ...]}, of a path, an event, and over its vertex.
    """

    def __init__(self, scene):
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(*BACKGROUND)
        self.window = vtkGenericOpenGLRenderWindow()
        self.window.AddRenderer(self.renderer)
        self._surfaces, self.labels = [], []
        self.strokes = {"path": [], "event": [], "over": []}
        for colour in COLOURS.values():
            Layer(self.renderer, colour)
        for name, colour in hemisphere.COLOURS.items():  # before the surfaces, which would hide them
            lit = name in hemisphere.LIT
            Layer(self.renderer, colour, hemisphere.OPACITY.get(name, 1.0), lit, culled=lit)
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
        self._bounds = bounds(scene)
        low, high = sight(scene)
        self.size = float(np.linalg.norm(high - low))
        self._surfaces = [(s, layer_of(s, self.renderer)) for s in surfaces(scene)]
        self._draws = Strokes(self.size)
        self.camera = viewpoint(scene, low, high)
        self._aim()

    def refit(self, scene):
        """Show the same scene with some words said differently, from where one looks."""
        if sorted(s.name for s, _ in self._surfaces) != sorted(shape.name for shape in scene.shapes):
            self.furnish(scene)
            return
        places = {shape.name: index for index, shape in enumerate(scene.shapes)}
        fitted, planes = [], walls([surface for surface, _ in self._surfaces], *self._bounds)
        whole = float(np.linalg.norm(np.subtract(*self._bounds)))
        for before, layer in self._surfaces:
            surface = Surface(scene, places[before.name], *self._bounds).beside(planes, whole)
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

    def draw(self, record, cursor, level, beside=None, over=None):
        """Show the pixel's paths and the current event; level says what changed. beside: paths drawn beside
        the selected one, {one of COMPANIONS: Companion}; over: the Hemisphere over its vertex."""
        beside = beside or {}
        path = record.paths[cursor.path]
        if level != "event":
            drawn = self._draws.path(path) | self._draws.others(record.paths, cursor.path)
            for name in COMPANIONS:
                there = beside.get(name)
                drawn[name] = self._draws.companion(there.path, there.since) if there else EMPTY
            self.strokes["path"] = _numbered(drawn)
        self.strokes["event"] = _numbered(self._draws.event(path, cursor.event))
        self.labels = self._draws.labels(path, cursor.event)
        for name, there in beside.items():
            at = there.at or self._draws.parting(path, there.path)
            self.labels.append({"text": there.word, "layer": name, "at": at})
        self.strokes["over"] = _numbered(over.drawn if over else dict.fromkeys(hemisphere.COLOURS, EMPTY))
        self.labels += over.labels if over else []


def _numbered(drawn):
    """{layer: (points, cells)} as a list of (number of the actor, *packed)."""
    numbers = {name: k for k, name in enumerate((*COLOURS, *hemisphere.COLOURS))}
    return [(numbers[name], *packed(points, cells)) for name, (points, cells) in drawn.items()]

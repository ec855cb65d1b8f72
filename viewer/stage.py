"""The 3D view: the scene, the picked pixel's paths and the vectors of the current event, as vtk actors.

Nothing is rendered here: the browser draws. Every layer keeps its mesh, and new data is copied into it.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkGenericOpenGLRenderWindow

from viewer import hemisphere
from viewer.solids import EMPTY
from viewer.surfaces import BACKGROUND, COLOURS, VIEW_ANGLE, Surface, bounds, surfaces, viewpoint, walls
from viewer.traces import Strokes

COMPANIONS = ("what_if", "twin")  # paths beside the selected one


@dataclass(frozen=True)
class Companion:
    """A path drawn beside the selected one, from its event `since` on; word: marks the place `at`, or where
    its way leaves the other's."""

    path: Any
    word: str
    since: int = 0
    at: list | None = None


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


def layer_of(surface, renderer):
    """The actor of a Surface: walls and solids show only the side they are made to be seen from."""
    layer = Layer(renderer, surface.colour, surface.opacity, lit=not surface.lamp, culled=surface.one_sided)
    layer.show(surface.vertices, surface.faces)
    return layer


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
        self._over = {}  # layers of the hemisphere over the vertex, there from its first showing on
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
        self._bounds = low, high = bounds(scene)
        self.size = float(np.linalg.norm(high - low))
        self._surfaces = [(s, layer_of(s, self.renderer)) for s in surfaces(scene)]
        self.strokes = Strokes(self.size)
        self.camera = viewpoint(scene, low, high)
        self._aim()

    def refit(self, scene):
        """Show the same scene with some words said differently, from where one looks."""
        if sorted(s.name for s, _ in self._surfaces) != sorted(shape.name for shape in scene.shapes):
            self.furnish(scene)
            return
        places = {shape.name: index for index, shape in enumerate(scene.shapes)}
        fitted, planes = [], walls([surface for surface, _ in self._surfaces], *self._bounds)
        for before, layer in self._surfaces:
            surface = Surface(scene, places[before.name], *self._bounds).beside(planes, self.size)
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
        drawn = self.strokes.event(path, cursor.event)
        if level != "event":
            drawn |= self.strokes.path(path) | self.strokes.others(record.paths, cursor.path)
            for name in COMPANIONS:
                there = beside.get(name)
                drawn[name] = self.strokes.companion(there.path, there.since) if there else EMPTY
        for name, (points, cells) in drawn.items():
            self.layers[name].show(points, cells)
        self.labels = self.strokes.labels(path, cursor.event)
        for name, there in beside.items():
            at = there.at or self.strokes.parting(path, there.path)
            self.labels.append({"text": there.word, "layer": name, "at": at})
        self._show_over(over)

    def _show_over(self, over):
        """The Hemisphere's layers; None takes them away."""
        if over is not None and not self._over:
            self._make_room(hemisphere)
        for name, layer in self._over.items():
            layer.show(*(EMPTY if over is None else over.drawn[name]))
        if over is not None:
            self.labels += over.labels

    def _make_room(self, drawn):
        """Layers for what a module has the COLOURS of, before the surfaces, which would hide them."""
        for _, layer in self._surfaces:
            self.renderer.RemoveActor(layer.actor)
        for name, colour in drawn.COLOURS.items():
            lit = name in drawn.LIT
            self._over[name] = Layer(self.renderer, colour, drawn.OPACITY.get(name, 1.0), lit, culled=lit)
        self._surfaces = [(s, layer_of(s, self.renderer)) for s, _ in self._surfaces]

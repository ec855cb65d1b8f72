"""The table of floors: a module imports only from lower ones, and the tracer stands without heavy friends.

Inside one folder of several modules (bsdf/, shape/, light/, ...) neighbours may import one another: a folder
is one concept and stands on one floor. Two different concepts on one floor may not. The package `tracer` is a
door: it gathers public names from every floor below, so no module of the tracer imports from it.
"""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("tracer", "viewer", "lessons", "scenes")

FLOORS = {
    "tracer.lanes": 0,
    "tracer.frame": 0,
    "tracer.warp": 0,
    "tracer.sampler": 0,
    "tracer.derived": 0,
    "tracer.event": 0,
    "tracer.events": 0,
    "tracer.settings": 0,
    "tracer.tails": 0,
    "tracer.bsdf": 1,
    "tracer.shape": 1,
    "tracer.camera": 1,
    "tracer.film": 1,
    "tracer.picture": 1,
    "tracer.texture": 1,
    "tracer.recorder": 1,
    "tracer.light": 2,
    "tracer.material_bench": 2,
    "tracer.definition": 2,
    "tracer.medium": 2,
    "tracer.resolution": 2,
    "tracer.scene": 3,
    "tracer.scene_file": 4,
    "tracer.self_hit": 4,
    "tracer.integrator": 4,
    "tracer.engine": 5,
    "tracer.what_if": 6,
    "tracer.trace": 6,
    "tracer.cluster": 7,
    "tracer.doctor": 7,
    "tracer.learner": 7,
    "tracer.twin": 7,
    "tracer.testing": 8,
    "tracer": 8.5,
    "scenes": 0,
    "lessons": 9,
    "viewer": 10,
}

# On the ground floor only lanes and vectors come before the rest.
ORDERED = {
    ("tracer.frame", "tracer.lanes"),
    ("tracer.sampler", "tracer.lanes"),
    ("tracer.event", "tracer.lanes"),
    ("tracer.derived", "tracer.frame"),
    ("tracer.events", "tracer.derived"),
    ("tracer.events", "tracer.event"),
    ("tracer.warp", "tracer.frame"),
}

HEAVY = (
    "pyvista",
    "vtk",
    "vtkmodules",
    "trimesh",
    "embreex",
    "trame",
    "moderngl",
    "distributed",
    "duckdb",
    "matplotlib",
    "PIL",
    "scipy",
)


def modules(root):
    """(dotted name, path) of every module under the packages of `root`."""
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts), path


def concept(name):
    """The entry of FLOORS a module belongs to: itself or the nearest folder above; None if there is none."""
    if name == "tracer" or name in FLOORS:
        return name
    above = name.rpartition(".")[0]
    return None if above in ("", "tracer") else concept(above)


def statements(node, runs=True):
    """(statement, whether it runs at import) of all below a node; no expression holds an import."""
    typing = isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")
    runs = runs and not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    for part in ("body", "orelse", "handlers", "finalbody", "cases"):
        for inner in getattr(node, part, ()):
            eager = runs and not (typing and part == "body")
            yield inner, eager
            yield from statements(inner, eager)


def imports(path):
    """(line, dotted name, whether it runs at import) of every import; `from a import b` counts as a.b."""
    for node, eager in statements(ast.parse(path.read_text(encoding="utf-8"), str(path))):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name, eager) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                yield node.lineno, "." * node.level + (node.module or ""), eager
            else:
                yield from ((node.lineno, f"{node.module}.{alias.name}", eager) for alias in node.names)


def complaints(root):
    """Every broken rule, one line each."""
    for name, path in modules(root):
        here = concept(name)
        if here is None:
            yield f"{name} has no floor: add it to FLOORS in tests/test_layers.py, and to ARCHITECTURE.md"
            continue
        for line, target, eager in imports(path):
            place = f"{path.relative_to(root).as_posix()}:{line}"
            if target.startswith("."):
                yield f"{place}: import absolutely, so that the first lines show where the module stands"
                continue
            top = target.partition(".")[0]
            if top in HEAVY and eager and name.startswith("tracer"):
                yield f"{place}: the tracer imports {top} where it is used, inside a function"
            if top not in PACKAGES:
                continue
            there = concept(target) or concept(target.rpartition(".")[0]) or top
            if there != here and FLOORS[there] >= FLOORS[here] and (here, there) not in ORDERED:
                yield f"{place}: {here} (floor {FLOORS[here]}) imports {there} (floor {FLOORS[there]})"


def test_each_module_imports_only_from_lower_floors():
    broken = list(complaints(ROOT))
    assert not broken, "\n" + "\n".join(broken)


def test_no_floor_is_kept_for_a_module_that_is_gone():
    known = {concept(name) for name, _ in modules(ROOT)}
    planned = {"tracer.trace", "tracer.doctor", "lessons", "scenes"}
    assert FLOORS.keys() - known <= planned


@pytest.mark.parametrize(
    ("where", "text", "said"),
    [
        ("tracer/frame.py", "from tracer.scene import Scene", "tracer.frame (floor 0) imports tracer.scene"),
        ("tracer/film.py", "from tracer import load", "tracer.film (floor 1) imports tracer (floor 8.5)"),
        ("tracer/camera.py", "from tracer.film import fold", "(floor 1) imports tracer.film (floor 1)"),
        ("tracer/scene.py", "def f():\n    import viewer.cli", "imports viewer"),
        ("tracer/shape/mesh.py", "import trimesh", "imports trimesh where it is used"),
        ("tracer/shape/mesh.py", "from .quad import Quad", "import absolutely"),
        ("tracer/gossip.py", "", "tracer.gossip has no floor"),
    ],
)
def test_a_broken_floor_is_seen(tmp_path, where, text, said):
    (tmp_path / where).parent.mkdir(parents=True)
    (tmp_path / where).write_text(text, encoding="utf-8")
    (found,) = complaints(tmp_path)
    assert said in found


@pytest.mark.parametrize(
    ("where", "text"),
    [
        ("tracer/shape/mesh.py", "def f():\n    import trimesh"),
        ("tracer/shape/mesh.py", "from tracer.shape.quad import Quad"),
        ("tracer/light/area.py", "from tracer.warp import disk"),
        ("viewer/cli.py", "from viewer.cursor import Cursor\nimport tracer\nimport pyvista"),
        ("tracer/__init__.py", "from tracer.scene_file import load"),
    ],
)
def test_a_lawful_import_is_let_through(tmp_path, where, text):
    (tmp_path / where).parent.mkdir(parents=True)
    (tmp_path / where).write_text(text, encoding="utf-8")
    assert not list(complaints(tmp_path))


def test_importing_the_tracer_pulls_in_nothing_heavy():
    names = "[getattr(tracer, name) for name in tracer.__all__]"  # each is imported when it is first used
    code = f"import sys, tracer; {names}; print(*(name for name in {HEAVY} if name in sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, encoding="utf-8", check=True
    )
    assert done.stdout.split() == []

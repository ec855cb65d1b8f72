"""Counts the NumPy calls that the tracer makes in one wave, and the bytes of the arrays they return.

Every operator, subscript and call in the tracer's source is replaced, when it is imported, by one that counts
if arrays take part. That sees operators, which no profiler does, gives the same numbers on every machine, and
works on any commit. What a NumPy function does inside counts as one call; a view has no bytes.

    python tests/counting.py FOLDER            calls and bytes, in all and by module and call, as JSON
    python tests/counting.py FOLDER --seconds  the same wave without counting: seconds
    python tests/counting.py FOLDER --default  lamps sampled as they are unless one asks for area
"""

import argparse
import ast
import dataclasses
import importlib.abc
import importlib.machinery
import json
import sys
import time
from collections import Counter
from functools import partial
from pathlib import Path

import numpy as np

SIDE, SPP, DEPTH = 128, 2, 8  # one wave of 32768 paths
CALLS, BYTES = Counter(), Counter()
WARM, TIMES = 3, 10  # waves before time is taken, and of which the fastest counts


def seen(place, name, result, *before):
    """Count a call that gave `result`, if that is none of the arrays there were before; give it back.

    place: the module that calls; of the helpers below it is the first argument, too.
    """
    CALLS[place, name] += 1
    fresh = isinstance(result, np.ndarray) and result.flags.owndata
    if fresh and not any(result is array for array in before):
        BYTES[place, name] += result.nbytes
    return result


def operated(place, name, result):
    """An operator's result, counted if it is an array."""
    return seen(place, name, result) if isinstance(result, np.ndarray) else result


def used(place, name, value):
    """A value that an operator puts into what may be an array, counted if it is one itself."""
    if isinstance(value, np.ndarray):
        CALLS[place, name] += 1
    return value


def item(place, table, key):
    """table[key], counted if it is an array's."""
    return seen(place, "[]", table[key]) if isinstance(table, np.ndarray) else table[key]


def called(place, function):
    """A function, or one that counts where it is NumPy's: a ufunc, a function, or a method of an array."""
    owner = getattr(function, "__self__", None)
    of_numpy = (getattr(function, "__module__", None) or "").partition(".")[0] == "numpy"
    if isinstance(function, type) or not (of_numpy or isinstance(owner, (np.ndarray, np.ufunc))):
        return function
    name = getattr(function, "__name__", "?")

    def counted(*arguments, **named):
        return seen(place, name, function(*arguments, **named), owner, *arguments)

    return counted


class Counting(ast.NodeTransformer):
    """Source that counts."""

    def _call(self, helper, *arguments, at):
        made = ast.Call(ast.Name(f"__{helper}__", ast.Load()), list(arguments), [])
        return ast.fix_missing_locations(ast.copy_location(made, at))

    def _operator(self, node, operator):
        self.generic_visit(node)
        return self._call("operated", ast.Constant(type(operator).__name__), node, at=node)

    def visit_BinOp(self, node):
        return self._operator(node, node.op)

    def visit_UnaryOp(self, node):
        return self._operator(node, node.op)

    def visit_Compare(self, node):
        return self._operator(node, node.ops[0])

    def visit_AugAssign(self, node):
        self.generic_visit(node)
        name = ast.Constant(f"{type(node.op).__name__}=")
        node.value = self._call("used", name, node.value, at=node)
        return node

    def visit_Assign(self, node):
        self.generic_visit(node)
        if any(isinstance(target, ast.Subscript) for target in node.targets):
            node.value = self._call("used", ast.Constant("[]="), node.value, at=node)
        return node

    def visit_Subscript(self, node):
        self.generic_visit(node)
        return (
            node
            if not isinstance(node.ctx, ast.Load)
            else self._call("item", node.value, _key(node.slice), at=node)
        )

    def visit_Call(self, node):
        self.generic_visit(node)
        node.func = self._call("called", node.func, at=node)
        return node

    def visit_AnnAssign(self, node):
        if node.value is not None:
            node.value = self.visit(node.value)
        return node

    def visit_arg(self, node):
        return node


def _key(key):
    """What stands between brackets, as an expression."""
    if isinstance(key, ast.Slice):
        parts = [part or ast.Constant(None) for part in (key.lower, key.upper, key.step)]
        return ast.Call(ast.Name("slice", ast.Load()), parts, [])
    if isinstance(key, ast.Tuple):
        key.elts = [_key(part) for part in key.elts]
    return key


class Loader(importlib.machinery.SourceFileLoader):
    """Loads a module so that it counts, without leaving a compiled file behind."""

    def get_code(self, fullname):
        return self.source_to_code(self.get_data(self.path), self.path)

    def source_to_code(self, data, path, *, _optimization=-1):
        tree = ast.fix_missing_locations(Counting().visit(ast.parse(data, path)))
        return compile(tree, path, "exec", dont_inherit=True)

    def exec_module(self, module):
        for helper in (operated, used, item, called):
            setattr(module, f"__{helper.__name__}__", partial(helper, module.__name__))
        super().exec_module(module)


class Finder(importlib.abc.MetaPathFinder):
    """Gives the tracer's modules that loader."""

    def find_spec(self, name, path, target=None):
        if name.partition(".")[0] != "tracer":
            return None
        spec = importlib.machinery.PathFinder.find_spec(name, path, target)
        if spec is not None and spec.origin:
            spec.loader = Loader(name, spec.origin)
        return spec


def job(by_area=True):
    """A function that traces one wave of cornell_unit by the path integrator.

    by_area: whether lamps are sampled by area, once the only way, or as the commit has it by default.
    """
    import tracer
    from tracer.engine import waves
    from tracer.integrator.steps import RIGHT

    options = {"width": SIDE, "height": SIDE, "spp": SPP, "max_depth": DEPTH}
    if by_area:
        options["light_sampling"] = "area"
    known = {field.name for field in dataclasses.fields(tracer.Settings)}
    settings = tracer.Settings(**{name: value for name, value in options.items() if name in known})
    scene = tracer.load("cornell_unit").at(settings)
    (task,) = waves.tasks(settings)
    return lambda: waves.trace(scene, settings, RIGHT, task)


def counted(by_area=True):
    """What a wave costs, after one that nobody counts."""
    trace = job(by_area)
    trace()
    CALLS.clear()
    BYTES.clear()
    result = trace()
    return {
        "calls": CALLS.total(),
        "bytes": BYTES.total(),
        "rays": int(result.rays),
        "calls_by": {" ".join(key): n for key, n in CALLS.most_common()},
        "bytes_by": {" ".join(key): n for key, n in BYTES.most_common()},
    }


def seconds():
    """The fastest of some waves."""
    trace, times = job(), []
    for _ in range(WARM + TIMES):
        began = time.perf_counter()
        trace()
        times.append(time.perf_counter() - began)
    return min(times[WARM:])


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("folder", type=Path, help="a checkout of castray")
    words.add_argument("--seconds", action="store_true")
    words.add_argument("--default", action="store_true")
    asked = words.parse_args()
    sys.path.insert(0, str(asked.folder.resolve()))
    if not asked.seconds:
        sys.meta_path.insert(0, Finder())
    print(json.dumps(seconds() if asked.seconds else counted(not asked.default)))


if __name__ == "__main__":
    main()

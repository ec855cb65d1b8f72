"""What the code imports is declared, what is declared is pinned, and the pins are what is installed."""

import ast
import re
import sys
import tomllib
from importlib import metadata

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from suite import ROOT

OURS = {"tracer", "viewer", "lessons", "scenes"}
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
PIN = re.compile(r"[A-Za-z0-9][\w.-]*==[\w.+!]+")


def pins():
    """{canonical name: version} of constraints.txt."""
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").split()
    return {canonicalize_name(name): version for name, version in (line.split("==") for line in lines)}


def declared(*extras):
    """Canonical names of the requirements, the extras' included."""
    lines = PROJECT["dependencies"] + [line for e in extras for line in PROJECT["optional-dependencies"][e]]
    return {canonicalize_name(Requirement(line).name) for line in lines}


def needed(names):
    """The names and everything they need on this system, in turn."""
    seen, ahead = set(), set(names)
    while ahead:
        seen |= ahead
        lines = [line for name in ahead for line in metadata.requires(name) or ()]
        wanted = [Requirement(line) for line in lines]
        here = [r for r in wanted if r.marker is None or r.marker.evaluate({"extra": ""})]
        ahead = {canonicalize_name(r.name) for r in here} - seen
    return seen


def imported(folder):
    """Top-level names of every module that a folder's code imports, at any place."""
    for path in (ROOT / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                yield from (alias.name.partition(".")[0] for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and not node.level:
                yield node.module.partition(".")[0]
            elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("find_spec"):
                yield from (a.value for a in node.args if isinstance(a, ast.Constant))


@pytest.mark.slow
@pytest.mark.parametrize("folder", sorted(OURS))
def test_what_is_imported_is_declared(folder):
    strangers = set(imported(folder)) - OURS - set(sys.stdlib_module_names)
    owners = metadata.packages_distributions()
    for module in strangers:
        known = {canonicalize_name(name) for name in owners.get(module, [module])}
        assert known & declared("cluster", "embree", "gl"), (
            f"{folder} imports {module}, which pyproject.toml does not name"
        )


@pytest.mark.slow
def test_what_is_declared_is_imported():
    owners = metadata.packages_distributions()
    used = {name for folder in OURS for module in imported(folder) for name in owners.get(module, [module])}
    assert not declared() - {canonicalize_name(name) for name in used}


def test_constraints_are_names_and_versions_in_order():
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    assert all(PIN.fullmatch(line) for line in lines)
    assert lines == sorted(lines, key=str.lower)
    assert len(pins()) == len(lines)


def test_everything_needed_is_pinned_and_installed_as_pinned():
    installed = {name: metadata.version(name) for name in needed(declared("dev"))}
    assert installed == {name: pins().get(name) for name in installed}


def test_nothing_is_pinned_that_is_not_needed():
    elsewhere = {"colorama"}  # Windows
    older = {"importlib-metadata", "lazy-importer", "zipp"}  # likewise, by older ones
    newer = {"typing-extensions", "tzdata"}  # asked for by some Pythons only
    peers = {"drjit", "mitsuba"}  # installed by `make peers` only
    assert pins().keys() - needed(declared("dev")) <= elsewhere | older | newer | peers


@pytest.mark.slow
def test_the_peer_is_installed_as_pinned_if_it_is():
    pytest.importorskip("mitsuba")
    assert {name: metadata.version(name) for name in needed(declared("peers"))}.items() <= pins().items()

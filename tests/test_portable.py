"""What would break elsewhere: an encoding left to chance, an API of only some systems, a path of ours."""

import ast
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
OURS = ("tracer", "viewer", "lessons", "scenes")
SOME_SYSTEMS = {"fcntl", "grp", "msvcrt", "pty", "pwd", "resource", "syslog", "termios", "tty", "winreg"}
SOME_SYSTEMS |= {"os.fork", "os.geteuid", "os.getuid", "os.sched_getaffinity", "os.setsid", "os.uname"}
MACHINE_PATH = re.compile(r"(?<![\w.<-])/(?:home|root|Users|work|mnt|private/var)/[\w.-]+|\b[A-Z]:\\Users\\")


def sources(*folders):
    """Every Python file of ours under the named folders."""
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


def tracked():
    """Every file that is part of the project: what git knows, or all files where there is no git."""
    if not (shutil.which("git") and (ROOT / ".git").exists()):
        return [path for path in sources(*OURS, "tests")]
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    return [ROOT / name for name in listed.decode("utf-8").split("\0") if name and (ROOT / name).is_file()]


def complaints(tree, wrong):
    """`line: code` of every node that is wrong."""
    spared = {id(inner) for node in ast.walk(tree) if _expects_none(node) for inner in node.body}
    return [
        f"{node.lineno}: {ast.unparse(node)[:90]}"
        for node in ast.walk(tree)
        if id(node) not in spared and wrong(node)
    ]


def _expects_none(node):
    """Whether it tries an import and knows what to do without."""
    return isinstance(node, ast.Try) and any(
        h.type is not None and ast.unparse(h.type) == "ImportError" for h in node.handlers
    )


def leaves_encoding_to_chance(node):
    """A call that reads or writes text (a file, a child's output) and does not say how it is encoded."""
    if not isinstance(node, ast.Call):
        return False
    said = {keyword.arg: keyword.value for keyword in node.keywords}
    if "encoding" in said:
        return False
    method = node.func.attr if isinstance(node.func, ast.Attribute) else None
    if method in ("read_text", "write_text"):
        return len(node.args) < (2 if method == "write_text" else 1)
    if method == "open":  # a path's; others by that name are known by what they are given
        modes = [*node.args[:1], *filter(None, [said.get("mode")])]
        return all(isinstance(m, ast.Constant) and set(str(m.value)) <= set("rwaxt+") for m in modes)
    if isinstance(node.func, ast.Name) and node.func.id == "open":
        return _is_text(said.get("mode", node.args[1] if len(node.args) > 1 else None))
    return any(ast.unparse(said.get(name, node)) == "True" for name in ("text", "universal_newlines"))


def _is_text(mode):
    return mode is None or not (isinstance(mode, ast.Constant) and "b" in str(mode.value))


def is_not_everywhere(node):
    """A use of what only some systems have, unless a function asks for it when it runs."""
    if isinstance(node, ast.Import):
        return any(alias.name in SOME_SYSTEMS for alias in node.names)
    if isinstance(node, ast.ImportFrom):
        return node.module in SOME_SYSTEMS or any(
            f"{node.module}.{a.name}" in SOME_SYSTEMS for a in node.names
        )
    return isinstance(node, ast.Attribute) and ast.unparse(node) in SOME_SYSTEMS


def forks(node):
    """multiprocessing by fork: Windows has none, and a forked process of threads hangs."""
    return isinstance(node, ast.Constant) and node.value in ("fork", "forkserver")


def found(wrong, *folders):
    """`file:line: code` over whole folders."""
    return [
        f"{path.relative_to(ROOT).as_posix()}:{line}"
        for path in sources(*folders)
        for line in complaints(ast.parse(path.read_text(encoding="utf-8")), wrong)
    ]


@pytest.mark.slow
def test_text_states_its_encoding():
    broken = found(leaves_encoding_to_chance, *OURS, "tests")
    assert not broken, "\n" + "\n".join(broken)


@pytest.mark.parametrize(
    "code",
    [
        "open(p)",
        "open(p, 'w')",
        "p.open()",
        "p.read_text()",
        "p.write_text(s)",
        "subprocess.run(c, text=True)",
    ],
)
def test_an_unstated_encoding_is_seen(code):
    assert complaints(ast.parse(code), leaves_encoding_to_chance)


@pytest.mark.parametrize(
    "code",
    [
        "open(p, 'rb')",
        "open(p, encoding='utf-8')",
        "p.open('wb')",
        "p.read_text('utf-8')",
        "webbrowser.open(url)",
        "Response(text='no')",
    ],
)
def test_a_stated_encoding_is_let_through(code):
    assert not complaints(ast.parse(code), leaves_encoding_to_chance)


@pytest.mark.slow
def test_nothing_is_used_that_only_some_systems_have():
    broken = found(is_not_everywhere, *OURS) + found(forks, *OURS)
    assert not broken, "\n" + "\n".join(broken)


def test_an_import_that_may_fail_is_let_through():
    tried = "try:\n    import resource\nexcept ImportError:\n    pass"
    assert not complaints(ast.parse(tried), is_not_everywhere)


@pytest.mark.parametrize("code", ["import fcntl", "from os import fork", "os.setsid()"])
def test_an_api_of_some_systems_is_seen(code):
    assert complaints(ast.parse(code), is_not_everywhere)


def test_every_file_is_utf8_and_names_no_path_of_a_machine():
    broken = []
    for path in tracked():
        if path.suffix in (".png", ".exr", ".npy", ".npz", ".ply", ".woff2", ".ttf", ".otf") or path == Path(
            __file__
        ):
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            broken += [f"{path.relative_to(ROOT)}:{number}: {line.strip()}"] * bool(MACHINE_PATH.search(line))
    assert not broken, "\n" + "\n".join(broken)

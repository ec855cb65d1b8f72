"""`castray WORDS` as a process of its own, forked from one that has the imports behind it.

Half of what a short command takes is importing. The server that forks is clean: it has run no test and no
command, only imports; so what a command finds is what it would find in a process from the shell.
"""

import atexit
import multiprocessing
import os
import sys
import tempfile
from pathlib import Path
from subprocess import CompletedProcess, TimeoutExpired

# What most commands import when they run; none of it starts a thread.
WARM = (
    "numpy",
    "rich.console",
    "rich.table",
    "viewer.cli",
    *(
        f"viewer.commands.{path.stem}"
        for path in Path(__file__).parent.parent.glob("viewer/commands/[a-z]*.py")
    ),
    "tracer.engine.picture",
    "tracer.scene_file.load",
    "tracer.doctor",
    "tracer.trace",
    "lessons.zoo",
)
HERE = "forkserver" in multiprocessing.get_all_start_methods()


def run(words, cwd, env, timeout):
    """Run it to its end."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(list(WARM))
    with tempfile.TemporaryDirectory() as folder:
        out, err = Path(folder, "out"), Path(folder, "err")
        process = context.Process(target=_command, args=(list(map(str, words)), str(cwd), env, out, err))
        process.start()
        process.join(timeout)
        if process.exitcode is None:
            process.kill()
            process.join()
            raise TimeoutExpired(words, timeout)
        said = (path.read_text(encoding="utf-8") for path in (out, err))
        return CompletedProcess(words, process.exitcode, *said)


def _command(words, cwd, env, out, err):
    """The process itself."""
    os.environ.clear()
    os.environ.update(env)
    os.chdir(cwd)
    for number, name, path in ((1, "stdout", out), (2, "stderr", err)):
        os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND), number)
        setattr(sys, name, open(number, "w", encoding="utf-8", closefd=False))  # noqa: SIM115
    sys.argv = ["castray", *words]
    from viewer.cli import main

    try:
        sys.exit(main())
    finally:
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()

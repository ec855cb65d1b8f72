"""The `castray` command. What one command needs is imported when it runs: `--help` waits for none of it."""

import os
import sys
import warnings

from cyclopts import App, CycloptsError

from tracer.settings import TracerError

# name: what it does, as `castray --help` says it. Its module in viewer/commands/ has a function of that name.
COMMANDS = {
    "view": "Open the viewer: click a pixel, step through its paths.",
    "render": "Render a scene to a picture.",
    "inspect": "Show the events of a pixel's paths, and how their light adds up to the pixel.",
    "doctor": "Hold the laws of light transport against a trace: what is wrong, where, and which mistake.",
    "query": "Find the paths of a recording that did something.",
    "diff": "Compare two pictures: is their difference more than noise?",
    "check": "Run your own cast_ray and hold the laws of light transport against what it did.",
    "bsdf": "Put one material on the bench: its properties, albedo and Fresnel curves, and a plot.",
    "bench": "Measure run time against error: which estimator for this scene?",
    "export": "Write a scene as Mitsuba 3 XML, which castray and Mitsuba both read.",
    "log": "Check the log of your own tracer; write castray.h, which logs from C++.",
    "bugs": "List the bug zoo: what each bug looks like, and which law it breaks; draw them.",
}


def _version():
    from importlib.metadata import version

    return version("castray")


app = App(
    name="castray",
    help="A step-through debugger for path tracing: click a pixel, walk its paths, read every number.",
    help_format="plaintext",
    version=_version,
)
for name, help in COMMANDS.items():
    app.command(f"viewer.commands.{name}:{name}", name=name, help=help)


def _say(message, *_):
    """A message as one line on standard error; what is not to be seen, as its code."""
    line = " ".join(str(message).split())
    shown = (c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in line)
    print(f"castray: {''.join(shown)}", file=sys.stderr)


def main(words=None):
    """Run `castray WORDS`. Bad input is one line on standard error and exit code 2."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal that lacks a character shows "?"
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say
            code = app(words, exit_on_error=False, print_error=False)
    except (TracerError, CycloptsError) as error:
        _say(error)
        sys.exit(2)
    except MemoryError:
        print("castray: not enough memory for that; try a smaller --size or fewer --spp", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("castray: stopped", file=sys.stderr)
        sys.exit(130)
    except BrokenPipeError:
        # Who reads us has seen enough; keep Python from complaining about it at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(0)
    sys.exit(code if isinstance(code, int) else 0)


if __name__ == "__main__":
    main()

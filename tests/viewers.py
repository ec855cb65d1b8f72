"""A viewer in a process of its own, for the tests and the bench."""

import os
import subprocess
import sys

from suite import ROOT

SWITCHES = (
    "--headless=new",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
)
SMALL = ("--size", "64", "64", "--spp", "8", "--max-depth", "6")


class Server:
    """`castray view WORDS`, started and ready; `address` is the line it printed."""

    def __init__(self, *words, cwd=ROOT):
        code = "import sys; from viewer.cli import main; sys.exit(main())"
        self.process = subprocess.Popen(
            [sys.executable, "-c", code, "view", *words, "--no-browser"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
            cwd=cwd,
            env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONIOENCODING": "utf-8"},
        )
        self.address = self.process.stdout.readline().strip()
        assert self.address, self.process.stderr.read()

    @property
    def port(self):
        """Where it listens."""
        return int(self.address.split(":")[2].split("/")[0])

    @property
    def key(self):
        """The key of this start."""
        return self.address.partition("?key=")[2].partition("#")[0]

    def stop(self):
        """End it; what it said on standard error."""
        self.process.terminate()
        return self.process.communicate(timeout=20)[1]

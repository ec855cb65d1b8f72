"""One mistake of a first path tracer, as a replaced step."""

from dataclasses import dataclass, replace

from tracer.integrator.steps import RIGHT


@dataclass(frozen=True)
class Bug:
    """What the mistake is called, how it looks, which code makes it, and which law it breaks.

    changes: step name -> the wrong function. scene, integrator: where it shows.
    """

    id: str
    title: str
    symptom: str
    wrong: str
    law: str
    changes: dict
    scene: str = "cornell"
    integrator: str = "direct"

    @property
    def steps(self):
        """The right steps with the wrong ones in their places."""
        return replace(RIGHT, **self.changes)

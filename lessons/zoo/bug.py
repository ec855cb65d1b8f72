"""One mistake of a first path tracer, as replaced steps."""

from dataclasses import dataclass, field, replace

from tracer.integrator.steps import RIGHT
from tracer.settings import Settings, TracerError

HOMEWORK = {"hemisphere": "uniform", "roulette": "0.8", "light_sampling": "area"}
CENTRES = HOMEWORK | {"jitter": False}  # and every sample through its pixel's centre, as the homework does


@dataclass(frozen=True)
class Bug:
    """What the mistake is called, how it looks, which code makes it, and which law it breaks.

    changes: step name -> the wrong function; none where only time is lost that no step has. scene,
    integrator, settings: where it shows. note: what this entry does not do as the mistake itself does.
    only_cost: the picture stays right. endless: no path ends unless max_depth ends it.
    """

    id: str
    title: str
    symptom: str
    wrong: str
    law: str
    changes: dict
    scene: str = "cornell"
    integrator: str = "direct"
    settings: dict = field(default_factory=lambda: dict(HOMEWORK))
    note: str = ""
    only_cost: bool = False
    endless: bool = False

    @property
    def steps(self):
        """The right steps with the wrong ones in their places."""
        return replace(RIGHT, **self.changes)

    def asked(self, **options):
        """Settings in which it shows, with others beside them; it is not planted there yet."""
        return Settings(**({"integrator": self.integrator} | self.settings | options))

    def check(self, settings):
        """TracerError if a tracer with this bug would never be done."""
        if self.endless and settings.max_depth < 0:
            raise TracerError(
                f"bug: {self.id} lets no path end; give it a max_depth, such as {self.settings['max_depth']}"
            )

    @property
    def command(self):
        """The words that show it."""
        words = [f"castray render {self.scene} --bug {self.id} --integrator {self.integrator}"]
        for name, value in self.settings.items():
            option = name.replace("_", "-")
            words.append(f"--no-{option}" if value is False else f"--{option} {value}")
        return " ".join(words)

"""The doctor's hypotheses in the viewer, from the file that the picture is compared with."""

import time
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from tracer.doctor.picture import opened
from tracer.picture import is_picture
from tracer.settings import TracerError
from viewer.comparing.comparer import desk_of
from viewer.comparing.rival import Rival
from viewer.picture_doctor import opinion_on
from viewer.picture_report import beyond, said_of
from viewer.worker import Stopped

OFTEN = 0.5  # seconds between two words of progress


@dataclass
class Guess:
    """What the doctor said of a picture's file. rendered: how many pictures of mistakes are made, of how
    many, while it is busy."""

    rival: Rival
    busy: bool = False
    rendered: tuple = (0, 0)
    opinion: Any = None
    album: Any = None
    error: TracerError | None = None

    def close(self):
        """There is nothing to let go of."""


def rival_of(session):
    """The Rival in a picture's file that a session compares with; None if it compares with none."""
    desk = desk_of(session)
    found = desk is not None and not desk.rival.traced and is_picture(desk.rival.name)
    return desk.rival if found else None


def guess_of(session):
    """The Guess at the file that a session compares with; None if there is none."""
    rival, guess = rival_of(session), session.desk.get("guess")
    if rival is not None and (guess is None or guess.rival is not rival):
        guess = session.desk["guess"] = Guess(rival)
    return guess if rival is not None else None


class Guesser:
    """What the page may ask. worker: does what takes long."""

    def __init__(self, window, worker):
        self.window, self.session, self.worker = window, window.session, worker

    def guess(self):
        """Compare the file with the pictures of the zoo."""
        session, guess = self.session, guess_of(self.session)
        if guess is None or guess.busy:
            return
        guess.busy, guess.error, guess.rendered = True, None, (0, 0)
        scene, told = session.scene, time.monotonic()

        def progress(done, total):
            nonlocal told
            if session.desk.get("guess") is not guess:
                raise Stopped
            guess.rendered = done, total
            if time.monotonic() - told >= OFTEN:
                told = time.monotonic()
                self.window.back(self.window.show, "doctor")

        def job():
            if session.desk.get("guess") is not guess:
                raise Stopped
            with guess.rival.file() as file:
                return opinion_on(opened(file), scene, progress=progress)

        def done(found):
            guess.busy, (guess.opinion, guess.album) = False, found
            self.window.show("doctor")

        def failed(error):
            guess.busy, guess.error = False, error
            self.window.show("doctor")

        self.worker.do(job, done, failed)
        self.window.show("doctor")


def shown(session, say):
    """What the panel shows of it; None where no picture's file is compared with."""
    guess = guess_of(session)
    if guess is None:
        return None
    told = {
        "head": say("exam.picture", name=PurePath(guess.rival.name).name),
        "busy": guess.busy,
        "status": "",
        "verdict": "",
        "hypotheses": [],
    }
    if guess.busy and guess.rendered[1]:
        told["status"] = say("exam.guessing", done=guess.rendered[0], total=guess.rendered[1])
    told["error"] = say.error(str(guess.error)) if guess.error else ""
    if guess.opinion is not None:
        found = guess.opinion.hypotheses
        words = "pic.right" if guess.opinion.is_right else "pic.hypotheses" if found else "pic.nothing"
        told["verdict"], told["good"] = say(words), guess.opinion.is_right
        told["hypotheses"] = [[*said_of(h, guess.album, say)] for h in found]
        if guess.opinion.clues is not None:
            told["hypotheses"] = [[*beyond(guess.opinion, session.scene.name, say)]]
    return told

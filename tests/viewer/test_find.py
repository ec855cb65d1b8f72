"""Finding: what is asked of a picture's events, what comes out, and where it leads. No browser."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import tracer
from tracer.settings import TracerError
from tracer.trace.asker import ask
from tracer.trace.query import QueryError
from viewer import overlay
from viewer.finding import maps, ranks, survey
from viewer.finding.finder import MASK, SHOWN, Finder
from viewer.history import History
from viewer.session import Session
from viewer.worker import Stopped, outcome

SIZE, SPP = 24, 6
SETTINGS = tracer.Settings(width=SIZE, height=SIZE, spp=SPP, max_depth=6)


@pytest.fixture(scope="module")
def scene():
    return tracer.load("cornell_unit")


@pytest.fixture(scope="module")
def surveyed(scene):
    """A survey of every sample of a small picture."""
    made = survey.traced(scene, SETTINGS, None)
    yield made
    made.close()


@pytest.fixture(scope="module")
def trace(scene):
    """The same paths, as arrays."""
    return tracer.trace.gather(scene, SETTINGS)


class AtOnce:
    """A worker that does its jobs before it returns."""

    def do(self, job, done, failed):
        call, told = outcome(job, done, failed)
        call(told)


class Window:
    """Remembers what it was told."""

    def __init__(self, session):
        self.session, self.covers, self.places = session, [], []

    def back(self, call, *told):
        call(*told)

    def show(self, name):
        pass

    def cover(self, laid):
        self.session.overlay = laid
        self.covers.append(laid)

    def go_to(self, place):
        self.session.stand(place)
        self.places.append(place)


class Shared(survey.Survey):
    """One that outlives its desk."""

    def close(self):
        pass


def session_of(scene, settings):
    """A session that stands at a pixel."""
    session = Session(scene, settings, None)
    session.stand((0, 0, 0, 0))
    return session


@pytest.fixture
def finder(scene, surveyed):
    """A finder whose work is done at once, of a picture that is traced already."""
    finder = Finder(Window(session_of(scene, SETTINGS)), AtOnce(), AtOnce())
    finder.desk.survey = Shared(surveyed.asker, surveyed.settings)
    finder._look_over(finder.desk)
    return finder


def pixel_sums(trace, weights, kind=None):
    """Sums of numbers of paths, or of events of a kind, in each pixel (H, W)."""
    path = np.arange(trace.size) if kind is None else trace.tables[kind].path
    place = trace.paths["y"][path] * SIZE + trace.paths["x"][path]
    return np.bincount(place, weights, SIZE * SIZE).reshape(SIZE, SIZE)


def bright(rgb):
    """Luminance (N,) of colours (3, N)."""
    return np.tensordot((0.2126, 0.7152, 0.0722), rgb.astype(float), 1)


def test_the_survey_is_the_first_samples_of_each_pixel_and_as_many_as_are_quick():
    assert survey.planned(SETTINGS) == SETTINGS
    large = tracer.Settings(width=512, height=256, spp=64)
    assert survey.planned(large) == large.at_spp(2)
    dealt = tracer.Settings(width=256, height=256, spp=64, sampler="lattice", replicates=4)
    assert survey.planned(dealt) == dealt.at_spp(4)
    for options in ({"width": 1024}, {"width": 256, "sampler": "lattice", "replicates": 32}):
        with pytest.raises(TracerError, match="too many"):
            survey.planned(tracer.Settings(**{"height": 512, "spp": 64, **options}))


def test_a_survey_that_is_not_wanted_leaves_nothing_behind(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(survey.tempfile, "tempdir", str(tmp_path))

    def progress(part, total):
        raise Stopped

    with pytest.raises(Stopped):
        survey.traced(scene, SETTINGS, progress)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_maps_are_what_the_events_add_up_to(scene, surveyed, trace):
    given = {
        kind: pixel_sums(trace, bright(trace.tables[kind]["contribution"]), kind)
        for kind in ("hit", "light", "escape")
    }
    total = sum(given.values())
    total[total == 0.0] = np.nan
    for kind, light in given.items():
        assert maps.values(surveyed, kind) == pytest.approx(light / total, rel=1e-4, nan_ok=True)
    assert maps.values(surveyed, "length") == pytest.approx(
        pixel_sums(trace, trace.paths["vertices"]) / SPP, rel=1e-6
    )
    radiance = bright(trace.paths["radiance"])
    assert maps.values(surveyed, "dead") == pytest.approx(pixel_sums(trace, radiance <= 0.0) / SPP, abs=1e-6)
    mean = pixel_sums(trace, radiance) / SPP
    spread = (pixel_sums(trace, radiance**2) / SPP - mean**2) / (SPP - 1)
    assert maps.values(surveyed, "variance") == pytest.approx(spread, rel=1e-3, abs=1e-9)
    rays = maps.values(surveyed, "rays").astype(float).sum() * SPP
    assert rays == pytest.approx(tracer.render(scene, SETTINGS).rays, rel=1e-6)
    most = maps.values(surveyed, "largest").max()
    assert most == pytest.approx(
        max(bright(t["contribution"]).max() for t in map(trace.tables.get, given)), rel=1e-6
    )


def test_maps_that_cannot_be_made_are_not_offered(surveyed):
    assert maps.known(surveyed) == maps.known(SETTINGS) == list(maps.MAPS)
    assert "variance" not in maps.known(SETTINGS.at_spp(1))
    assert "variance" not in maps.known(tracer.Settings(spp=4, sampler="lattice"))
    paths = SimpleNamespace(level="paths", settings=SETTINGS)
    assert maps.known(paths) == ["variance", "length", "dead"]


def test_a_query_for_bins_of_the_histogram_finds_as_many_as_are_in_them(surveyed):
    found = ranks.histogram(surveyed)
    last = len(found.counts) - 1
    assert sum(found.counts) + found.below > SIZE * SIZE
    for low, high in ((0, last), (0, 0), (last, last), (last // 2, last // 2), (3, last - 3)):
        asked = surveyed.asker.ask(found.condition(low, high))
        assert asked["events"] == sum(found.counts[low : high + 1])


def test_fireflies_are_the_paths_that_stand_out_of_their_surroundings(surveyed, monkeypatch):
    plain = surveyed.asker.columns("SELECT x, y, sample, 0.1::DOUBLE AS v FROM paths")
    assert ranks.fireflies(SimpleNamespace(asker=given(plain), settings=SETTINGS)) == []
    odd = {**plain, "v": plain["v"].copy()}
    for k, value in ((777, 40.0), (1500, 90.0), (2000, 0.15)):
        odd["v"][k] = value
    first, second = ranks.fireflies(SimpleNamespace(asker=given(odd), settings=SETTINGS))
    for k, path in ((1500, first), (777, second)):
        assert [path[n] for n in ("x", "y", "sample")] == [odd[n][k] for n in ("x", "y", "sample")]
    assert first["luminance"] == 90.0 and first["around"] == pytest.approx(0.1)


def given(columns):
    """An asker that has these columns whatever is asked."""
    return SimpleNamespace(columns=lambda select: columns)


@pytest.mark.slow
def test_what_is_found_is_what_a_query_finds_and_is_where_it_says(finder, surveyed):
    text = "kind = 'light' AND NOT visible AND depth >= 1"
    answer = ask(surveyed.asker.place.path, text, SHOWN)
    finder.ask(text)
    assert finder.desk.answer == answer
    for k, path in enumerate(answer["found"][:5]):
        finder.hit(k)
        session = finder.session
        assert (session.cursor.x, session.cursor.y) == (path["x"], path["y"])
        assert session.path.sample == path["sample"]
        assert session.event.kind.name == path["kind"] and session.event.depth == path["depth"]
        assert not session.event.values["visible"]
    laid = finder.window.covers[-1]
    assert laid.kind == "mask" and np.isfinite(laid.values).sum() == answer["pixels"]


def test_a_wrong_query_says_where_it_is_wrong(finder):
    finder.ask("depth >= 2 AND pdff < 1e-4")
    error = finder.desk.error
    assert isinstance(error, QueryError) and error.at == 15 and "pdff" in error.words
    assert "pdf" in error.names and finder.desk.answer is None
    finder.ask("depth >= 2")
    assert finder.desk.error is None and finder.desk.answer["paths"] > 0


def test_breakpoints_brush_and_steps_lead_to_paths(finder):
    finder.stop_at("largest")
    assert finder.desk.answer["paths"] >= 1
    finder.step(1)
    assert finder.desk.hit == 0
    most = finder.session.event.values["contribution"]
    found = finder.desk.histogram
    last = len(found.counts) - 1
    finder.brushed(last, last)
    assert finder.desk.answer["events"] == found.counts[last]
    assert bright(most) >= found.edges[last]
    finder.step(-1)
    assert finder.desk.hit == 0
    finder.step(-1)
    assert finder.desk.hit == len(finder.desk.answer["found"]) - 1


def test_what_was_asked_last_lies_over_the_picture(finder):
    class Later(AtOnce):
        """A worker that does nothing until it is told."""

        jobs: list = []

        def do(self, *job):
            self.jobs.append(job)

    finder.asking = Later()
    finder.ask("depth >= 1")
    finder.show_map("length")
    for job in Later.jobs:
        AtOnce().do(*job)
    assert [laid.title for laid in finder.window.covers] == ["map.length"]
    assert finder.desk.answer["paths"] > 0


def test_what_is_not_there_is_refused(finder):
    for call in (
        lambda: finder.ask(7),
        lambda: finder.stop_at("sometimes"),
        lambda: finder.stop_at(["nan"]),
        lambda: finder.show_map("beauty"),
        lambda: finder.brushed(1, 0),
        lambda: finder.hit(0),
        lambda: finder.hit(True),
        lambda: finder.brushed(0, 999),
        lambda: finder.firefly(99),
    ):
        with pytest.raises(TracerError):
            call()


@pytest.mark.slow
def test_the_first_question_traces_the_picture_and_another_scene_forgets_it(scene):
    session = session_of(scene, SETTINGS.at_spp(1))
    finder = Finder(Window(session), AtOnce(), AtOnce())
    finder.ask("depth >= 1")
    assert finder.desk.answer["paths"] > 0 and finder.session.overlay.by == "find"
    where = finder.desk.survey.kept.name
    session.adopt(scene, SETTINGS)
    assert session.overlay is None and finder.desk.survey is None
    assert not Path(where).exists()


def test_history_goes_back_and_forward_as_a_browser_does():
    history = History()
    assert history.moved(-1) is None and history.behind == history.ahead == 0
    for pixel in ((1, 1), (2, 2), (2, 2), (3, 3)):
        history.add(pixel)
    assert history.behind == 2 and history.moved(1) is None
    assert history.moved(-1) == (2, 2) and history.ahead == 1
    history.add((2, 2))  # being there again is no new pick
    assert history.ahead == 1
    history.add((4, 4))
    assert history.ahead == 0 and history.pixels == [(1, 1), (2, 2), (4, 4)]


def test_colours_of_maps_grow_lighter_all_the_way():
    def lightness(stop):
        c = np.array([int(stop[k : k + 2], 16) / 255 for k in (1, 3, 5)])
        return float(
            np.dot((0.2126, 0.7152, 0.0722), np.where(c > 0.04045, ((c + 0.055) / 1.055) ** 2.4, c / 12.92))
        )

    for kind in ("map", "mask"):
        steps = [lightness(stop) for stop in overlay.STOPS[kind]]
        assert all(a < b for a, b in zip(steps[:-1], steps[1:], strict=True))
    sides = [lightness(stop) for stop in overlay.STOPS["difference"]]
    assert sides.index(min(sides)) == len(sides) // 2


@pytest.mark.parametrize(
    "values", [[[0.0, 0.0]], [[np.nan, np.nan]], [[1.0, np.inf]], [[5.0, 5.0]], [[-1.0, 2.0]]]
)
def test_a_scale_has_two_ends_whatever_the_values(values):
    values = np.array(values)
    for laid in (
        overlay.scaled("t", "t", values),
        overlay.scaled("t", "t", values, log=True),
        overlay.signed("t", "t", values),
    ):
        assert np.isfinite((laid.low, laid.high)).all() and laid.low < laid.high
        assert not laid.log or laid.low > 0.0


def test_where_nothing_is_found_the_picture_is_seen_as_it_is(finder):
    finder.ask("depth >= 0")
    assert finder.window.covers[-1].title == MASK
    finder.ask("depth < 0")
    assert finder.desk.answer["paths"] == 0 and finder.window.covers[-1] is None
    finder.show_map("rays")
    finder.ask("SELECT count(*) FROM events")  # which has no pixels: the map stays
    assert finder.window.covers[-1].title == "map.rays"


def test_a_function_that_there_is_not_is_named(finder):
    finder.ask("luminancy(contribution) > 1")
    assert "there is no function luminancy" in str(finder.desk.error)

"""The lobes over a vertex are surfaces as far from it as the tracer's f |cos| and p say."""

import numpy as np
import pytest
from cases import slow_but

import tracer
from lessons import zoo
from lessons.zoo import planted
from viewer import hemisphere
from viewer.company import over_vertex
from viewer.cursor import Cursor
from viewer.hemisphere import Hemisphere
from viewer.numerals import LUMINANCE
from viewer.session import Session
from viewer.stage import Stage
from viewer.surfaces import COLOURS
from viewer.understanding import lens
from viewer.understanding.draws import drawn
from viewer.understanding.lobes import lobes
from viewer.understanding.places import places
from viewer.understanding.vertex import Vertex
from viewer.words import LANGUAGES, Speaker

SIZE = 2.0
SHARP = "plates", "smooth_plate"
SEEN = [("cornell_unit", "tall_box"), ("materials", "copper_ball"), ("materials", "frosted_ball"), SHARP]


def lens_on(scene, shape, **options):
    """The Lens over the first recorded vertex on a shape that is seen from its front."""
    loaded = tracer.load(scene)
    settings = tracer.Settings(**{"width": 32, "height": 24, "spp": 4, "max_depth": 8, **options})
    settings, steps = settings.at_size_of(loaded), planted(settings)
    wanted = next(k for k, one in enumerate(loaded.shapes) if one.name == shape)
    for pixel in range(0, 32 * 24, 7):
        record = tracer.inspect(loaded, settings, pixel % 32, pixel // 32, steps=steps)
        for place in places(record, "bounce", "hit"):
            if place.hit["shape"] == wanted and place.hit["cos_wo"] > 0.1:
                return lens.over(loaded.at(settings), steps, record, *place.at)
    raise AssertionError(f"no path meets {shape}")


def solid_angles(directions, faces):
    """Of triangles between unit vectors, negative where they look inwards (Oosterom and Strackee 1983)."""
    a, b, c = (directions[:, faces[:, k]] for k in range(3))
    triple = (a * np.cross(b, c, axis=0)).sum(axis=0)
    return 2.0 * np.arctan2(triple, 1.0 + (a * b).sum(axis=0) + (b * c).sum(axis=0) + (c * a).sum(axis=0))


@pytest.mark.parametrize(("scene", "shape"), slow_but(SEEN, SEEN[0]))
def test_every_point_of_a_lobe_is_as_far_away_as_the_tracer_s_eval_and_pdf_say(scene, shape):
    seen = lens_on(scene, shape)
    over, vertex, hit = Hemisphere(seen, SIZE, Speaker("en")), seen.vertex, seen.vertex.hit
    ready, primitive = vertex.scene, np.reshape(hit["primitive"], 1)
    material = ready.bsdf_of[primitive]
    n, p, wo = (np.reshape(hit[name], (3, 1)) for name in ("n", "p", "wo"))
    frame, texture = ready.frame(n, p, primitive), ready.painted(p, primitive)
    for name, cells in (("lobe_f", 3), ("lobe_p", 2)):
        points, faces = over.drawn[name]
        assert faces.shape[1] == cells and 1000 < len(points) < 4000
        away = (points - p[:, 0]).T / over.reach
        far = np.linalg.norm(away, axis=0)
        there = far > 1e-3  # nearer, the direction is lost to rounding
        wi = frame.to_local((away[:, there] / far[there]).astype(ready.dtype))
        lanes = wi.shape[1]
        here = np.repeat(frame.to_local(wo), lanes, axis=1)
        painted = None if texture is None else np.repeat(texture, lanes, axis=-1)
        if name == "lobe_p":
            value = ready.bsdf.pdf(np.repeat(material, lanes), here, wi, painted)
        else:
            f = ready.bsdf.eval(np.repeat(material, lanes), here, wi, painted)
            value = np.tensordot(LUMINANCE, f.astype(float), axes=1) * np.abs(wi[2])
        clear = np.abs(wi[2]) > 1e-4  # at the rim rounding decides which side it is
        off = np.abs(far[there] * over.lobes.most - value)[clear]
        assert np.all(off <= 0.02 * value[clear] + 0.002 * over.lobes.most)
    assert over.lobes.most == max(max(s.f.max(), s.p.max()) for s in over.lobes.sheets)


@pytest.mark.parametrize(("scene", "shape"), slow_but(SEEN, SEEN[0]))
def test_a_lobe_covers_its_side_and_no_peak_falls_between_its_places(scene, shape):
    seen = lens_on(scene, shape)
    found, vertex = lobes(seen.vertex), seen.vertex
    shown, sample = drawn(vertex, planted(tracer.Settings()))
    with np.errstate(all="ignore"):
        p = vertex.asked(shown)[1]
    smooth = (sample.pdf > 0.0) & ~sample.delta
    share = 0.0
    for sheet in found.sheets:
        angles = solid_angles(sheet.directions, sheet.faces)
        assert angles.min() >= 0.0 and angles.sum() == pytest.approx(2.0 * np.pi, rel=0.01)
        share += float((angles * sheet.p[sheet.faces].mean(axis=1)).sum())
        side = smooth & (sheet.side * shown[2] > 0.0)
        assert sheet.p.max() >= 0.98 * p[side].max(initial=0.0)
    # 2048 bounces: five standard errors of their share, beside what flat triangles lose
    assert share == pytest.approx(smooth.mean(), abs=0.02 + 5.0 * np.sqrt(0.25 / smooth.size))


@pytest.mark.slow
def test_a_polar_grid_about_the_normal_would_miss_the_peak():
    """The test above can fail: without the map to the peak a sharp lobe falls between the places."""
    from viewer.understanding import lobes as module

    vertex = lens_on(*SHARP).vertex
    found = lobes(vertex).sheets[0]
    with np.errstate(all="ignore"):
        p = vertex.asked(module.off_disc(module._moved(np.zeros(2)), found.side))[1]
    assert p.max() < 0.98 * found.p.max()


def test_a_dirac_lobe_is_two_arrows_as_long_as_its_fraction_and_its_probability():
    seen = lens_on("cornell_glass", "glass_ball")
    over = Hemisphere(seen, SIZE, Speaker("en"))
    by_name = {dirac.name: dirac for dirac in over.lobes.diracs}
    assert set(by_name) == {"reflection", "transmission"} and over.lobes.sheets == ()
    wo = seen.vectors["wo"]
    assert by_name["reflection"].direction == pytest.approx([-wo[0], -wo[1], wo[2]], abs=1e-5)
    assert by_name["reflection"].p + by_name["transmission"].p == pytest.approx(1.0, abs=1e-6)
    p = np.asarray(seen.vertex.hit["p"], float)
    longest = {name: np.linalg.norm(over.drawn[name][0] - p, axis=1).max() for name in ("lobe_f", "lobe_p")}
    for name, value in (("lobe_f", "f"), ("lobe_p", "p")):
        most = max(getattr(dirac, value) for dirac in by_name.values())
        assert longest[name] == pytest.approx(most * over.reach, rel=0.02)
    assert {label["text"].split(":")[0] for label in over.labels} >= set(by_name)


def test_where_bounces_do_not_go_as_p_says_cells_are_coloured_and_else_none():
    right = Hemisphere(lens_on("cornell_unit", "tall_box"), SIZE, Speaker("en"))
    assert not len(right.drawn["more"][1]) and not len(right.drawn["fewer"][1])
    asked = {k: v for k, v in zoo.of("B09").asked().as_dict().items() if k not in ("width", "height", "spp")}
    wrong = Hemisphere(lens_on("cornell_unit", "tall_box", **{**asked, "bug": "B09"}), SIZE, Speaker("en"))
    assert len(wrong.drawn["more"][1]) and len(wrong.drawn["fewer"][1])
    assert {row["kind"] for row in wrong.legend(Speaker("en"))} >= {"lobe_f", "lobe_p", "more", "fewer"}


def test_its_labels_and_legend_are_words_of_every_language():
    seen = lens_on("cornell_glass", "glass_ball")
    said = {tag: Hemisphere(seen, SIZE, Speaker(tag)) for tag in LANGUAGES}
    for over in said.values():
        assert [row["kind"] for row in over.legend(Speaker("en"))] == ["lobe_f", "lobe_p"]
        assert all(np.isfinite(label["at"]).all() for label in over.labels)
    assert len({over.labels[0]["text"] for over in said.values()}) == len(LANGUAGES)


def test_the_stage_draws_it_before_what_is_seen_through_and_only_while_it_is_asked_for():
    scene = tracer.load("cornell_unit")
    stage, settings = Stage(scene), tracer.Settings(width=24, height=24, spp=2)
    record = tracer.inspect(scene, settings, 12, 20)
    cursor = Cursor(12, 20, tuple(len(path.events) for path in record.paths), 0, 1)
    over = Hemisphere(
        lens.over(scene.at(settings), planted(settings), record, 0, 1), stage.size, Speaker("en")
    )
    stage.draw(record, cursor, "picture", over=over)
    shown = {number: (points, cells) for number, points, cells in stage.strokes["over"]}
    names = (*COLOURS, *hemisphere.COLOURS)
    points, cells = over.drawn["lobe_f"]
    sent = shown[names.index("lobe_f")]
    assert np.array_equal(np.frombuffer(sent[0], "<f4").reshape(-1, 3), points.astype(np.float32))
    assert np.array_equal(np.frombuffer(sent[1], "<u4").reshape(-1, 4)[:, 1:], cells)
    actors = stage.renderer.GetActors()
    order = [actors.GetItemAsObject(k) for k in range(actors.GetNumberOfItems())]
    assert max(shown) < min(order.index(layer.actor) for _, layer in stage._surfaces)
    for number, name in enumerate(names):  # the browser knows an actor by its number
        colour = {**COLOURS, **hemisphere.COLOURS}[name]
        assert np.allclose(order[number].GetProperty().GetColor(), colour)
    stage.draw(record, cursor, "event")
    assert not any(points or cells for _, points, cells in stage.strokes["over"])


def test_the_grid_is_asked_once_however_sharp_the_lobe_is(monkeypatch):
    """Resolution is bounded: a step asks the material for a fixed number of directions."""
    seen = lens_on(*SHARP)
    asked, ask = [], Vertex.asked

    def counted(vertex, shown):
        asked.append(shown.shape[1])
        return ask(vertex, shown)

    monkeypatch.setattr(Vertex, "asked", counted)
    lobes(seen.vertex)
    assert sum(asked) < 8000


def test_nothing_is_worked_out_where_it_is_not_asked_for(monkeypatch):
    session = Session(tracer.load("cornell_unit"), tracer.Settings(width=24, height=24, spp=2), None)
    session.stand((12, 20, 0, 1))
    monkeypatch.setattr(lens, "over", None)  # whoever asks for it fails
    assert over_vertex(session, SIZE, Speaker("en")) is None
    session.shelf[lens.SHOWN] = True
    with pytest.raises(TypeError):
        over_vertex(session, SIZE, Speaker("en"))

"""Mitsuba's XML means what the same words mean in a dict, and what is wrong in it is named by its line."""

import numpy as np
import pytest
from mitsuba_room import DICT, XML, same
from suite import castray

import tracer
from tracer import SceneWarning, TracerError


@pytest.fixture
def read(tmp_path):
    """A scene from XML text."""

    def reader(text):
        (tmp_path / "room.xml").write_text(text, encoding="utf-8")
        return tracer.load(tmp_path / "room.xml")

    return reader


def tall(matrix):
    """A scene whose ball was moved by `matrix`, (4, 4) of its steps."""
    return tracer.load_dict({**DICT, "box": {"type": "cube", "to_world": matrix}})


def test_xml_and_dict_are_the_same_scene(read):
    scene = read(XML)
    assert (scene.name, scene.light_names) == ("room", ("lamp",))
    assert same(scene, tracer.load_dict(DICT))


BOX = '<shape type="cube"><transform name="to_world">{}</transform></shape></scene>'


@pytest.mark.parametrize(
    ("spelled", "steps"),
    [
        ('<translate x="1" z="2"/>', [{"translate": [1, 0, 2]}]),
        ('<translate value="1,0,2"/>', [{"translate": [1, 0, 2]}]),
        ('<scale value="2"/>', [{"scale": 2}]),
        ('<scale x="2"/>', [{"scale": [2, 1, 1]}]),
        (
            '<rotate y="1" angle="30"/><scale value="1 2 3"/>',
            [{"rotate": [0, 1, 0], "angle": 30}, {"scale": [1, 2, 3]}],
        ),
        ('<rotate value="0.6,0.8,0" angle="30"/>', [{"rotate": [0.6, 0.8, 0], "angle": 30}]),
        (
            '<lookat origin="1 2 3" target="0 0 1" up="0 0 1"/>',
            [{"look_at": {"origin": [1, 2, 3], "target": [0, 0, 1], "up": [0, 0, 1]}}],
        ),
        ('<matrix value="1 2 0 0 1 0 0 0 3"/>', [[1, 2, 0, 0], [0, 1, 0, 0], [0, 0, 3, 0], [0, 0, 0, 1]]),
        (
            '<matrix value="1 2 0 4 0 1 0 5 0 0 3 6 0 0 0 1"/>',
            [[1, 2, 0, 4], [0, 1, 0, 5], [0, 0, 3, 6], [0, 0, 0, 1]],
        ),
    ],
)
def test_every_transform_of_the_xml_is_that_of_the_dict(read, spelled, steps):
    here = read(XML.replace("</scene>", BOX.format(spelled))).shapes[-1].to_world
    assert np.array_equal(here, tall(steps).shapes[-1].to_world)


def test_parameters_are_put_in_and_the_first_default_counts(read):
    text = XML.replace('value="0.8, 0.7 0.6"', 'value="$r, 0.7 0.$last"').replace('id="white"', 'id="$name"')
    given = {"r": "0.8", "last": "6", "name": "white"}
    defaults = "".join(f'<default name="{k}" value="{v}"/>' for k, v in given.items())
    scene = read(text.replace('3.0.0">', f'3.0.0">{defaults}<default name="r" value="0.1"/>'))
    assert same(scene, read(XML))


def test_a_reference_may_stand_before_its_object_and_point_into_another(read):
    white = XML.splitlines()[7]
    late = XML.replace(white, "").replace("</scene>", white + "</scene>")
    assert same(read(late), read(XML))
    inside = XML.replace(white, "").replace('<ref id="white"/>', white, 1)
    assert same(read(inside), read(XML))


def test_a_file_may_include_another(read, tmp_path):
    white = XML.splitlines()[7]
    part = f'<scene version="3.0.0">{white}</scene>'
    (tmp_path / "part.xml").write_text(part, encoding="utf-8")
    assert same(read(XML.replace(white, '<include filename="part.xml"/>')), read(XML))


BOARD = """<texture type="{kind}" {name}>
    <rgb name="color0" value="0.8 0.1 0.1"/><float name="color1" value="0.2"/>
    <transform name="to_uv"><scale x="4" y="2"/><translate x="0.25"/></transform>
  </texture>"""


def test_textures_stand_inside_or_are_referred_to(read):
    to_uv = [{"scale": [4, 2, 1]}, {"translate": [0.25, 0, 0]}]
    board = {"type": "checkerboard", "color0": [0.8, 0.1, 0.1], "color1": 0.2, "to_uv": to_uv}
    wanted = tracer.load_dict({**DICT, "white": {"type": "diffuse", "reflectance": board}})
    white = '<rgb name="reflectance" value="0.8, 0.7 0.6"/>'
    inside = XML.replace(white, BOARD.format(kind="checkerboard", name='name="reflectance"'))
    assert same(read(inside), wanted) and not same(wanted, read(XML))
    apart = BOARD.format(kind="checkerboard", name='id="board"')
    for text in (XML.replace("</scene>", apart + "</scene>"), XML.replace("<bsdf", apart + "<bsdf")):
        assert same(read(text.replace(white, '<ref name="reflectance" id="board"/>')), wanted)
    with pytest.raises(TracerError, match="line 8: white.reflectance.type: 'chess' is not supported"):
        read(XML.replace(white, BOARD.format(kind="chess", name='name="reflectance"')))


def test_how_mitsuba_keeps_a_bitmap_in_memory_does_not_matter(read, tmp_path):
    np.save(tmp_path / "grey.npy", np.full((2, 2), 0.5))
    picture = '<string name="filename" value="grey.npy"/>'
    kept = '<string name="format" value="fp16"/><boolean name="accel" value="false"/>'
    white = '<rgb name="reflectance" value="0.8, 0.7 0.6"/>'
    texture = '<texture type="bitmap" name="reflectance">{}</texture>'
    scenes = [read(XML.replace(white, texture.format(words))) for words in (picture, picture + kept)]
    assert same(*scenes) and same(scenes[0], read(XML.replace("0.8, 0.7 0.6", "0.5")))


def test_objects_without_ids_get_names_of_their_own(read):
    more = '<shape type="cube"/><shape type="cube"/><bsdf type="diffuse" id="cube_2"/></scene>'
    scene = read(XML.replace("</scene>", more))
    assert [shape.name for shape in scene.shapes] == ["lamp", "ball", "cube", "cube_3"]


def test_colours_may_be_one_number_or_a_constant_spectrum(read):
    for spelled in (
        'rgb name="reflectance" value="0.5"',
        'spectrum name="reflectance" value="0.5"',
        'float name="reflectance" value="0.5"',
        'rgb name="reflectance" value="0.5,0.5,0.5"',
    ):
        scene = read(XML.replace('rgb name="reflectance" value="0.8, 0.7 0.6"', spelled))
        assert np.array_equal(scene.display_colour(0), [0.5] * 3)


def test_a_mesh_without_normals_is_smooth_in_mitsuba_unless_it_says_otherwise(read, tmp_path):
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    mesh = '<shape type="obj"><string name="filename" value="m.obj"/>{}</shape></scene>'
    assert read(XML.replace("</scene>", mesh.format(""))).shapes[-1].normals is not None
    flat = '<boolean name="face_normals" value="true"/>'
    assert read(XML.replace("</scene>", mesh.format(flat))).shapes[-1].normals is None


FILM = '<film type="hdrfilm">'
DEPTH = '<integrator type="path"><integer name="max_depth" value="{}"/></integrator>'
NOTED = [
    ('3.0.0">', '3.0.0">' + DEPTH.format(8), "--max-depth 8"),
    ('3.0.0">', '3.0.0"><integrator type="direct"/>', "--max-depth 2"),
    (FILM, FILM + '<rfilter type="gaussian"/>', "gaussian"),
]


@pytest.mark.parametrize(("old", "new", "said"), NOTED)
def test_a_setting_in_the_file_is_named_with_its_line(read, old, new, said):
    with pytest.warns(SceneWarning, match=said) as noted:
        scene = read(XML.replace(old, new))
    assert "room.xml: line " in str(noted[0].message)
    assert same(scene, read(XML))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('3.0.0">', '3.0.0">' + DEPTH.format(-1)),
        (FILM, FILM + '<rfilter type="box"/><string name="pixel_format" value="rgba"/>'),
        (FILM, '<sampler type="multijitter"><integer name="sample_count" value="64"/></sampler>' + FILM),
        (FILM, '<float name="near_clip" value="0.1"/>' + FILM),
    ],
)
@pytest.mark.filterwarnings("error")
def test_what_changes_no_picture_is_let_through_in_silence(read, old, new):
    assert same(read(XML.replace(old, new)), read(XML))


BAD = [
    ('type="sphere"', 'type="spheer"', ("line 13", "spheer", "sphere")),
    ('name="radius"', 'name="radios"', ("line 14", "ball.radios", "radius")),
    ('value="0.5"', 'value="half"', ("line 14", "half")),
    ('value="0.5"', 'value="1_0"', ("line 14", "1_0")),
    ('value="0.5"', 'value="nan"', ("line 14", "ball.radius", "nan")),
    ('value="0.5"', 'value="1 2"', ("line 14", "one")),
    ('z="1"', "", ("line 14", 'z="')),
    ('z="1"', 'w="1"', ("line 14", 'z="')),
    ('value="1 2 3"', 'value="1 2"', ("line 11", "lamp.emitter.radiance", "three")),
    ('value="1 2 3"', 'value="1 -2 3"', ("line 11", "lamp.emitter.radiance", "-2")),
    (
        '<rgb name="radiance" value="1 2 3"/>',
        '<spectrum name="radiance" value="400:1, 700:2"/>',
        ("line 11", "rgb"),
    ),
    ('<ref id="white"/>', '<ref id="wite"/>', ("line 10", "wite", "white")),
    ('<ref id="white"/>', '<ref id="lamp"/>', ("line 10", "lamp", "shape")),
    ('<ref id="white"/>', '<ref id="white"/><ref id="white"/>', ("line 10", "twice")),
    ('<bsdf type="diffuse"', '<bsdf type="cube"', ("line 8", "cube", "shape")),
    ('<bsdf type="diffuse"', '<bsdf type="principled"', ("line 8", "principled", "diffuse")),
    ('<bsdf type="diffuse"', "<bsdf", ("line 8", 'type="')),
    ('id="ball"', 'id="lamp"', ("line 13", "lamp", "line 9")),
    ('id="ball"', 'nome="ball"', ("line 13", "nome", "id")),
    ('"0,0,4"', '"0,0"', ("line 5", "origin", "three")),
    ('up="0 1 0"', 'up="0 0 1"', ("line 5", "look_at", "up")),
    ("<lookat", "<look", ("line 5", "look", "lookat")),
    ('value="8"', 'value="8.5"', ("line 6", "8.5")),
    ('value="8"', 'value="-8"', ("line 6", "film.width", "-8")),
    ('value="40"', 'value="$fov"', ("line 4", "$fov")),
    ("</sensor>", "", ("line 16", "not correct XML")),
    ("</sensor>", "</sensor>words", ("line 7", "words")),
    ("</sensor>", '</sensor><volume type="constvolume"/>', ("line 7", "volume", "shape")),
    ("<film", '<medium type="homogeneous" name="medium"/><film', ("line 6", "perspective.medium", "film")),
    ('<ref id="white"/>', '<ref id="white"/><medium type="homogeneous"/>', ("line 10", 'name="')),
    ("</sensor>", '</sensor><integrator type="ptracer"/>', ("line 7", "ptracer", "path")),
    ("</sensor>", '</sensor><include filename="gone.xml"/>', ("gone.xml", "No such file")),
    ("</sensor>", '</sensor><include filename="room.xml"/>', ("deeply",)),
    ('version="3.0.0"', 'version="0.6.0"', ("line 2", "0.6.0", "2.0.0")),
    ('version="3.0.0"', "", ("line 2", "version")),
    ("utf-8", "gb18030", ("line 1", "encoding")),
    ("utf-8", "no-such-code", ("line 1", "encoding")),
    ("<scene", '<!DOCTYPE scene [<!ENTITY a "b">]><scene', ("line 2", "entities")),
    ("<scene", '<!DOCTYPE scene SYSTEM "https://example.org/x.dtd"><scene', ("line 2", "entities")),
]


@pytest.mark.parametrize(("old", "new", "said"), BAD)
def test_a_mistake_is_named_with_file_line_and_word(read, old, new, said):
    assert old in XML
    with pytest.raises(TracerError) as refused:
        read(XML.replace(old, new, 1))
    message = str(refused.value)
    assert ".xml: " in message and "\n" not in message
    assert not [word for word in said if word not in message], message


def test_a_material_that_is_part_of_itself_is_refused(read):
    loop = '<bsdf type="twosided" id="loop"><ref id="loop"/></bsdf></scene>'
    with pytest.raises(TracerError, match="line 16.*part of itself"):
        read(XML.replace("</scene>", loop))


def test_elements_without_end_are_refused(read):
    with pytest.raises(TracerError, match="deeply"):
        read('<scene version="3.0.0">' + "<shape>" * 100_000)


def test_a_rotation_that_mitsuba_would_take_for_a_shear_is_named(read):
    turned = BOX.format('<rotate value="1,1,0" angle="30"/>')
    with pytest.warns(SceneWarning, match=r"room.xml: line 16: rotate: .* length 1.41421"):
        read(XML.replace("</scene>", turned))


@pytest.mark.slow
def test_the_command_says_what_is_a_setting(tmp_path):
    old, new, said = NOTED[0]
    (tmp_path / "room.xml").write_text(XML.replace(old, new), encoding="utf-8")
    done = castray("render", "room.xml", "--spp", "1", "-o", "out.npy", "--json", cwd=tmp_path)
    (line,) = done.stderr.splitlines()
    assert done.returncode == 0 and line.startswith("castray: ") and said in line

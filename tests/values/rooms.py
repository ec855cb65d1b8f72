"""Radiance in rooms and between mirrors and panes, traced."""

import checks
import lamps
import numpy as np

import tracer
from tracer import Settings
from tracer.engine import waves
from tracer.events import END
from tracer.integrator.wave import Wave
from values.registry import Estimate, estimator, kernel

SIDE = 4  # pixels of the pictures here


def look(origin, target, fov=40.0, width=SIDE, height=SIDE, up=(0.1, 1.0, 0.2)):
    """A camera."""
    view = {"look_at": {"origin": list(origin), "target": list(target), "up": list(up)}}
    film = {"width": width, "height": height}
    return {"type": "perspective", "fov": fov, "to_world": [view], "film": film}


def diffuse(reflectance):
    return {"type": "diffuse", "reflectance": reflectance}


def area(radiance):
    return {"type": "area", "radiance": radiance}


def closed(Le, rho):
    """A cube whose walls all shine with Le and reflect the share rho."""
    walls = {"type": "cube", "flip_normals": True, "bsdf": diffuse(rho), "emitter": area(Le)}
    return tracer.load_dict({"sensor": look([0.2, 0.1, -0.3], [1, 0.4, 0.7]), "walls": walls})


def radiance(scene, bits, seed, n, channel=0, **options):
    """About n samples of a scene's radiance, all pixels together."""
    options = {"integrator": "walk", **options}
    pixels = scene.width * scene.height
    settings = Settings(spp=-(-n // pixels), seed=seed, precision=bits, **options)
    return checks.samples(scene, settings)[channel].ravel()


def still(scene, to, depth, **options):
    """The radiance of a scene in which every path brings the same; NaN where it does not."""
    found = radiance(scene, to.bits, 0, 64, max_depth=depth, roulette="off", **options)
    return found[np.argmax(np.abs(found - np.median(found)))]


@kernel("furnace.diffuse.", but=("inf",))
def furnace(key, given, to):
    """Bounces alone give it without noise: f cos / pdf is rho each time."""
    return still(closed(given["Le"], given["rho"]), to, given["max_scatter"] + 1)


@estimator("furnace.diffuse.rho=0.1.inf", "furnace.diffuse.rho=0.5.inf", n=50_000)
@estimator("furnace.diffuse.rho=0.8.inf", "furnace.diffuse.rho=0.9.inf", n=130_000, dear=True)
def endless_furnace(key, given, bits, seed, n):
    """In a dark room automatic roulette lets so few paths go on that n may have none, and so no spread."""
    roulette = "auto" if given["rho"] >= 0.5 else "0.5"
    return radiance(closed(given["Le"], given["rho"]), bits, seed, n, roulette=roulette)


@estimator("furnace.rgb.B", n=130_000, dear=True)
def coloured_furnace(key, given, bits, seed, n):
    """The channel of a coloured room; roulette goes by the brightest one."""
    return radiance(closed([1.0, 2.0, given["Le"]], [0.2, 0.5, given["rho"]]), bits, seed, n, channel=2)


def rr_room(given, seed, n, bits):
    scene = closed(given["Le"], given["rho"])
    return scene, {"bits": bits, "seed": seed, "n": n, "roulette": str(given["survival_q"])}


@estimator("rr.mean.", n=150_000)
def under_roulette(key, given, bits, seed, n):
    scene, options = rr_room(given, seed, n, bits)
    return radiance(scene, **options)


@estimator("rr.var.", n=350_000, dear=True)
def variance_under_roulette(key, given, bits, seed, n):
    scene, options = rr_room(given, seed, n, bits)
    variance, error = lamps.variance_and_error(radiance(scene, **options))
    return Estimate(variance, variance * error)


@estimator("rr.cost.", n=150_000)
def segments_under_roulette(key, given, bits, seed, n):
    """Rays of each path."""
    scene = closed(given["Le"], given["rho"])
    settings = Settings(
        width=1, height=1, seed=seed, precision=bits, integrator="walk", roulette=str(given["survival_q"])
    )
    wave, found = Wave(np.zeros(n, int), np.zeros(n, int), np.arange(n), settings), []
    for event in waves.events(scene.at(settings), settings, wave):
        if event.kind is END:
            found.append(event.depth + 1)
    return np.concatenate(found)


def cavity(given, look_at, fov):
    """A unit sphere of which a cap, a share f of the area, is a lamp; its camera.

    A larger sphere with the same rim stands for the cap: the same directions lead from the walls through the
    rim, and each has to bring what the cap would send there. Of what a point of the cap sees the share f is
    the cap itself, and f2 of the larger sphere's part: reflectance and emission make up for that.
    """
    f, rho = given["emitter_area_fraction"], given["rho_emitter"]
    height = 1.0 - 2.0 * f
    radius = np.sqrt(2.0 + 2.0 * height)  # around (0, 0, -1)
    f2 = 0.5 * (1.0 - (height + 1.0) / radius)
    seen = rho * (1.0 - f) / (1.0 - rho * f)  # of the walls, in the lamp
    of_lamp = seen / (1.0 - f2 + seen * f2)
    Le = given["Le"] * (1.0 - of_lamp * f2) / (1.0 - rho * f)
    wall = {"type": "sphere", "flip_normals": True, "bsdf": diffuse(given["rho_wall"])}
    lamp = lamps.sphere([0, 0, -1], radius, Le, flip_normals=True, bsdf=diffuse(of_lamp))
    return tracer.load_dict({"sensor": look([0, 0.1, 0], look_at, fov), "wall": wall, "lamp": lamp})


def in_a_cavity(given, look_at, bits, seed, n, fov=20.0):
    """Radiance by bounces, up to so many that e^-30 of the light is left."""
    left = given["rho_wall"] * (1.0 - given["emitter_area_fraction"])
    options = {"roulette": "off", "max_depth": int(30.0 / (1.0 - left))}
    return radiance(cavity(given, look_at, fov), bits, seed, n, **options)


@estimator("sphere.patch.wall.", n=100_000, dear=True)
def wall_of_a_cavity(key, given, bits, seed, n):
    return in_a_cavity(given, [1, 0.2, -0.3], bits, seed, n)


@estimator("sphere.patch.emitter.", n=5000, dear=True)
def lamp_of_a_cavity(key, given, bits, seed, n):
    return in_a_cavity(given, [0, 0, 1], bits, seed, n, fov=2.0)


@estimator("sphere.patch.direct.", n=100_000, slack=2e-5)
def wall_of_a_cavity_directly(key, given, bits, seed, n):
    """From a disk that closes the cap: what comes through the rim is the same."""
    height = 1.0 - 2.0 * given["emitter_area_fraction"]
    lamp, wall = lamps.disk(np.sqrt(1.0 - height * height), height), np.array([0.8, 0.36, -0.48])
    E = lamps.irradiance(lamps.light_samples(lamp, wall, seed, n, bits), -wall)
    return given["rho_wall"] * given["Le"] / np.pi * E


@estimator("sphere.bowl.", n=30_000, dear=True)
def bowl(key, given, bits, seed, n):
    """What comes in through an opening cannot be told from a black lamp that covers it."""
    cap = {"emitter_area_fraction": given["open_fraction"], "rho_emitter": 0.0, "rho_wall": given["rho"]}
    return in_a_cavity(given | cap, [1, 0.2, -0.3], bits, seed, n)


@estimator("pixel.sphere_disk.", n=700_000)
def disc_of_a_sphere(key, given, bits, seed, n):
    """The area at unit distance that a sphere covers: its share of the picture, times the picture's."""
    half = 0.2 if given["d"] > 2.0 else 80.0
    fov = float(np.degrees(2.0 * np.arctan(half)))
    sensor = look([0, 0, given["d"]], [0, 0, 0], fov, up=(0, 1, 0))
    scene = tracer.load_dict({"sensor": sensor, "ball": lamps.sphere([0, 0, 0], given["R"])})
    return (2.0 * half) ** 2 * radiance(scene, bits, seed, n, max_depth=1)


@kernel("sphere.pointlight.", but=("bounces",))
def lit_ball(key, given, to):
    """Every point of the wall gets the same from the middle, so every path brings the same."""
    return still(ball(given["rho"]), to, 120, integrator="path")


@kernel("sphere.pointlight.rho=0.5.bounces")
def lit_ball_of_few_bounces(key, given, to):
    return still(ball(given["rho"]), to, given["max_scatter"] + 1, integrator="path")


def ball(rho):
    wall = {"type": "sphere", "flip_normals": True, "bsdf": diffuse(rho)}
    bulb = {"type": "point", "intensity": float(np.pi)}
    return tracer.load_dict({"sensor": look([0.2, 0, 0.1], [1, 0, 0]), "wall": wall, "bulb": bulb})


def mirror(reflectance=1.0):
    return {"type": "conductor", "specular_reflectance": reflectance}


def facing(center, towards, half=1.0, **more):
    """A square at `center` that faces the point `towards` along an axis."""
    axis = int(np.argmax(np.abs(np.subtract(towards, center))))
    u, v = (np.roll([half, 0.0, 0.0], axis + k) for k in (1, 2))
    square = lamps.rectangle(center, u, v, towards=towards)
    square.pop("emitter")
    return square | more


@estimator("plates.mirrorbox.", n=300, dear=True)
def between_plates(key, given, bits, seed, n):
    """Floor and ceiling diffuse, the floor shines; four mirrors make them endless.

    Every path brings the same, but for those that are so low that they meet a thousand mirrors.
    """
    up = 1.0 if ".other." in key else -1.0
    scene = {"sensor": look([0.1, 0.2, -0.1], [0.3, 0.1, up])}
    sides = [np.roll([s, 0.0, 0.0], axis) for axis in (0, 1) for s in (-1.0, 1.0)]
    for k, side in enumerate(sides):
        scene[f"side{k}"] = facing(side, [0, 0, 0], bsdf=mirror())
    scene["floor"] = facing(
        [0, 0, -1], [0, 0, 0], bsdf=diffuse(given["rho_emitter"]), emitter=area(given["Le"])
    )
    scene["ceiling"] = facing([0, 0, 1], [0, 0, 0], bsdf=diffuse(given["rho_other"]))
    return radiance(tracer.load_dict(scene), bits, seed, n, roulette="off", max_depth=1000)


def corridor(given):
    """Two mirrors that shine, seen head on from between them."""
    surface = {"bsdf": mirror(given["r"]), "emitter": area(given["Le"])}
    walls = {f"wall{k}": facing([0, 0, s], [0, 0, 0], **surface) for k, s in enumerate((-1.0, 1.0))}
    return tracer.load_dict({"sensor": look([0.1, 0.2, 0], [0.1, 0.2, 1], 1e-4), **walls})


@kernel("mirror.corridor.", but=("inf",))
def mirrors(key, given, to):
    return still(corridor(given), to, given["max_scatter"] + 1)


@estimator("mirror.corridor.r=0.5.inf", "mirror.corridor.r=0.9.inf", n=130_000, dear=True)
def endless_mirrors(key, given, bits, seed, n):
    return radiance(corridor(given), bits, seed, n)


def panes(theta_deg, **between):
    """A far lamp behind panes, seen at an angle of incidence by rays that are parallel."""
    theta = np.radians(theta_deg)
    origin = [np.sin(theta), 0.0, np.cos(theta)]
    lamp = facing([0, 0, -9], [0, 0, 0], 1e3, emitter=area(1.0))
    sensor = look([3 * x for x in origin], [0, 0, 0], 1e-4, up=(0, 1, 0))
    return tracer.load_dict({"sensor": sensor, "lamp": lamp, **between})


@estimator(*(f"slab.T.scalar.{at}.terms" for at in (45, 60, 80)), n=50_000)
def through_a_slab(key, given, bits, seed, n):
    """A block of glass with two faces, and paths of up to 2 terms of their events."""
    glass = {"type": "dielectric", "int_ior": given["n"], "ext_ior": 1.0}
    slab = {"type": "cube", "to_world": [{"scale": [500, 500, 0.5]}], "bsdf": glass}
    depth = 2 * given["terms"] + 1
    return radiance(panes(given["theta_deg"], slab=slab), bits, seed, n, max_depth=depth)


@estimator("slab.stack.", n=50_000)
def through_panes(key, given, bits, seed, n):
    glass = {"type": "thindielectric", "int_ior": given["n"], "ext_ior": 1.0}
    pile = {f"pane{k}": facing([0, 0, -0.1 * k], [0, 0, 9], 500.0, bsdf=glass) for k in range(given["M"])}
    return radiance(panes(0.0, **pile), bits, seed, n)

"""A cast_ray that asks two lamp points at each vertex, and plays roulette from a bounce on."""

from tracer.learner import Ray, dot, length, normalize

SHADOW_RAYS = 2
FREE_BOUNCES = 0
KEEP = 0.7
TOLERANCE = 0.05  # mm


class Vertex:
    """What is known where the path stands."""

    def __init__(self, hit, came):
        self.p, self.n, self.material = hit.p, hit.n, hit.material
        self.out = -came


def is_open(scene, v, to, far):
    seen = scene.intersect(Ray(v.p, to))
    return seen is None or seen.t + TOLERANCE > far


def from_lamps(scene, v):
    total = 0.0
    for _ in range(SHADOW_RAYS):
        lamp = scene.sample_light()
        gap = lamp.p - v.p
        r2 = dot(gap, gap)
        to = normalize(gap)
        g = max(dot(v.n, to), 0.0) * max(-dot(lamp.n, to), 0.0) / r2
        if g > 0.0 and is_open(scene, v, to, length(gap)):
            total = total + lamp.emission * v.material.eval(to, v.out, v.n) * g / lamp.pdf
    return total / SHADOW_RAYS


def onward(scene, v, depth):
    weight = 1.0
    if depth >= FREE_BOUNCES:
        if scene.random() > KEEP:
            return 0.0
        weight = 1.0 / KEEP
    to = v.material.sample(v.out, v.n)
    density = v.material.pdf(to, v.out, v.n)
    if density <= 0.0:
        return 0.0
    reflected = v.material.eval(to, v.out, v.n) * dot(v.n, to) / density * weight
    return reflected * cast_ray(scene, Ray(v.p, to), depth + 1)


def cast_ray(scene, ray, depth):
    hit = scene.intersect(ray)
    if hit is None:
        return 0.0
    if hit.emission:
        return hit.emission if depth == 0 else 0.0
    v = Vertex(hit, ray.direction)
    return from_lamps(scene, v) + onward(scene, v, depth)

"""A path tracer to start from: `castray check this_file.py` says what is wrong with it, and where.

cast_ray(scene, ray, depth) gives the light that comes back along a ray, as in the homework. What the scene
hands out are numbers that remember what they are: multiply, add and divide them as you like.

    scene.intersect(ray)    the nearest hit, or None: hit.p, hit.n, hit.t, hit.material, hit.emission
    scene.sample_light()    a point on a lamp: light.p, light.n, light.emission, light.pdf (per area)
    scene.random()          a random number from 0 to 1
    material.eval(wi, wo, n), material.pdf(wi, wo, n), material.sample(wo, n)

wo points back along the ray, wi to where light comes from: both leave the surface.
"""

from tracer.learner import Ray, dot, length, normalize

SURVIVAL = 0.8


def cast_ray(scene, ray, depth):
    hit = scene.intersect(ray)
    if hit is None:
        return 0.0
    if hit.emission:  # at other depths the light sample below has counted it
        return hit.emission if depth == 0 else 0.0
    wo, n, material = -ray.direction, hit.n, hit.material

    # Direct light: one point on a lamp
    direct = 0.0
    light = scene.sample_light()
    towards = light.p - hit.p
    wi = normalize(towards)
    cos, cos_light = max(dot(n, wi), 0.0), max(dot(light.n, -wi), 0.0)
    blocker = scene.intersect(Ray(hit.p, wi))
    if blocker is None or blocker.t > 0.999 * length(towards):
        f = material.eval(wi, wo, n)
        direct = light.emission * f * cos * cos_light / dot(towards, towards) / light.pdf

    # Indirect light: go on where the material chooses, if roulette allows it
    indirect = 0.0
    if scene.random() < SURVIVAL:
        wi = material.sample(wo, n)
        pdf = material.pdf(wi, wo, n)
        if pdf > 0.0:
            f = material.eval(wi, wo, n)
            indirect = cast_ray(scene, Ray(hit.p, wi), depth + 1) * f * dot(n, wi) / pdf / SURVIVAL

    return direct + indirect

"""A path tracer as one flat loop in NumPy, MIS, two lamps; writes castray's log, one event a line.

python shed.py LOG [float32 | float64] [digits]
"""

import json
import math
import sys
from functools import partial

import numpy as np

REAL = np.dtype(sys.argv[2] if len(sys.argv) > 2 else "float64").type
DIGITS = int(sys.argv[3] if len(sys.argv) > 3 else 12)
SIDE, SPP, FREE, KEEP = 20, 8, 0, 0.75
BACK = 1e-4  # how far before its end a shadow ray stops


def vec(*xyz):
    return np.array(xyz, REAL)


def unit(v):
    return v / np.sqrt(v @ v)


BOARD, CLAY, SOOT = vec(0.6, 0.55, 0.5), vec(0.7, 0.3, 0.2), vec(0, 0, 0)
LOW, HIGH = vec(-2, 0, -2.5), vec(2, 3, 2.5)
BALL, RADIUS = vec(0.7, 0.6, -0.5), REAL(0.6)


class Lamp:
    def __init__(self, middle, across, up, n, radiance):
        self.middle, self.across, self.up, self.n, self.radiance = middle, across, up, n, radiance
        self.area = 4 * np.sqrt((across @ across) * (up @ up))


LAMPS = [
    Lamp(vec(0, 2.9, 0), vec(0.5, 0, 0), vec(0, 0, 0.4), vec(0, -1, 0), vec(8, 7, 5)),
    Lamp(vec(-1.9, 1.2, -1), vec(0, 0, -0.3), vec(0, 0.2, 0), vec(1, 0, 0), vec(4, 8, 18)),
]
POWERS = [lamp.area * lamp.radiance.sum() for lamp in LAMPS]
PICKS = [power / sum(POWERS) for power in POWERS]


def nearest(o, d):
    """Distance, point, normal, colour and number of the lamp (-1: none) of the first hit."""
    t, p, n, colour, which = REAL(np.inf), None, None, None, -1
    for a in range(3):  # the room from within
        if d[a] == 0:
            continue
        wall = HIGH[a] if d[a] > 0 else LOW[a]
        far = (wall - o[a]) / d[a]
        if 0 < far < t:
            t, n, colour = far, vec(0, 0, 0), BOARD
            n[a] = -np.sign(d[a])
            p = o + t * d
            p[a] = wall
    k = o - BALL
    b, c = k @ d, k @ k - RADIUS * RADIUS
    inside = b * b - c
    if inside > 0 and b < 0 and c > 1e-5 and 0 < -b - np.sqrt(inside) < t:
        t = -b - np.sqrt(inside)
        n = unit(k + t * d)
        p, colour = BALL + RADIUS * n, CLAY
    for i, lamp in enumerate(LAMPS):
        slope = lamp.n @ d
        if slope == 0:
            continue
        far = lamp.n @ (lamp.middle - o) / slope
        if not 0 < far < t:
            continue
        x = o + far * d - lamp.middle
        if abs(x @ lamp.across) <= lamp.across @ lamp.across and abs(x @ lamp.up) <= lamp.up @ lamp.up:
            t, p, n, colour, which = far, o + far * d, lamp.n, SOOT, i
    return t, p, n, colour, which


def frame(n):
    other = vec(1, 0, 0) if abs(n[0]) < 0.5 else vec(0, 1, 0)
    s = unit(np.cross(other, n))
    return s, np.cross(n, s)


def power_weight(a, b):
    return a * a / (a * a + b * b)


def plain(value):
    if isinstance(value, np.ndarray):
        return [plain(x) for x in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, str)):
        return value
    return "inf" if math.isinf(value) else float(f"{float(value):.{DIGITS}g}")


def event(out, whose, kind, **fields):
    out.write(json.dumps({"kind": kind} | whose | {k: plain(v) for k, v in fields.items()}) + "\n")


def main():
    out = open(sys.argv[1], "w", encoding="utf-8")
    head = {
        "castray": 1, "tracer": "shed", "digits": DIGITS, "bits": 8 * np.dtype(REAL).itemsize,
        "width": SIDE, "height": SIDE, "spp": SPP, "integrator": "path", "strategy": "mis",
        "heuristic": "power", "hemisphere": "cosine", "light_sampling": "area", "roulette": KEEP,
    }  # fmt: skip
    out.write(json.dumps(head) + "\n")
    rng = np.random.default_rng(7)
    eye = vec(0.2, 1.5, 2.4)
    ahead = unit(vec(0, 1.2, -1) - eye)
    right = unit(np.cross(ahead, vec(0, 1, 0)))
    top = np.cross(right, ahead)
    half = math.tan(math.radians(70) / 2)
    mean = np.zeros(3)

    for y, x, s in np.ndindex(SIDE, SIDE, SPP):
        log = partial(event, out, {"x": x, "y": y, "sample": s})
        jx, jy = rng.random(2)
        film = vec(x + jx, y + jy)
        px, py = half * (2 * film[0] / SIDE - 1), half * (1 - 2 * film[1] / SIDE)
        o, d = eye, unit(ahead + px * right + py * top)
        beta, total, density, depth = vec(1, 1, 1), vec(0, 0, 0), REAL(np.inf), 0
        log("camera", film=film, o=o, d=d, beta=beta)
        while True:
            t, p, n, colour, which = nearest(o, d)
            wo = -d
            Le, shown, pdf_light, w = vec(0, 0, 0), vec(0, 0, 0), 0.0, 1.0
            if which >= 0 and wo @ n > 0:
                lamp = LAMPS[which]
                Le = lamp.radiance
                pdf_light = PICKS[which] / lamp.area * t * t / (wo @ n)
                w = 1.0 if depth == 0 else power_weight(density, pdf_light)
                shown = beta * Le * w
            total = total + shown
            log(
                "hit", depth=depth, p=p, t=t, n=n, wo=wo, albedo=colour, beta=beta, Le=Le, pdf_bsdf=density,
                pdf_light=pdf_light, w=w, contribution=shown,
            )  # fmt: skip
            if which >= 0:
                reason = "black"
                break

            # one point on one lamp
            u = rng.random(3)
            i = 0 if u[0] < PICKS[0] else 1
            lamp = LAMPS[i]
            q = lamp.middle + (2 * u[1] - 1) * lamp.across + (2 * u[2] - 1) * lamp.up
            nq = lamp.n
            gap = q - p
            r = np.sqrt(gap @ gap)
            wi = gap / r
            cos, cos_light = n @ wi, -(nq @ wi)
            f, pdf_area = colour / REAL(math.pi), 1 / lamp.area
            Le = lamp.radiance if cos_light > 0 else vec(0, 0, 0)
            pdf = PICKS[i] * pdf_area * r * r / cos_light if cos_light > 0 else 0.0
            pdf_bsdf = max(cos, REAL(0)) / REAL(math.pi)
            w = power_weight(pdf, pdf_bsdf) if pdf > 0 else 0.0
            visible, term = False, vec(0, 0, 0)
            if cos > 0 and cos_light > 0:
                visible = nearest(p, wi)[0] > r - BACK
                term = beta * f * lamp.radiance * cos * w / pdf if visible else term
                total = total + term
            log(
                "light", depth=depth, q=q, nq=nq, wi=wi, distance=r, light=i, pick=PICKS[i], u=u, beta=beta,
                pdf_area=pdf_area, Le=Le, f=f, cos=abs(cos), cos_light=cos_light, pdf=pdf, pdf_bsdf=pdf_bsdf,
                visible=visible, w=w, contribution=term,
            )  # fmt: skip

            # the next direction
            v = rng.random(3)  # the first would choose the lobe
            turn, out_of_centre = 2 * math.pi * v[1], math.sqrt(v[2])
            up = math.sqrt(1 - v[2])
            a, b = frame(n)
            d = (
                REAL(out_of_centre * math.cos(turn)) * a
                + REAL(out_of_centre * math.sin(turn)) * b
                + REAL(up) * n
            )
            d = unit(d)
            cos = n @ d
            density = cos / REAL(math.pi)
            before = beta
            beta = beta * f * cos / density
            log("bounce", depth=depth, wi=d, f=f, cos=cos, pdf=density, beta_before=before, beta=beta, u=v)

            if depth >= FREE:
                number = rng.random()
                beta = beta / KEEP if number < KEEP else beta
                log("roulette", depth=depth, probability=KEEP, u=number, survived=number < KEEP, beta=beta)
                if number >= KEEP:
                    reason = "roulette"
                    break
            o = p
            depth += 1
        log("end", reason=reason, radiance=total)
        mean += total
    print(mean / (SIDE * SIDE * SPP))


main()

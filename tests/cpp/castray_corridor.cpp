// A recursive path tracer of mirror_corridor: shapes as closures, vectors as std::array, a vertex that estimates its own
// terms. One lamp, a ball, sampled by area; what a mirror shows counts whole. -DDOUBLES, -DDIGITS=6, and -DLITTLE
// (points, normals and terms only) change how and what it logs by castray.h.
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

#ifndef PICTURE
#define PICTURE 32
#endif
#ifndef SAMPLES
#define SAMPLES 8
#endif
#ifdef DOUBLES
typedef double real;
#define CASTRAY_BITS 64
#else
typedef float real;
#endif
#ifdef DIGITS
#define CASTRAY_DIGITS DIGITS
#endif
#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#define CASTRAY_HEADER                                                                                              \
    "\"width\": " TEXT(PICTURE) ", \"height\": " TEXT(PICTURE) ", \"spp\": " TEXT(SAMPLES) ", \"strategy\": \"light\", " \
    "\"light_sampling\": \"area\", \"hemisphere\": \"cosine\", \"roulette\": 0.85, \"jitter\": true"
#include "castray.h"

typedef std::array<real, 3> Triple;

static Triple each(const Triple &a, const Triple &b, const std::function<real(real, real)> &f) {
    return {{f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2])}};
}
static Triple operator+(const Triple &a, const Triple &b) { return each(a, b, std::plus<real>()); }
static Triple operator-(const Triple &a, const Triple &b) { return each(a, b, std::minus<real>()); }
static Triple operator*(const Triple &a, const Triple &b) { return {{a[0] * b[0], a[1] * b[1], a[2] * b[2]}}; }
static Triple operator*(real s, const Triple &a) { return {{s * a[0], s * a[1], s * a[2]}}; }
static real dot(const Triple &a, const Triple &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static real norm(const Triple &a) { return std::sqrt(dot(a, a)); }
static Triple unit(const Triple &a) { return (1 / norm(a)) * a; }
static Triple cross(const Triple &a, const Triple &b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

static const real PI = real(3.14159265358979323846), KEEP = real(0.85), NEAR = real(1e-5), CLEAR = real(2e-3);
static const Triple NOTHING = {{0, 0, 0}};

struct Paint { Triple colour; bool mirror; Triple glow; };
static const Paint WOOD = {{{real(0.45), real(0.3), real(0.18)}}, false, NOTHING};
static const Paint WALL = {{{real(0.6), real(0.6), real(0.6)}}, false, NOTHING};
static const Paint MIRROR = {{{real(0.93), real(0.96), real(0.94)}}, true, NOTHING};
static const Paint BULB = {NOTHING, false, {{9, 8, real(6.5)}}};
static const Triple MIDDLE = {{real(-0.35), real(0.3), real(-0.2)}};
static const real RADIUS = real(0.14);

struct Beam { Triple from, along; };
struct Touch { real t; Triple p, n; const Paint *paint; };
typedef std::function<void(const Beam &, Touch &)> Shape;  // makes the touch nearer where it can

static std::mt19937_64 dice;
static real roll() { return real((dice() >> 40) / 16777216.0); }

// The side of the cube [-1, 1]^3 at axis = side, seen from within.
static Shape side_of_room(int axis, real side, const Paint &paint) {
    return [=, &paint](const Beam &b, Touch &nearest) {
        if (b.along[axis] * side <= 0) return;
        real t = (side - b.from[axis]) / b.along[axis];
        if (t < -NEAR || t >= nearest.t) return;  // a ray that starts in a corner meets the other wall at once
        Triple n = NOTHING, p = b.from + t * b.along;
        n[axis] = -side;
        p[axis] = side;
        nearest = {t, p, n, &paint};
    };
}

static Shape ball(const Triple &middle, real radius, const Paint &paint) {
    return [=, &paint](const Beam &b, Touch &nearest) {
        double k[3], d[3];
        for (int i = 0; i < 3; ++i) k[i] = double(b.from[i]) - middle[i], d[i] = b.along[i];
        double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], kd = k[0] * d[0] + k[1] * d[1] + k[2] * d[2];
        double kk = k[0] * k[0] + k[1] * k[1] + k[2] * k[2] - double(radius) * radius, disc = kd * kd - dd * kk;
        if (disc < 0) return;
        double t = (-kd - std::sqrt(disc)) / dd;
        if (t < NEAR || t >= nearest.t) return;
        Triple n = {{real((k[0] + t * d[0]) / radius), real((k[1] + t * d[1]) / radius), real((k[2] + t * d[2]) / radius)}};
        n = unit(n);
        nearest = {real(t), middle + radius * n, n, &paint};
    };
}

static const std::vector<Shape> ROOM = {
    side_of_room(2, -1, MIRROR), side_of_room(2, 1, MIRROR), side_of_room(1, -1, WOOD), side_of_room(1, 1, WALL),
    side_of_room(0, -1, WALL),   side_of_room(0, 1, WALL),   ball(MIDDLE, RADIUS, BULB)};

static Touch follow(const Beam &beam) {
    Touch nearest = {real(1e9), NOTHING, NOTHING, nullptr};
    for (const Shape &shape : ROOM) shape(beam, nearest);
    return nearest;
}

static Triple on_sphere() {
    real z = 1 - 2 * roll(), turn = 2 * PI * roll(), r = std::sqrt(std::fmax(real(0), 1 - z * z));
    return {{r * std::cos(turn), r * std::sin(turn), z}};
}

struct Lit { Triple q, nq, to, f, sum; real far, cosine, cosine_q, density; bool open; };
struct Next { Triple to, f; real cosine, density; };

class Vertex {
  public:
    Vertex(const Touch &touch, const Triple &back) : p(touch.p), n(touch.n), back(back), paint(*touch.paint) {}

    Triple reflectivity(const Triple &to) const { return dot(n, to) > 0 ? 1 / PI * paint.colour : NOTHING; }

    Lit lit() const {
        Lit l;
        Triple s = on_sphere();
        l.q = MIDDLE + RADIUS * s;
        l.nq = s;
        l.density = 1 / (4 * PI * RADIUS * RADIUS);
        l.far = norm(l.q - p);
        l.to = 1 / l.far * (l.q - p);
        l.cosine = dot(n, l.to);
        l.cosine_q = -dot(l.nq, l.to);
        l.f = reflectivity(l.to);
        l.sum = NOTHING;
        l.open = false;
        if (l.cosine <= 0 || l.cosine_q <= 0) return l;
        Touch seen = follow({p, l.to});
        l.open = !seen.paint || seen.t > l.far - CLEAR;
        if (l.open) l.sum = l.cosine * l.cosine_q / (l.far * l.far) / l.density * (l.f * BULB.glow);
        return l;
    }

    Next next() const {
        if (paint.mirror) return {2 * dot(n, back) * n - back, paint.colour, dot(n, back), 1};
        Triple to = n + on_sphere();
        while (norm(to) < NEAR) to = n + on_sphere();
        to = unit(to);
        return {to, reflectivity(to), dot(n, to), dot(n, to) / PI};
    }

    Triple p, n, back;
    const Paint &paint;
};

static Triple radiance(const Beam &beam, int depth, bool bulb_counts) {
    CASTRAY_CALL(beam.from, beam.along, depth);
    const Touch touch = follow(beam);
    if (!touch.paint) return CASTRAY_RETURN(NOTHING);
    Vertex here(touch, real(-1) * beam.along);
    CASTRAY_LOG("hit.p", here.p, "hit.n", here.n);

    Triple glow = bulb_counts ? here.paint.glow : NOTHING, direct = NOTHING, indirect = NOTHING;
    CASTRAY_LOG("emission", glow);
#ifndef LITTLE
    CASTRAY_LOG("hit.Le", here.paint.glow, "hit.t", touch.t);
#endif
    if (&here.paint == &BULB) return CASTRAY_RETURN(glow);
    if (!here.paint.mirror) {
        Lit l = here.lit();
        direct = l.sum;
        CASTRAY_LOG("direct", direct);
#ifndef LITTLE
        CASTRAY_LOG("light.q", l.q, "light.nq", l.nq, "light.Le", BULB.glow, "light.f", l.f, "light.distance", l.far);
        CASTRAY_LOG("light.pdf_area", l.density, "light.wi", l.to);
        if (l.cosine > 0 && l.cosine_q > 0) CASTRAY_LOG("light.cos", l.cosine, "light.cos_light", l.cosine_q, "light.visible", l.open);
#endif
    }
    bool goes_on = roll() < KEEP;
#ifndef LITTLE
    CASTRAY_LOG("roulette.probability", KEEP, "roulette.survived", goes_on);
#endif
    if (goes_on) {
        Next next = here.next();
        if (next.density > 0) {
            Triple inner = radiance({here.p, next.to}, depth + 1, here.paint.mirror);
            real share = (here.paint.mirror ? 1 : next.cosine / next.density) / KEEP;
            indirect = share * (next.f * inner);
#ifndef LITTLE
            CASTRAY_LOG("bounce.wi", next.to, "bounce.f", next.f, "bounce.cos", next.cosine, "bounce.pdf", next.density);
            CASTRAY_LOG("bounce.delta", here.paint.mirror);
#endif
        }
    }
    CASTRAY_LOG("indirect", indirect);
    return CASTRAY_RETURN(glow + direct + indirect);
}

int main() {
    const Triple eye = {{real(0.35), real(0.2), real(0.9)}}, aim = {{real(-0.1), real(-0.05), -1}}, up = {{0, 1, 0}};
    const Triple ahead = unit(aim - eye), right = unit(cross(ahead, up)), top = cross(right, ahead);
    const real half = std::tan(30 * PI / 180);
    double total[3] = {0, 0, 0};
    dice.seed(20);
    for (int y = 0; y < PICTURE; ++y)
        for (int x = 0; x < PICTURE; ++x)
            for (int s = 0; s < SAMPLES; ++s) {
                real a = (2 * (x + roll()) / PICTURE - 1) * half, b = (1 - 2 * (y + roll()) / PICTURE) * half;
                CASTRAY_PATH(x, y, s);
                Triple L = radiance({eye, unit(ahead + a * right + b * top)}, 0, true);
                for (int c = 0; c < 3; ++c) total[c] += L[c];
            }
    for (int c = 0; c < 3; ++c) std::printf("%g ", total[c] / (double(PICTURE) * PICTURE * SAMPLES));
    std::printf("\n");
}

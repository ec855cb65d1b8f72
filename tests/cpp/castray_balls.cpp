// A small recursive path tracer of the unit Cornell box with a glass and a mirror ball: lights found both ways,
// balance heuristic, cosine hemisphere, spheres and rectangles, doubles. Other in shape than castray_box.cpp:
// what the caller knows comes along as a record, and mirrors and glass call before a light is asked for.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#ifndef PICTURE
#define PICTURE 32
#endif
#ifndef SAMPLES
#define SAMPLES 8
#endif
#define CASTRAY_BITS 64
#define CASTRAY_DIGITS 12
#define CASTRAY_HEADER                                                                     \
    "\"width\": " TEXT(PICTURE) ", \"height\": " TEXT(PICTURE) ", \"spp\": " TEXT(SAMPLES) \
    ", \"integrator\": \"path\", \"heuristic\": \"balance\", \"light_sampling\": \"area\", \"jitter\": true"
#include "castray.h"

static const double pi = 3.14159265358979323846, infinite = 1e300;

struct V3 {
    double x, y, z;
    friend V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend V3 operator*(V3 a, V3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
    friend V3 operator*(double s, V3 a) { return {s * a.x, s * a.y, s * a.z}; }
};
static double dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static V3 unit(V3 a) { return 1 / std::sqrt(dot(a, a)) * a; }
static V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

// xorshift64*, seeded anew for each sample of each pixel
struct Dice {
    std::uint64_t state;
    Dice(int i, int j, int k) : state(0x9E3779B97F4A7C15ull * (1 + std::uint64_t(i) + 4096ull * (j + 4096ull * k))) {
        for (int n = 0; n < 8; ++n) roll();
    }
    double roll() {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        return double((state * 0x2545F4914F6CDD1Dull) >> 11) / 9007199254740992.0;
    }
};

enum Kind { MATT, MIRROR, GLASS };
struct Surface { Kind kind; V3 colour, glow; };
struct Ray { V3 from, along; };
struct Meeting { double t; V3 at, normal; const Surface *surface; bool shines; };

struct Shape {
    Surface surface;
    explicit Shape(Surface s) : surface(s) {}
    virtual ~Shape() {}
    virtual double meets(const Ray &ray) const = 0;
    virtual V3 normal(V3 at) const = 0;
};

struct Ball : Shape {
    V3 centre;
    double radius;
    Ball(V3 c, double r, Surface s) : Shape(s), centre(c), radius(r) {}
    double meets(const Ray &ray) const override {
        V3 away = ray.from - centre;
        double b = dot(away, ray.along), c = dot(away, away) - radius * radius, root = b * b - c;
        if (root < 0) return infinite;
        root = std::sqrt(root);
        double near = -b - root, far = -b + root;
        return near > 1e-7 ? near : far > 1e-7 ? far : infinite;
    }
    V3 normal(V3 at) const override { return unit(at - centre); }
};

struct Plate : Shape {
    V3 middle, u, v, n;
    Plate(V3 m, V3 u_, V3 v_, Surface s) : Shape(s), middle(m), u(u_), v(v_), n(unit(cross(u_, v_))) {}
    double meets(const Ray &ray) const override {
        double slope = dot(n, ray.along);
        if (slope == 0) return infinite;
        double t = dot(n, middle - ray.from) / slope;
        if (t < 1e-7) return infinite;
        V3 on = ray.from + t * ray.along - middle;
        bool inside = std::fabs(dot(on, u)) <= dot(u, u) && std::fabs(dot(on, v)) <= dot(v, v);
        return inside ? t : infinite;
    }
    V3 normal(V3) const override { return n; }
    double area() const { return 4 * std::sqrt(dot(u, u) * dot(v, v)); }
};

static const V3 none = {0, 0, 0}, ones = {1, 1, 1};
static const V3 white = {.885809, .698859, .666422}, green = {.105421, .37798, .076425}, red = {.570068, .0430135, .0443706};
static const Plate *lamp;
static std::vector<std::unique_ptr<Shape>> shapes;

static void build() {
    const Surface matt = {MATT, white, none}, bulb = {MATT, white, {18.387, 13.9873, 6.75357}};
    lamp = new Plate({0, .99, .01}, {.23, 0, 0}, {0, 0, .19}, bulb);
    shapes.emplace_back(const_cast<Plate *>(lamp));
    shapes.emplace_back(new Plate({0, -1, 0}, {0, 0, 1}, {1, 0, 0}, matt));
    shapes.emplace_back(new Plate({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, matt));
    shapes.emplace_back(new Plate({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, matt));
    shapes.emplace_back(new Plate({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {MATT, green, none}));
    shapes.emplace_back(new Plate({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {MATT, red, none}));
    shapes.emplace_back(new Ball({.43, -.62, .3}, .38, {GLASS, ones, none}));
    shapes.emplace_back(new Ball({-.42, -.58, -.35}, .42, {MIRROR, ones, none}));
}

static Meeting nearest(const Ray &ray) {
    Meeting best = {infinite, none, none, nullptr, false};
    const Shape *met = nullptr;
    for (const auto &shape : shapes) {
        double t = shape->meets(ray);
        if (t < best.t) { best.t = t; met = shape.get(); }
    }
    if (!met) return best;
    best.at = ray.from + best.t * ray.along;
    best.normal = met->normal(best.at);
    best.surface = &met->surface;
    best.shines = met == lamp && dot(best.normal, ray.along) < 0;
    return best;
}

// The density of the lamp's points as seen from `from`, per solid angle.
static double lamp_density(V3 from, V3 at) {
    V3 way = at - from;
    double r2 = dot(way, way), cosine = -dot(lamp->n, way) / std::sqrt(r2);
    return cosine > 0 ? r2 / (cosine * lamp->area()) : 0;
}

static double fresnel(double cosine, double in, double out) {
    double sine2 = in * in / (out * out) * (1 - cosine * cosine);
    if (sine2 >= 1) return 1;
    double beyond = std::sqrt(1 - sine2);
    double s = (in * cosine - out * beyond) / (in * cosine + out * beyond);
    double p = (out * cosine - in * beyond) / (out * cosine + in * beyond);
    return (s * s + p * p) / 2;
}

struct Caller {  // what the call before knew
    int depth;
    bool dirac;      // camera, mirror or glass
    double density;  // of the ray's direction
    V3 vertex;
};

static V3 seen(const Ray &ray, Caller before, Dice &dice);

static V3 deeper(const Ray &ray, const Meeting &hit, Caller next, Dice &dice) {
    next.depth += 1;
    next.vertex = hit.at;
    return seen(ray, next, dice);
}

static V3 smooth(const Ray &ray, const Meeting &hit, Caller before, Dice &dice, V3 &share, double &chance, V3 &way, bool &survives) {
    V3 d = ray.along, n = hit.normal;
    V3 mirrored = unit(d - 2 * dot(d, n) * n);
    way = mirrored;
    share = ones;
    chance = 1;
    if (hit.surface->kind == GLASS) {
        bool enters = dot(d, n) < 0;
        double in = enters ? 1 : 1.5, out = enters ? 1.5 : 1;
        V3 facing = enters ? n : -1 * n;
        double cosine = -dot(d, facing), F = fresnel(cosine, in, out), eta = in / out;
        if (dice.roll() < F) {
            chance = F;
            share = F * ones;
        } else {
            double beyond = std::sqrt(1 - eta * eta * (1 - cosine * cosine));
            way = unit(eta * d + (eta * cosine - beyond) * facing);
            chance = 1 - F;
            share = (1 - F) * eta * eta * ones;
        }
    }
    // A ray may be reflected within a ball for ever, but for this
    double q_survive = before.depth < 20 ? 1 : .8;
    survives = dice.roll() < q_survive;
    if (!survives) return none;
    Caller next = before;
    next.dirac = true;
    return (1 / chance / q_survive) * share * deeper({hit.at, way}, hit, next, dice);
}

static V3 seen(const Ray &ray, Caller before, Dice &dice) {
    CASTRAY_CALL(ray.from, ray.along, before.depth);
    Meeting hit = nearest(ray);
    if (!hit.surface) return CASTRAY_RETURN(none);
    V3 at = hit.at, n = hit.normal;
    CASTRAY_LOG("hit.p", at, "hit.n", n);

    V3 glow = hit.shines ? hit.surface->glow : none;
    double other_light = hit.shines ? lamp_density(before.vertex, at) : 0;
    double w_own = before.dirac ? 1 : before.density / (before.density + other_light);
    V3 own = w_own * glow;
    CASTRAY_LOG("hit.Le", glow, "hit.w", w_own, "hit.pdf_light", other_light);
    CASTRAY_LOG("hit.pdf_bsdf", before.dirac ? HUGE_VAL : before.density);
    CASTRAY_LOG("emission", own);

    if (hit.surface->kind != MATT) {
        V3 share, way;
        double chance;
        bool survives;
        V3 through = smooth(ray, hit, before, dice, share, chance, way, survives);
        CASTRAY_LOG("bounce.wi", way, "bounce.f", share, "bounce.pdf", chance, "bounce.delta", true);
        double q_survive = before.depth < 20 ? 1 : .8;
        CASTRAY_LOG("roulette.probability", q_survive, "roulette.survived", survives);
        CASTRAY_LOG("indirect", through);
        return CASTRAY_RETURN(own + through);
    }
    if (dot(ray.along, n) > 0) return CASTRAY_RETURN(own);
    V3 f = 1 / pi * hit.surface->colour;

    V3 q = lamp->middle + (2 * dice.roll() - 1) * lamp->u;
    q = q + (2 * dice.roll() - 1) * lamp->v;
    V3 way = q - at, to_lamp = unit(way);
    double length = std::sqrt(dot(way, way)), cosine = dot(n, to_lamp), density = lamp_density(at, q);
    double other = std::max(cosine, 0.) / pi, w = density > 0 ? density / (density + other) : 0;
    bool free = false;
    V3 direct = none, f_light = cosine > 0 ? f : none;
    if (cosine > 0 && density > 0) {
        Meeting blocker = nearest({at, to_lamp});
        free = blocker.t > length * (1 - 1e-6);
        if (free) direct = w * cosine / density * f * lamp->surface.glow;
    }
    CASTRAY_LOG("light.q", q, "light.nq", lamp->n, "light.wi", to_lamp, "light.f", f_light);
    CASTRAY_LOG("light.cos", std::max(cosine, 0.), "light.pdf", density, "light.pdf_bsdf", other, "light.w", w);
    CASTRAY_LOG("light.Le", density > 0 ? lamp->surface.glow : none, "light.visible", free, "direct", direct);

    double q_survive = before.depth < 3 ? 1 : .8;
    bool goes_on = dice.roll() < q_survive;
    CASTRAY_LOG("roulette.probability", q_survive, "roulette.survived", goes_on);
    if (!goes_on) {
        CASTRAY_LOG("indirect", none);
        return CASTRAY_RETURN(own + direct);
    }
    double u = dice.roll(), phi = 2 * pi * dice.roll();
    V3 other_axis = std::fabs(n.x) > .8 ? V3{0, 1, 0} : V3{1, 0, 0};
    V3 s = unit(cross(n, other_axis)), t = cross(n, s);
    V3 wi = std::sqrt(u) * std::cos(phi) * s + std::sqrt(u) * std::sin(phi) * t + std::sqrt(1 - u) * n;
    double cos_bounce = dot(wi, n), pdf = cos_bounce / pi;
    CASTRAY_LOG("bounce.wi", wi, "bounce.f", f, "bounce.cos", cos_bounce, "bounce.pdf", pdf, "bounce.delta", false);
    Caller next = before;
    next.dirac = false;
    next.density = pdf;
    V3 indirect = cos_bounce / pdf / q_survive * f * deeper({at, wi}, hit, next, dice);
    CASTRAY_LOG("indirect", indirect);
    return CASTRAY_RETURN(own + direct + indirect);
}

int main() {
    build();
    const double half = std::tan(39.3077 / 2 * pi / 180);
    const V3 eye = {0, 0, 3.9};
    V3 mean = none;
    for (int j = 0; j < PICTURE; ++j)
        for (int i = 0; i < PICTURE; ++i)
            for (int k = 0; k < SAMPLES; ++k) {
                Dice dice(i, j, k);
                CASTRAY_PATH(i, j, k);
                double x = 2 * (i + dice.roll()) / PICTURE - 1, y = 1 - 2 * (j + dice.roll()) / PICTURE;
                Ray ray = {eye, unit({half * x, half * y, -1})};
                mean = mean + 1. / (PICTURE * PICTURE * SAMPLES) * seen(ray, {0, true, 0, eye}, dice);
            }
    std::printf("%g %g %g\n", mean.x, mean.y, mean.z);
    return 0;
}

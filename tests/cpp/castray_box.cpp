// A small recursive path tracer of the homework's box, in the homework's shape: one ray at a time, light
// sampled by area, uniform hemisphere, roulette 0.8.
//
//     castray_box [BUG [LEVEL [SEED [THREADS]]]]     prints the mean of the picture
//
// BUG is an id of the catalogue, or "none"; PEEK, right as well, looks at what is met next before it calls
// itself. LEVEL is how much is logged: 0 rays, 1 vertices and terms, 2 all.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)
#ifndef PICTURE
#define PICTURE 32
#endif
#ifndef SAMPLES
#define SAMPLES 4
#endif
#ifndef DECLARED
#define DECLARED \
    "\"width\": " TEXT(PICTURE) ", \"height\": " TEXT(PICTURE) ", \"spp\": " TEXT(SAMPLES) \
    ", \"jitter\": false, \"unit\": \"mm\", \"hemisphere\": \"uniform\", \"roulette\": 0.8"
#endif
#define CASTRAY_HEADER DECLARED
#include "castray.h"

#ifdef DOUBLE
typedef double Float;
#else
typedef float Float;
#endif

struct Vec {
    Float x, y, z;
    Vec() : x(0), y(0), z(0) {}
    explicit Vec(Float v) : x(v), y(v), z(v) {}
    Vec(Float x_, Float y_, Float z_) : x(x_), y(y_), z(z_) {}
    Vec operator+(const Vec &o) const { return Vec(x + o.x, y + o.y, z + o.z); }
    Vec operator-(const Vec &o) const { return Vec(x - o.x, y - o.y, z - o.z); }
    Vec operator-() const { return Vec(-x, -y, -z); }
    Vec operator*(const Vec &o) const { return Vec(x * o.x, y * o.y, z * o.z); }
    Vec operator*(Float s) const { return Vec(x * s, y * s, z * s); }
    Vec operator/(Float s) const { return Vec(x / s, y / s, z / s); }
};
static Float dot(const Vec &a, const Vec &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vec cross(const Vec &a, const Vec &b) {
    return Vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static Float length(const Vec &a) { return std::sqrt(dot(a, a)); }
static Vec normalize(const Vec &a) { return a / length(a); }

struct Ray { Vec origin, direction; };
struct Material { Vec kd, emission; };
struct Triangle { Vec a, e1, e2, n; Float area; const Material *m; };
struct Hit { bool happened; Float t; Vec p, n; const Material *m; };

static const char *planted = "none";
static int level = 2;
static bool bug(const char *id) { return std::strcmp(planted, id) == 0; }

static const Float PI = Float(3.14159265358979323846);
static const Float ROULETTE = Float(0.8);
static const Material red = {Vec(.63, .065, .05), Vec()}, green = {Vec(.14, .45, .091), Vec()},
                      white = {Vec(.725, .71, .68), Vec()},
                      lamp = {Vec(.65), Vec(47.8348, 38.5664, 31.0808)};
static std::vector<Triangle> triangles;

static thread_local std::mt19937 engine;
static Float uniform() {
    Float u = Float(engine()) * Float(1.0 / 4294967296.0);
    return u < 1 ? u : Float(0.99999994);
}

static void quad(const Vec &a, const Vec &b, const Vec &c, const Vec &d, const Material &m, const Vec &inside) {
    const Vec corners[2][3] = {{a, b, c}, {a, c, d}};
    for (int k = 0; k < 2; ++k) {
        Triangle t = {corners[k][0], corners[k][1] - corners[k][0], corners[k][2] - corners[k][0], Vec(), 0, &m};
        Vec n = cross(t.e1, t.e2);
        t.area = length(n) / 2;
        t.n = normalize(n);
        if (dot(t.n, inside - a) < 0) t.n = -t.n;
        triangles.push_back(t);
    }
}

// A box that stands on the floor: its corners in x and z, and its height.
static void box(const Float (*c)[2], Float h) {
    Vec middle((c[0][0] + c[2][0]) / 2, h / 2, (c[0][1] + c[2][1]) / 2);
    for (int k = 0; k < 4; ++k) {
        const Float *p = c[k], *q = c[(k + 1) % 4];
        Vec half((p[0] + q[0]) / 2, h / 2, (p[1] + q[1]) / 2);
        quad(Vec(p[0], 0, p[1]), Vec(q[0], 0, q[1]), Vec(q[0], h, q[1]), Vec(p[0], h, p[1]), white, half * 2 - middle);
    }
    quad(Vec(c[0][0], h, c[0][1]), Vec(c[1][0], h, c[1][1]), Vec(c[2][0], h, c[2][1]), Vec(c[3][0], h, c[3][1]), white,
         Vec(middle.x, 2 * h, middle.z));
}

static void build() {
    Vec in(278, 274, 280);
    quad(Vec(0, 0, 0), Vec(556, 0, 0), Vec(556, 0, 559.2), Vec(0, 0, 559.2), white, in);
    quad(Vec(0, 548.8, 0), Vec(556, 548.8, 0), Vec(556, 548.8, 559.2), Vec(0, 548.8, 559.2), white, in);
    quad(Vec(0, 0, 559.2), Vec(556, 0, 559.2), Vec(556, 548.8, 559.2), Vec(0, 548.8, 559.2), white, in);
    quad(Vec(0, 0, 0), Vec(0, 0, 559.2), Vec(0, 548.8, 559.2), Vec(0, 548.8, 0), green, in);
    quad(Vec(552.8, 0, 0), Vec(549.6, 0, 559.2), Vec(556, 548.8, 559.2), Vec(556, 548.8, 0), red, in);
    quad(Vec(213, 548.7, 227), Vec(343, 548.7, 227), Vec(343, 548.7, 332), Vec(213, 548.7, 332), lamp, in);
    const Float small[4][2] = {{130, 65}, {82, 225}, {240, 272}, {290, 114}};
    const Float tall[4][2] = {{423, 247}, {265, 296}, {314, 456}, {472, 406}};
    box(small, 165);
    box(tall, 330);
}

static Hit intersect(const Ray &ray) {
    Hit hit = {false, Float(1e30), Vec(), Vec(), nullptr};
    for (const Triangle &t : triangles) {
        if (dot(ray.direction, t.n) > 0) continue;  // seen from behind
        Vec p = cross(ray.direction, t.e2), s = ray.origin - t.a, q = cross(s, t.e1);
        double det = dot(t.e1, p);
        if (std::fabs(det) < 1e-12) continue;
        double u = dot(s, p) / det, v = dot(ray.direction, q) / det, far = dot(t.e2, q) / det;
        if (u < 0 || v < 0 || u + v > 1 || far < 1e-3 || far >= hit.t) continue;
        hit.happened = true;
        hit.t = Float(far);
        hit.n = t.n;
        hit.m = t.m;
    }
    if (hit.happened) hit.p = ray.origin + ray.direction * hit.t;
    return hit;
}

static Vec eval(const Material &m, const Vec &wi, const Vec &N) {
    const Float scale = bug("B03") ? 1 : 1 / PI;
    return dot(N, wi) > 0 ? m.kd * scale : Vec();
}

static Vec to_world(const Vec &a, const Vec &N) {
    Vec other = std::fabs(N.x) > Float(.5) ? Vec(0, 1, 0) : Vec(1, 0, 0);
    Vec T = normalize(cross(other, N)), B = cross(N, T);
    return T * a.x + B * a.y + N * a.z;
}

static Vec sample(const Vec &N) {
    Float z = uniform(), phi = 2 * PI * uniform();
    if (bug("B01")) z = std::sqrt(z);  // by the cosine, and pdf() says uniform
    Float r = std::sqrt(std::fmax(Float(0), 1 - z * z));
    Vec local(r * std::cos(phi), r * std::sin(phi), z);
    return bug("B05") ? local : to_world(local, N);
}

static Float pdf(const Vec &wi, const Vec &N) { return dot(wi, N) > 0 ? Float(.5) / PI : 0; }

static Vec castRay(const Ray &ray, int depth) {
    CASTRAY_CALL(ray.origin, ray.direction, depth);
    Hit hit = intersect(ray);
    if (!hit.happened) return CASTRAY_RETURN(Vec());
    Vec p = hit.p, N = hit.n;
    if (level >= 1) CASTRAY_LOG("hit.p", p, "hit.n", N);
    if (bug("W01")) CASTRAY_LOG("hit.wo", ray.direction);
    if (length(hit.m->emission) > 0) {
        bool counts = bug("E01") || (depth == 0 && !bug("E02"));
        return CASTRAY_RETURN(counts ? hit.m->emission : Vec());
    }
    // direct
    Float pick = uniform() * 2, u = std::sqrt(uniform()), v = uniform();
    const Triangle &of = triangles[pick < 1 ? 10 : 11];
    Vec q = of.a + of.e1 * (u * (1 - v)) + of.e2 * (u * v);
    Float pdf_light = 1 / (triangles[10].area + triangles[11].area);
    Vec way = q - p, wi = normalize(way);
    Float r = length(way);
    Ray shadow = {p, wi};
    bool visible = intersect(shadow).t >= r - (bug("D01") ? 0 : Float(1e-2));
    Vec f = eval(bug("D06") ? lamp : *hit.m, wi, N);
    Float cos = std::fmax(Float(0), dot(wi, N)), cos_light = std::fmax(Float(0), dot(-wi, of.n));
    Vec L_dir;
    if (visible) {
        Float cosine = bug("D10") ? 1 : cos, square = bug("D11") ? r : r * r;
        L_dir = lamp.emission * f * cosine * cos_light / square / pdf_light;
    }
    if (level >= 2)
        CASTRAY_LOG("light.q", q, "light.nq", of.n, "light.Le", lamp.emission, "light.f", f, "light.cos", cos,
                    "light.pdf_area", pdf_light, "light.visible", visible);
    if (level >= 1) CASTRAY_LOG("direct", L_dir);
    // indirect
    Vec L_indir;
    bool survived = uniform() < ROULETTE;
    if (level >= 2) CASTRAY_LOG("roulette.probability", ROULETTE, "roulette.survived", survived);
    if (survived) {
        Vec wo = sample(N);
        Float density = pdf(wo, N);
        Vec factor = eval(*hit.m, wo, N);
        Float cosine = std::fmax(Float(0), dot(wo, N));
        if (level >= 2)
            CASTRAY_LOG("bounce.wi", wo, "bounce.f", factor, "bounce.cos", cosine, "bounce.pdf", density);
        Ray next = {p, wo};
        bool goes_on = density > 0;
        if (goes_on && bug("PEEK")) {
            Hit ahead = intersect(next);
            goes_on = ahead.happened && length(ahead.m->emission) == 0;
        }
        if (goes_on) {
            if (bug("R07")) castRay(next, depth + 1);
            Vec inner = castRay(next, bug("E04") ? 0 : depth + 1);
            L_indir = inner * factor * cosine / (bug("B02") ? 1 : density) / (bug("R01") ? 1 : ROULETTE);
        }
    }
    if (level >= 1) CASTRAY_LOG("indirect", L_indir);
    Vec sum = L_dir + L_indir;
    if (bug("F01")) sum = Vec(std::fmin(sum.x, Float(1)), std::fmin(sum.y, Float(1)), std::fmin(sum.z, Float(1)));
    if (bug("crash") && depth == 2) std::abort();
    return CASTRAY_RETURN(sum);
}

int main(int count, char **words) {
    const int size = PICTURE, spp = SAMPLES;
    if (count > 1) planted = words[1];
    if (count > 2) level = std::atoi(words[2]);
    const unsigned seed = count > 3 ? unsigned(std::atoi(words[3])) : 1u;
    const int threads = count > 4 ? std::atoi(words[4]) : 1;
    const Vec eye(278, 273, -800);
    const Float scale = std::tan(Float(20) * PI / 180);
    build();
    std::vector<Vec> picture(std::size_t(size) * std::size_t(size));
    auto rows = [&](int first) {
        engine.seed(seed * 1000u + unsigned(first));
        for (int j = first; j < size; j += threads)
            for (int i = 0; i < size; ++i)
                for (int k = 0; k < spp; ++k) {
                    CASTRAY_PATH(i, j, k);
                    Float x = (2 * (i + Float(.5)) / size - 1) * scale, y = (1 - 2 * (j + Float(.5)) / size) * scale;
                    Ray ray = {eye, normalize(Vec(-x, y, 1))};
                    Vec &pixel = picture[std::size_t(j) * std::size_t(size) + std::size_t(i)];
                    pixel = pixel + castRay(ray, 0) / Float(spp);
                }
    };
    std::vector<std::thread> workers;
    for (int k = 0; k < threads; ++k) workers.emplace_back(rows, k);
    for (auto &worker : workers) worker.join();
    Vec mean;
    for (const Vec &pixel : picture) mean = mean + pixel / Float(size * size);
    std::printf("%g %g %g\n", double(mean.x), double(mean.y), double(mean.z));
    return 0;
}

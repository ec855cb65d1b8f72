// A path tracer with many lamps and MIS: plain structs and free functions, floats, wi and wo both away from the surface.
// One lamp is chosen by its power, a point on it by area; directions by the cosine. The scene is many_lights.
// Logs what it does by castray.h.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#ifndef PICTURE
#define PICTURE 32
#endif
#ifndef SAMPLES
#define SAMPLES 8
#endif
#ifndef SEED
#define SEED 7
#endif
#ifndef MORE
#define MORE ""
#endif
#define AS_TEXT_(x) #x
#define AS_TEXT(x) AS_TEXT_(x)
#define CASTRAY_HEADER                                                                                                 \
    "\"width\": " AS_TEXT(PICTURE) ", \"height\": " AS_TEXT(PICTURE) ", \"spp\": " AS_TEXT(SAMPLES)                    \
    ", \"integrator\": \"path\", \"light_sampling\": \"area\", \"hemisphere\": \"cosine\"" MORE
#include "castray.h"

#if defined LOG_NO_LIGHT || defined LOG_TERMS
#define LOG_LIGHT(...) ((void)0)
#else
#define LOG_LIGHT CASTRAY_LOG
#endif
#if defined LOG_NO_PDF || defined LOG_TERMS
#define LOG_PDF(...) ((void)0)
#else
#define LOG_PDF CASTRAY_LOG
#endif
#if defined LOG_TERMS
#define LOG_BOUNCE(...) ((void)0)
#else
#define LOG_BOUNCE CASTRAY_LOG
#endif

const float Pi = 3.14159265f;

struct Vec { float x, y, z; };
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator-(Vec a) { return {-a.x, -a.y, -a.z}; }
Vec operator*(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
Vec operator/(Vec a, float s) { return a * (1 / s); }
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vec normalize(Vec a) { return a / std::sqrt(dot(a, a)); }
float sqr(float a) { return a * a; }
float luminance(Vec c) { return .2126f * c.x + .7152f * c.y + .0722f * c.z; }

// ---- the hall: a box seen from inside, a pillar, a ball, and the lamps ----

struct Lamp { float x, y, z, size, r, g, b; };  // forty panels under the ceiling, then twenty bulbs on the floor
const int PANELS = 40, LAMPS = 60;
const Lamp lamps[LAMPS] = {
    {-5.25, 3.95, -6, 0.16, 0.563, 0.709, 0.644}, {-3.75, 3.95, -6, 0.194, 6.528, 2.175, 6.266},
    {-2.25, 3.95, -6, 0.201, 0.925, 0.894, 0.864}, {-0.75, 3.95, -6, 0.298, 2.483, 3.6, 3.087},
    {0.75, 3.95, -6, 0.107, 0.169, 0.155, 0.274}, {2.25, 3.95, -6, 0.203, 2.452, 2.325, 3.497},
    {3.75, 3.95, -6, 0.238, 0.435, 0.318, 0.207}, {5.25, 3.95, -6, 0.131, 3.589, 4.552, 2.466},
    {-5.25, 3.95, -3.4, 0.228, 4.246, 7.983, 5.723}, {-3.75, 3.95, -3.4, 0.274, 1.891, 0.84, 1.567},
    {-2.25, 3.95, -3.4, 0.165, 0.797, 1.036, 0.492}, {-0.75, 3.95, -3.4, 0.218, 5.908, 12.709, 8.249},
    {0.75, 3.95, -3.4, 0.188, 0.413, 0.426, 0.441}, {2.25, 3.95, -3.4, 0.143, 6.535, 8.129, 5.138},
    {3.75, 3.95, -3.4, 0.126, 3.254, 2.156, 3.852}, {5.25, 3.95, -3.4, 0.129, 2.622, 2.828, 2.743},
    {-5.25, 3.95, -0.8, 0.277, 0.279, 0.609, 0.44}, {-3.75, 3.95, -0.8, 0.148, 1.183, 1.104, 0.89},
    {-2.25, 3.95, -0.8, 0.164, 0.881, 2.464, 1.693}, {-0.75, 3.95, -0.8, 0.125, 0.294, 0.113, 0.2},
    {0.75, 3.95, -0.8, 0.275, 2.4, 1.868, 1.473}, {2.25, 3.95, -0.8, 0.204, 0.688, 0.907, 0.99},
    {3.75, 3.95, -0.8, 0.101, 10.206, 11.436, 4.955}, {5.25, 3.95, -0.8, 0.263, 1.348, 1.414, 0.645},
    {-5.25, 3.95, 1.8, 0.245, 0.73, 1.743, 2.014}, {-3.75, 3.95, 1.8, 0.169, 0.293, 0.28, 0.354},
    {-2.25, 3.95, 1.8, 0.29, 0.882, 0.642, 0.493}, {-0.75, 3.95, 1.8, 0.279, 1.486, 2.399, 1.607},
    {0.75, 3.95, 1.8, 0.182, 8.067, 6.95, 5.89}, {2.25, 3.95, 1.8, 0.29, 2.286, 0.841, 1.452},
    {3.75, 3.95, 1.8, 0.226, 2.491, 4.526, 4.051}, {5.25, 3.95, 1.8, 0.11, 0.686, 0.373, 0.405},
    {-5.25, 3.95, 4.4, 0.221, 0.22, 0.462, 0.436}, {-3.75, 3.95, 4.4, 0.292, 0.667, 0.752, 0.8},
    {-2.25, 3.95, 4.4, 0.112, 0.407, 0.48, 0.484}, {-0.75, 3.95, 4.4, 0.123, 3.239, 4.598, 4.795},
    {0.75, 3.95, 4.4, 0.283, 2.304, 2.113, 2.243}, {2.25, 3.95, 4.4, 0.15, 0.283, 0.273, 0.267},
    {3.75, 3.95, 4.4, 0.133, 1.375, 2.223, 1.044}, {5.25, 3.95, 4.4, 0.208, 9.643, 3.919, 6.442},
    {-4.81, 0.15, -5.91, 0.1, 0.43, 0.256, 0.415}, {-2.32, 0.15, -5.72, 0.1, 1.681, 0.628, 1.006},
    {-0.23, 0.15, -5.92, 0.1, 11.707, 7.088, 12.331}, {2.28, 0.15, -5.84, 0.1, 6.494, 3.1, 4.964},
    {5.07, 0.15, -6.24, 0.1, 10.684, 10.398, 12.28}, {-5.1, 0.15, -2.87, 0.1, 0.508, 0.518, 0.231},
    {-2.41, 0.15, -3.17, 0.1, 0.992, 1.374, 0.808}, {-0.03, 0.15, -2.91, 0.1, 2.894, 4.421, 3.072},
    {2.7, 0.15, -3.07, 0.1, 0.783, 0.947, 0.63}, {4.9, 0.15, -3.03, 0.1, 0.62, 1.435, 1.224},
    {-5.25, 0.15, 0.16, 0.1, 0.275, 0.276, 0.275}, {-2.26, 0.15, -0.14, 0.1, 0.56, 0.961, 0.799},
    {-0.04, 0.15, 0.23, 0.1, 5.748, 8.147, 3.756}, {2.67, 0.15, 0.2, 0.1, 3.322, 2.408, 1.484},
    {5.15, 0.15, -0.19, 0.1, 10.019, 13.91, 16.971}, {-5.22, 0.15, 2.81, 0.1, 26.824, 23.438, 25.108},
    {-2.24, 0.15, 3.21, 0.1, 0.909, 0.621, 0.806}, {0.16, 0.15, 3.15, 0.1, 2.298, 1.745, 1.612},
    {2.22, 0.15, 3.21, 0.1, 6.78, 5.699, 6.82}, {4.93, 0.15, 3.2, 0.1, 11.053, 6.691, 4.644},};
Vec radiance(int i) { return {lamps[i].r, lamps[i].g, lamps[i].b}; }
Vec middle(int i) { return {lamps[i].x, lamps[i].y, lamps[i].z}; }
float area(int i) { return i < PANELS ? 4 * sqr(lamps[i].size) : 4 * Pi * sqr(lamps[i].size); }

float chance[LAMPS], upto[LAMPS];
void weigh_lamps() {
    float sum = 0;
    for (int i = 0; i < LAMPS; i++) sum += chance[i] = luminance(radiance(i)) * area(i);
    float so_far = 0;
    for (int i = 0; i < LAMPS; i++) {
        chance[i] /= sum;
        upto[i] = so_far += chance[i];
    }
}

const Vec ALBEDO = {.6f, .6f, .6f};
const float NEAR = 1e-3f;

struct Ray { Vec o, d; };
struct Hit {
    float t = 1e9f;
    Vec p, n;
    int lamp = -1;  // which lamp it is, -1 for none
};

void nearer(Hit &hit, float t, Vec n, int lamp) {
    if (t > NEAR && t < hit.t) {
        hit.t = t;
        hit.n = n;
        hit.lamp = lamp;
    }
}

void box(const Ray &ray, Vec low, Vec high, float side, Hit &hit) {  // side -1: the normals point inwards
    const float o[3] = {ray.o.x, ray.o.y, ray.o.z}, d[3] = {ray.d.x, ray.d.y, ray.d.z};
    const float lo[3] = {low.x, low.y, low.z}, hi[3] = {high.x, high.y, high.z};
    float from = -1e9f, to = 1e9f;
    int from_axis = 0, to_axis = 0;
    for (int k = 0; k < 3; k++) {
        if (d[k] == 0) {
            if (o[k] < lo[k] || o[k] > hi[k]) return;
            continue;
        }
        float a = (lo[k] - o[k]) / d[k], b = (hi[k] - o[k]) / d[k];
        if (a > b) std::swap(a, b);
        if (a > from) { from = a; from_axis = k; }
        if (b < to) { to = b; to_axis = k; }
    }
    if (from > to) return;
    float n[3] = {0, 0, 0};
    n[from_axis] = d[from_axis] > 0 ? -side : side;
    nearer(hit, from, {n[0], n[1], n[2]}, -1);
    n[from_axis] = 0;
    n[to_axis] = d[to_axis] > 0 ? side : -side;
    nearer(hit, to, {n[0], n[1], n[2]}, -1);
}

void ball(const Ray &ray, Vec centre, float radius, int lamp, Hit &hit) {
    Vec to = centre - ray.o;
    float along = dot(to, ray.d);
    Vec off = to - ray.d * along;  // from the nearest point of the ray: the small difference of two squares is none
    float rest = radius * radius - dot(off, off);
    if (rest < 0) return;
    rest = std::sqrt(rest);
    for (float t : {along - rest, along + rest}) nearer(hit, t, normalize(ray.o + ray.d * t - centre), lamp);
}

void panel(const Ray &ray, int i, Hit &hit) {
    if (ray.d.y == 0) return;
    float t = (lamps[i].y - ray.o.y) / ray.d.y;
    Vec p = ray.o + ray.d * t;
    if (std::fabs(p.x - lamps[i].x) > lamps[i].size || std::fabs(p.z - lamps[i].z) > lamps[i].size) return;
    nearer(hit, t, {0, -1, 0}, i);
}

bool trace(const Ray &ray, Hit &hit) {
    box(ray, {-6, 0, -8}, {6, 4, 8}, -1, hit);
    box(ray, {-1.9f, 0, -.4f}, {-1.1f, 2.4f, .4f}, 1, hit);
    ball(ray, {1.8f, .8f, 1}, .8f, -1, hit);
    for (int i = 0; i < PANELS; i++) panel(ray, i, hit);
    for (int i = PANELS; i < LAMPS; i++) ball(ray, middle(i), lamps[i].size, i, hit);
    hit.p = ray.o + ray.d * hit.t;
    return hit.t < 1e8f;
}

// ---- sampling ----

std::mt19937 generator(SEED);
float rnd() { return std::uniform_real_distribution<float>(0, 1)(generator); }

struct LightSample {
    int lamp;
    Vec q, n;
    float pick, pdf_area;
};

LightSample sample_light() {
    LightSample s;
    float u = rnd();
    s.lamp = int(std::lower_bound(upto, upto + LAMPS - 1, u) - upto);
    s.pick = chance[s.lamp];
    s.pdf_area = 1 / area(s.lamp);
    const Lamp &l = lamps[s.lamp];
    float a = rnd(), b = rnd();
    if (s.lamp < PANELS) {
        s.n = {0, -1, 0};
        s.q = {l.x + (2 * a - 1) * l.size, l.y, l.z + (2 * b - 1) * l.size};
    } else {
        float height = 1 - 2 * a, ring = std::sqrt(std::max(0.f, 1 - height * height));
        s.n = {ring * std::cos(2 * Pi * b), ring * std::sin(2 * Pi * b), height};
        s.q = middle(s.lamp) + s.n * l.size;
    }
    return s;
}

Vec sample_cosine(Vec n) {
    float r = std::sqrt(rnd()), phi = 2 * Pi * rnd();
    float sign = std::copysign(1.f, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    Vec s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, t = {b, sign + n.y * n.y * a, -n.y};
    return normalize(s * (r * std::cos(phi)) + t * (r * std::sin(phi)) + n * std::sqrt(std::max(0.f, 1 - r * r)));
}

float power_heuristic(float a, float b) { return a * a / (a * a + b * b); }

// What the caller knows: with which density it chose the ray, to weigh a lamp that the ray meets.
Vec shade(const Ray &ray, int depth, float pdf_before) {
    CASTRAY_CALL(ray.o, ray.d, depth);
    Hit hit;
    if (!trace(ray, hit)) return CASTRAY_RETURN((Vec{0, 0, 0}));
    Vec p = hit.p, n = hit.n, wo = -ray.d;
    float cos_wo = dot(n, wo);
    CASTRAY_LOG("hit.p", p, "hit.n", n, "hit.wo", wo);

    Vec emitted = {0, 0, 0};
    if (hit.lamp >= 0 && cos_wo > 0) {
        Vec Le = radiance(hit.lamp);
        float weight = 1;
        if (depth > 0) {
            float pdf_light = chance[hit.lamp] / area(hit.lamp) * sqr(hit.t) / cos_wo;
            weight = power_heuristic(pdf_before, pdf_light);
            LOG_PDF("hit.pdf_bsdf", pdf_before, "hit.pdf_light", pdf_light, "hit.w", weight);
        }
        CASTRAY_LOG("hit.Le", Le);
        emitted = Le * weight;
    }
    CASTRAY_LOG("emission", emitted);
    if (cos_wo <= 0) return CASTRAY_RETURN(emitted);  // backs are black

    Vec f = ALBEDO / Pi, direct = {0, 0, 0};
    LightSample light = sample_light();
    Vec d = light.q - p;
    float r2 = dot(d, d), r = std::sqrt(r2);
    Vec wi = d / r;
    float cos_i = dot(n, wi), cos_l = -dot(light.n, wi);
    LOG_LIGHT("light.q", light.q, "light.nq", light.n, "light.wi", wi, "light.distance", r, "light.f", f);
    LOG_PDF("light.pick", light.pick, "light.pdf_area", light.pdf_area);
    if (cos_i > 0 && cos_l > 0) {
        Hit between;
        bool visible = !trace({p, wi}, between) || between.t > r - 2 * NEAR;
        float pdf = light.pick * light.pdf_area * r2 / cos_l;
        float pdf_bounce = cos_i / Pi;
        float weight = power_heuristic(pdf, pdf_bounce);
        LOG_LIGHT("light.cos", cos_i, "light.cos_light", cos_l, "light.visible", visible);
        LOG_PDF("light.pdf", pdf, "light.pdf_bsdf", pdf_bounce, "light.w", weight);
        if (visible) direct = radiance(light.lamp) * f * (cos_i * weight / pdf);
    }
    CASTRAY_LOG("direct", direct);

    float live = depth < 2 ? 1.f : .6f;
    if (rnd() >= live) {
        CASTRAY_LOG("roulette.probability", live, "roulette.survived", false);
        return CASTRAY_RETURN(emitted + direct);
    }
    if (live < 1) CASTRAY_LOG("roulette.probability", live, "roulette.survived", true);

    Vec next = sample_cosine(n);
    float cos_next = dot(n, next), pdf_next = cos_next / Pi;
    LOG_BOUNCE("bounce.wi", next, "bounce.f", f, "bounce.cos", cos_next);
    LOG_PDF("bounce.pdf", pdf_next);
    if (pdf_next <= 0) return CASTRAY_RETURN(emitted + direct);
    Vec inner = shade({p, next}, depth + 1, pdf_next);
    Vec indirect = inner * f * (cos_next / pdf_next / live);
    CASTRAY_LOG("indirect", indirect);
    return CASTRAY_RETURN(emitted + direct + indirect);
}

int main() {
    weigh_lamps();
    const float half = std::tan(30 * Pi / 180);
    const Vec eye = {0, 1.6f, 7.5f}, front = normalize(Vec{0, 1.2f, 0} - eye);
    const Vec right = normalize(cross(front, {0, 1, 0})), up = cross(right, front);
    Vec sum = {0, 0, 0};
    for (int y = 0; y < PICTURE; y++)
        for (int x = 0; x < PICTURE; x++)
            for (int s = 0; s < SAMPLES; s++) {
                float a = (2 * (x + rnd()) / PICTURE - 1) * half, b = (1 - 2 * (y + rnd()) / PICTURE) * half;
                CASTRAY_PATH(x, y, s);
                sum = sum + shade({eye, normalize(front + right * a + up * b)}, 0, 0);
            }
    sum = sum / float(PICTURE * PICTURE * SAMPLES);
    std::printf("%g %g %g\n", sum.x, sum.y, sum.z);
}

// A path tracer in the manner of the weekend books: vec3 with e[3], hit_record with front_face, scatter() of materials;
// floats, normals turned towards the ray, one light sample, no MIS. The scene is cornell_glass. Logs by castray.h.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

#ifndef PICTURE
#define PICTURE 64
#endif
#ifndef SAMPLES
#define SAMPLES 16
#endif
#ifndef SEED
#define SEED 1
#endif
#ifndef MORE
#define MORE ""
#endif
#define AS_TEXT_(x) #x
#define AS_TEXT(x) AS_TEXT_(x)
#define CASTRAY_HEADER                                                                                                 \
    "\"width\": " AS_TEXT(PICTURE) ", \"height\": " AS_TEXT(PICTURE) ", \"spp\": " AS_TEXT(SAMPLES)                    \
    ", \"integrator\": \"path\", \"strategy\": \"light\", \"hemisphere\": \"cosine\", \"light_sampling\": \"area\""       \
    ", \"n\": \"facing\", \"wo\": \"inward\"" MORE
#include "castray.h"

// What is logged: by default everything; a program that is debugged in haste logs less.
#if defined LOG_TERMS
#define LOG_BOUNCE(...) ((void)0)
#define LOG_LIGHT(...) ((void)0)
#define LOG_PDF(...) ((void)0)
#elif defined LOG_NO_LIGHT
#define LOG_BOUNCE CASTRAY_LOG
#define LOG_LIGHT(...) ((void)0)
#define LOG_PDF CASTRAY_LOG
#elif defined LOG_NO_PDF
#define LOG_BOUNCE CASTRAY_LOG
#define LOG_LIGHT CASTRAY_LOG
#define LOG_PDF(...) ((void)0)
#else
#define LOG_BOUNCE CASTRAY_LOG
#define LOG_LIGHT CASTRAY_LOG
#define LOG_PDF CASTRAY_LOG
#endif

const float pi = 3.14159265358979f;

static uint64_t state = SEED;
float random_float() {
    uint64_t z = (state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    z ^= z >> 31;
    return float(z >> 40) / 16777216.0f;
}

struct vec3 {
    float e[3];
    vec3(float a = 0, float b = 0, float c = 0) : e{a, b, c} {}
    float x() const { return e[0]; }
    float y() const { return e[1]; }
    float z() const { return e[2]; }
    vec3 operator-() const { return vec3(-e[0], -e[1], -e[2]); }
    vec3 &operator+=(const vec3 &v) { e[0] += v.e[0]; e[1] += v.e[1]; e[2] += v.e[2]; return *this; }
};
typedef vec3 color;
vec3 operator+(vec3 a, const vec3 &b) { return a += b; }
vec3 operator-(const vec3 &a, const vec3 &b) { return a + -b; }
vec3 operator*(const vec3 &a, const vec3 &b) { return vec3(a.e[0] * b.e[0], a.e[1] * b.e[1], a.e[2] * b.e[2]); }
vec3 operator*(float s, const vec3 &a) { return vec3(s * a.e[0], s * a.e[1], s * a.e[2]); }
vec3 operator/(const vec3 &a, float s) { return (1 / s) * a; }
float dot(const vec3 &a, const vec3 &b) { return a.e[0] * b.e[0] + a.e[1] * b.e[1] + a.e[2] * b.e[2]; }
vec3 cross(const vec3 &a, const vec3 &b) {
    return vec3(a.e[1] * b.e[2] - a.e[2] * b.e[1], a.e[2] * b.e[0] - a.e[0] * b.e[2], a.e[0] * b.e[1] - a.e[1] * b.e[0]);
}
float length(const vec3 &a) { return std::sqrt(dot(a, a)); }
vec3 unit_vector(const vec3 &a) { return a / length(a); }
vec3 reflect(const vec3 &v, const vec3 &n) { return unit_vector(v - 2 * dot(v, n) * n); }

struct ray {
    vec3 orig, dir;
    vec3 at(float t) const { return orig + t * dir; }
};

struct material;
struct hit_record {
    vec3 p, normal;
    float t;
    bool front_face;
    const material *mat;
    void set_face_normal(const ray &r, const vec3 &outward) {
        front_face = dot(r.dir, outward) < 0;
        normal = front_face ? outward : -outward;
    }
};

struct scatter_record {
    vec3 direction;
    color value;  // f, or at mirrors and glass the share that goes on
    float pdf, cosine;
    bool specular;
};

struct material {
    color emitted;
    virtual color albedo() const { return color(); }
    virtual bool is_specular() const { return false; }
    virtual scatter_record scatter(const ray &in, const hit_record &rec) const = 0;
};

vec3 random_cosine_direction() {
    float r1 = random_float(), r2 = random_float();
    float phi = 2 * pi * r1, radius = std::sqrt(r2);
    return vec3(std::cos(phi) * radius, std::sin(phi) * radius, std::sqrt(1 - r2));
}

vec3 to_world(const vec3 &local, const vec3 &w) {
    vec3 a = std::fabs(w.x()) > 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
    vec3 v = unit_vector(cross(w, a)), u = cross(w, v);
    return unit_vector(local.x() * u + local.y() * v + local.z() * w);
}

struct lambertian : material {
    color kd;
    lambertian(const color &c, const color &light = color()) : kd(c) { emitted = light; }
    color albedo() const override { return kd; }
    scatter_record scatter(const ray &, const hit_record &rec) const override {
        scatter_record s;
        s.direction = to_world(random_cosine_direction(), rec.normal);
        s.cosine = dot(s.direction, rec.normal);
        s.pdf = s.cosine / pi;
        s.value = kd / pi;
        s.specular = false;
        return s;
    }
};

struct metal : material {
    bool is_specular() const override { return true; }
    scatter_record scatter(const ray &in, const hit_record &rec) const override {
        scatter_record s;
        s.direction = reflect(in.dir, rec.normal);
        s.cosine = std::fabs(dot(s.direction, rec.normal));
        s.value = color(1, 1, 1);
        s.pdf = 1;
        s.specular = true;
        return s;
    }
};

struct dielectric : material {
    float ir;
    explicit dielectric(float index) : ir(index) {}
    bool is_specular() const override { return true; }
    // the share that is reflected; ratio is the index of where the ray is by that of where it goes
    static float fresnel(float cos_i, float ratio) {
        float sin2_t = ratio * ratio * (1 - cos_i * cos_i);
        if (sin2_t >= 1) return 1;
        float cos_t = std::sqrt(1 - sin2_t);
        float rs = (ratio * cos_i - cos_t) / (ratio * cos_i + cos_t);
        float rp = (cos_i - ratio * cos_t) / (cos_i + ratio * cos_t);
        return (rs * rs + rp * rp) / 2;
    }
    scatter_record scatter(const ray &in, const hit_record &rec) const override {
        scatter_record s;
        float ratio = rec.front_face ? 1 / ir : ir;
        float cos_i = std::fmin(dot(-in.dir, rec.normal), 1.0f);
        float F = fresnel(cos_i, ratio);
        s.specular = true;
        if (random_float() < F) {
            s.direction = reflect(in.dir, rec.normal);
            s.value = color(F, F, F);
            s.pdf = F;
        } else {
            vec3 across = ratio * (in.dir + cos_i * rec.normal);
            vec3 along = -std::sqrt(std::fabs(1 - dot(across, across))) * rec.normal;
            s.direction = unit_vector(across + along);
            float T = (1 - F) * ratio * ratio;  // radiance
            s.value = color(T, T, T);
            s.pdf = 1 - F;
        }
        s.cosine = std::fabs(dot(s.direction, rec.normal));
        return s;
    }
};

struct hittable {
    const material *mat;
    virtual bool hit(const ray &r, float t_min, float t_max, hit_record &rec) const = 0;
};

struct quad : hittable {
    vec3 Q, u, v, n;
    quad(const vec3 &corner, const vec3 &a, const vec3 &b, const material *m) : Q(corner), u(a), v(b) {
        n = unit_vector(cross(a, b));
        mat = m;
    }
    float area() const { return length(cross(u, v)); }
    bool hit(const ray &r, float t_min, float t_max, hit_record &rec) const override {
        float down = dot(n, r.dir);
        if (std::fabs(down) < 1e-8f) return false;
        float t = dot(n, Q - r.orig) / down;
        if (t < t_min || t > t_max) return false;
        vec3 in = r.at(t) - Q;
        float a = dot(in, u) / dot(u, u), b = dot(in, v) / dot(v, v);
        if (a < 0 || a > 1 || b < 0 || b > 1) return false;
        rec.t = t;
        rec.p = r.at(t);
        rec.mat = mat;
        rec.set_face_normal(r, n);
        return true;
    }
};

struct sphere : hittable {
    vec3 center;
    float radius;
    sphere(const vec3 &c, float r, const material *m) : center(c), radius(r) { mat = m; }
    bool hit(const ray &r, float t_min, float t_max, hit_record &rec) const override {
        vec3 oc = r.orig - center;
        float half_b = dot(oc, r.dir), c = dot(oc, oc) - radius * radius;
        float discriminant = half_b * half_b - c;
        if (discriminant < 0) return false;
        float root = std::sqrt(discriminant), t = -half_b - root;
        if (t < t_min || t > t_max) t = -half_b + root;
        if (t < t_min || t > t_max) return false;
        rec.t = t;
        rec.p = r.at(t);
        rec.mat = mat;
        rec.set_face_normal(r, unit_vector(rec.p - center));
        return true;
    }
};

const float t_min = 1e-4f, shadow_bias = 1e-4f;

struct hittable_list {
    std::vector<std::unique_ptr<hittable>> objects;
    const quad *lamp;
    bool hit(const ray &r, float t_min, float t_max, hit_record &rec) const {
        bool any = false;
        for (auto &object : objects)
            if (object->hit(r, t_min, t_max, rec)) {
                any = true;
                t_max = rec.t;
            }
        return any;
    }
} world;

void build() {
    auto *white = new lambertian(color(0.885809f, 0.698859f, 0.666422f));
    auto *green = new lambertian(color(0.105421f, 0.37798f, 0.076425f));
    auto *red = new lambertian(color(0.570068f, 0.0430135f, 0.0443706f));
    auto *light = new lambertian(white->kd, color(18.387f, 13.9873f, 6.75357f));
    auto add = [](hittable *h) { world.objects.emplace_back(h); };
    world.lamp = new quad(vec3(-.23f, .99f, -.18f), vec3(.46f, 0, 0), vec3(0, 0, .38f), light);
    add(const_cast<quad *>(world.lamp));
    add(new quad(vec3(-1, -1, 1), vec3(2, 0, 0), vec3(0, 0, -2), white));
    add(new quad(vec3(-1, 1, -1), vec3(2, 0, 0), vec3(0, 0, 2), white));
    add(new quad(vec3(-1, -1, -1), vec3(2, 0, 0), vec3(0, 2, 0), white));
    add(new quad(vec3(1, -1, -1), vec3(0, 0, 2), vec3(0, 2, 0), green));
    add(new quad(vec3(-1, -1, 1), vec3(0, 0, -2), vec3(0, 2, 0), red));
    add(new sphere(vec3(.43f, -.62f, .3f), .38f, new dielectric(1.5f)));
    add(new sphere(vec3(-.42f, -.58f, -.35f), .42f, new metal()));
}

color ray_color(const ray &r, int depth, bool see_lamp) {
    CASTRAY_CALL(r.orig, r.dir, depth);
    hit_record rec;
    if (depth > 60 || !world.hit(r, t_min, 1e9f, rec)) return CASTRAY_RETURN(color());
    CASTRAY_LOG("hit.p", rec.p, "hit.n", rec.normal, "hit.wo", r.dir, "hit.front", rec.front_face);

    color emission;
    if (see_lamp && rec.front_face) emission = rec.mat->emitted;
    CASTRAY_LOG("emission", emission);
    if (!rec.mat->is_specular() && !rec.front_face) return CASTRAY_RETURN(emission);

    color direct;
    if (!rec.mat->is_specular()) {
        const quad &lamp = *world.lamp;
        float a = random_float(), b = random_float();
        vec3 q = lamp.Q + a * lamp.u + b * lamp.v;
        vec3 to_light = q - rec.p;
        float distance = length(to_light);
        vec3 wi = to_light / distance;
        float cosine = std::fmax(0.0f, dot(rec.normal, wi));
        float cos_light = std::fmax(0.0f, dot(lamp.n, -wi));
        float pdf_area = 1 / lamp.area();
        color f = rec.mat->albedo() / pi;
        LOG_LIGHT("light.q", q, "light.nq", lamp.n, "light.wi", wi, "light.Le", lamp.mat->emitted);
        LOG_LIGHT("light.f", f, "light.cos", cosine, "light.cos_light", cos_light);
        if (cosine > 0 && cos_light > 0) {
            hit_record blocker;
            bool visible = !world.hit(ray{rec.p, wi}, shadow_bias, distance - shadow_bias, blocker);
            LOG_LIGHT("light.visible", visible);
            if (visible)
                direct = cosine * cos_light / (distance * distance) / pdf_area * (lamp.mat->emitted * f);
        }
        LOG_PDF("light.pdf_area", pdf_area);
        CASTRAY_LOG("direct", direct);
    }

    float survive = 1;
    if (depth >= 3) {
        survive = 0.8f;
        bool alive = random_float() < survive;
        CASTRAY_LOG("roulette.probability", survive, "roulette.survived", alive);
        if (!alive) return CASTRAY_RETURN(emission + direct);
    }

    scatter_record s = rec.mat->scatter(r, rec);
    LOG_BOUNCE("bounce.wi", s.direction, "bounce.f", s.value, "bounce.cos", s.cosine, "bounce.delta", s.specular);
    LOG_PDF("bounce.pdf", s.pdf);
    ray next = {rec.p, s.direction};
    color incoming = ray_color(next, depth + 1, s.specular);
    float factor = (s.specular ? 1 : s.cosine) / s.pdf / survive;
    color indirect = factor * (s.value * incoming);
    CASTRAY_LOG("indirect", indirect);
    return CASTRAY_RETURN(emission + direct + indirect);
}

int main() {
    build();
    float half = std::tan(39.3077f / 2 * pi / 180);
    color mean;
    for (int y = 0; y < PICTURE; y++)
        for (int x = 0; x < PICTURE; x++)
            for (int i = 0; i < SAMPLES; i++) {
                float u = (x + random_float()) / PICTURE, v = (y + random_float()) / PICTURE;
                vec3 d((2 * u - 1) * half, (1 - 2 * v) * half, -1);
                CASTRAY_PATH(x, y, i);
                mean += ray_color(ray{vec3(0, 0, 3.9f), unit_vector(d)}, 0, true) / float(PICTURE * PICTURE * SAMPLES);
            }
    std::printf("%g %g %g\n", mean.x(), mean.y(), mean.z());
}

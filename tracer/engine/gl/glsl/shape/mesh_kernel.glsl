// Watertight test of triangles (Woop, Benthin and Wald 2013): the twin of tracer/shape/mesh_kernel.py.
//
// The edge functions of two triangles that share an edge must be the same numbers with opposite signs. They
// are `precise`: contracted into one rounding, a product and a difference would not be.

struct Triangle {
    vec4 a;      // a corner; x of the normal
    vec4 b;      // y of the normal
    vec4 c;      // z of the normal
    vec4 plane;  // 1 or -1, by which way the corners go round; margin within which rounding may decide; reach; number
};

#define GRAZING 1e-3

vec3 turned(vec3 v, int k) { return k == 0 ? v.yzx : k == 1 ? v.zxy : v; }  // axis k last

int longest_axis(vec3 d)
{
    vec3 a = abs(d);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

// A corner across the sheared ray.
vec2 sheared(vec3 corner, vec3 o, vec2 shear)
{
    precise float z = corner.z - o.z;
    precise vec2 at = (corner.xy - o.xy) - shear * z;
    return at;
}

float edge(vec2 p, vec2 q)
{
    precise float value = p.x * q.y - p.y * q.x;
    if (value == 0.0) {  // in float64 products are exact
        precise double exact = double(p.x) * double(q.y) - double(p.y) * double(q.x);
        value = exact > 0.0 ? TINY : exact < 0.0 ? -TINY : 0.0;
    }
    return value;
}

void meet_triangle(Ray r, inout Near near, int primitive, Triangle t)
{
    int k = longest_axis(r.d);
    vec3 o = turned(r.o, k), d = turned(r.d, k);
    vec2 shear = d.xy / d.z;
    vec2 a = sheared(turned(t.a.xyz, k), o, shear);
    vec2 b = sheared(turned(t.b.xyz, k), o, shear);
    vec2 c = sheared(turned(t.c.xyz, k), o, shear);
    float u = edge(c, b), v = edge(a, c), w = edge(b, a);
    bool inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    float sum = u + v + w;
    if (!inside || sum == 0.0 || primitive == r.source || primitive == r.target)
        return;
    float outwards = -t.plane.x * sum * d.z;  // above 0 where the ray goes out through the front
    vec3 n = vec3(t.a.w, t.b.w, t.c.w), away = r.o - t.a.xyz;
    float height = dot(n, away), cos = dot(n, r.d);
    cos = cos == 0.0 ? TINY : cos;
    float distance = -height / cos;
    if (abs(cos) < GRAZING) {
        vec3 depth = vec3(dot(t.a.xyz - r.o, r.d), dot(t.b.xyz - r.o, r.d), dot(t.c.xyz - r.o, r.d));
        float least = min(min(depth.x, depth.y), depth.z), most = max(max(depth.x, depth.y), depth.z);
        distance = clamp(distance, least, most);
    }
    if (abs(height) <= t.plane.y && r.source >= 0) {
        if (!met_from_close_by(r, primitive, height, outwards, error_bound(r.o, n, t.plane.z), distance))
            return;
    } else if (!(distance > 0.0))
        return;
    if (distance < near.t)
        near = Near(distance, primitive);
}

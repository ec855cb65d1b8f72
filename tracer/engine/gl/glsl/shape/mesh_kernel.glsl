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

Triangle triangles_at(int k);  // in the order of the leaves; number -1 in empty places

#define GRAZING 1e-3

// A ray on its way through a mesh.
struct Sheared {
    int axis;     // that it points along most, which comes last in what follows
    vec3 o;
    vec2 shear;   // onto that axis
    float along;  // the component of its direction there
    float side;   // of the triangles, on which it is taken to be: that to which it leaves its own, in front elsewhere
};

struct Crossing {
    float t;
    float place;  // in the order in which triangles are met
    float limit;  // what lies beyond is not met first
    int primitive;
};

vec3 turned(vec3 v, int k) { return k == 0 ? v.yzx : k == 1 ? v.zxy : v; }  // axis k last

int longest_axis(vec3 d)
{
    vec3 a = abs(d);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

Sheared sheared_onto_axis(Ray r, int first, int count)
{
    int k = longest_axis(r.d);
    vec3 d = turned(r.d, k);
    bool own = r.source >= first && r.source < first + count;
    return Sheared(k, turned(r.o, k), d.xy / d.z, d.z, own && !r.outside ? -1.0 : 1.0);
}

// A corner across the sheared ray.
vec2 across_ray(vec3 corner, Sheared s)
{
    precise float z = corner.z - s.o.z;
    precise vec2 at = (corner.xy - s.o.xy) - s.shear * z;
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

// Of triangles that are met within rounding of each other the one that faces the ray's side is first, and of those at
// the same distance the one of the lowest number, whatever the order of the walk.
void meet_triangle(Ray r, Sheared s, inout Crossing best, int primitive, Triangle t)
{
    vec2 a = across_ray(turned(t.a.xyz, s.axis), s);
    vec2 b = across_ray(turned(t.b.xyz, s.axis), s);
    vec2 c = across_ray(turned(t.c.xyz, s.axis), s);
    float u = edge(c, b), v = edge(a, c), w = edge(b, a);
    bool inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
    float sum = u + v + w;
    if (!inside || sum == 0.0 || primitive == r.source || primitive == r.target)
        return;
    float outwards = -t.plane.x * sum * s.along;  // above 0 where the ray goes out through the front
    vec3 n = vec3(t.a.w, t.b.w, t.c.w), away = r.o - t.a.xyz;
    float height = dot(n, away), cos = dot(n, r.d);
    cos = cos == 0.0 ? TINY : cos;
    float distance = -height / cos, steep = abs(cos);
    float blur = 4.0 * EPS * (abs(distance) + max(max(abs(away.x), abs(away.y)), abs(away.z))) / steep;
    if (steep < GRAZING) {
        vec3 depth = vec3(dot(t.a.xyz - r.o, r.d), dot(t.b.xyz - r.o, r.d), dot(t.c.xyz - r.o, r.d));
        float least = min(min(depth.x, depth.y), depth.z), most = max(max(depth.x, depth.y), depth.z);
        distance = clamp(distance, least, most);
        blur = min(blur, most - least);
    } else if (distance > 0.0 && abs(height) > t.plane.y)
        best.limit = min(best.limit, (1.001 * abs(height) + t.plane.y) / steep);
    if (abs(height) <= t.plane.y && r.source >= 0) {
        if (!met_from_close_by(r, primitive, height, outwards, error_bound(r.o, n, t.plane.z), distance))
            return;
    } else if (!(distance > 0.0))
        return;
    float place = distance + (outwards * s.side < 0.0 ? -blur : blur);
    if (place < best.place || (place == best.place && primitive < best.primitive)) {
        best.t = distance;
        best.place = place;
        best.primitive = primitive;
    }
}

// The nearest triangle of a mesh, if it is nearer than what was met before.
void take(Crossing best, inout Near near)
{
    if (best.primitive >= 0 && best.t < near.t)
        near = Near(best.t, best.primitive);
}

#if IN_TREE
void meet_leaf(Ray r, Sheared s, inout Crossing best, Mesh mesh, int leaf)
{
    int begin = mesh.number.w + leaf * mesh.more.z;
    for (int k = begin; k < begin + mesh.more.z; ++k) {
        Triangle t = triangles_at(k);
        if (t.plane.w >= 0.0)
            meet_triangle(r, s, best, int(t.plane.w), t);
    }
}

// one_will_do: whether a triangle before near.t is enough, whichever it is.
void meet_mesh(Ray r, inout Near near, Mesh mesh, bool one_will_do)
{
    vec3 over_d = inverse(r.d);
    if (!enters(mesh.low.xyz, mesh.high.xyz, r.o, over_d, near.t))
        return;
    Sheared s = sheared_onto_axis(r, mesh.number.x, mesh.number.y);
    Crossing best = Crossing(INFINITE, INFINITE, near.t, -1);
#if DEEPEST
    uint waiting[DEEPEST];  // children of the nodes on the way that have not been visited
    int step = 0, node = 0;
    while (true) {
        if (step < mesh.more.x) {
            int row = row_of(mesh, step, node), width = step == 0 ? mesh.more.y : 8;
            waiting[step] = children(row, width, r.o, over_d, best.limit);
        } else {
            meet_leaf(r, s, best, mesh, node);
            if (one_will_do && best.t < near.t)
                break;
            --step;
            node >>= 3;
        }
        while (step >= 0 && waiting[step] == 0u) {
            --step;
            node >>= 3;
        }
        if (step < 0)
            break;
        node = 8 * node + int(waiting[step] & 7u);
        waiting[step] >>= 4;
        ++step;
    }
#else
    meet_leaf(r, s, best, mesh, 0);
#endif
    take(best, near);
}
#endif

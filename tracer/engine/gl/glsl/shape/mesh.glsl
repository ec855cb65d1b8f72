// Points on triangles, and normals between their corners: the twin of tracer/shape/mesh.py.

// Coordinates of the second and third corner.
vec2 barycentric(Triangle t, vec3 p)
{
    vec3 e1 = t.b.xyz - t.a.xyz, e2 = t.c.xyz - t.a.xyz, q = p - t.a.xyz;
    float d11 = dot(e1, e1), d12 = dot(e1, e2), d22 = dot(e2, e2), q1 = dot(q, e1), q2 = dot(q, e2);
    return vec2(d22 * q1 - d12 * q2, d11 * q2 - d12 * q1) / (d11 * d22 - d12 * d12);
}

vec3 on_side(vec3 q, vec3 a, vec3 b)
{
    vec3 side = b - a;
    float size = dot(side, side);
    return a + clamp(dot(q - a, side) / (size > 0.0 ? size : 1.0), 0.0, 1.0) * side;
}

vec3 nearer(vec3 q, vec3 one, vec3 other) { return dot(q - other, q - other) < dot(q - one, q - one) ? other : one; }

// A point near a triangle, moved to the nearest edge where rounding left it outside.
vec3 put_inside(Triangle t, vec3 p)
{
    vec2 at = barycentric(t, p);
    if (at.x >= 0.0 && at.y >= 0.0 && at.x + at.y <= 1.0)
        return p;
    vec3 best = nearer(p, on_side(p, t.a.xyz, t.b.xyz), on_side(p, t.b.xyz, t.c.xyz));
    return nearer(p, best, on_side(p, t.c.xyz, t.a.xyz));
}

#if ANY_SMOOTH
struct Smooth { vec4 a; vec4 b; vec4 c; };  // normals at the corners; 0 for meshes that have none

Smooth smooths_at(int k);

// Interpolated; ng where there are none, or they would turn the side seen.
vec3 shading_normal(Smooth s, vec2 at, vec3 ng, vec3 seen)
{
    vec3 n = (1.0 - at.x - at.y) * s.a.xyz + at.x * s.b.xyz + at.y * s.c.xyz;
    n = n / length(n);
    return dot(n, seen) * dot(ng, seen) > 0.0 ? n : ng;
}
#endif

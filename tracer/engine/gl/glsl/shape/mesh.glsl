// Normals between the vertices of a mesh: the twin of shading_normals in tracer/shape/mesh.py.

struct Smooth { vec4 a; vec4 b; vec4 c; vec4 na; vec4 nb; vec4 nc; };  // corners and the normals there

// Interpolated; ng where it would turn the side seen.
vec3 shading_normal(Smooth s, vec3 p, vec3 ng, vec3 seen)
{
    vec3 e1 = s.b.xyz - s.a.xyz, e2 = s.c.xyz - s.a.xyz, q = p - s.a.xyz;
    float d11 = dot(e1, e1), d12 = dot(e1, e2), d22 = dot(e2, e2), q1 = dot(q, e1), q2 = dot(q, e2);
    float det = d11 * d22 - d12 * d12;
    float v = (d22 * q1 - d12 * q2) / det, w = (d11 * q2 - d12 * q1) / det;
    vec3 n = (1.0 - v - w) * s.na.xyz + v * s.nb.xyz + w * s.nc.xyz;
    n = n / length(n);
    return dot(n, seen) * dot(ng, seen) > 0.0 ? n : ng;
}

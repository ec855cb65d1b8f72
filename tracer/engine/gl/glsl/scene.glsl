// Shapes, materials and lights as one thing that rays can be asked of: the twin of tracer/scene.py.

struct Surface {
    ivec4 number;  // QUAD, TRIANGLE or SPHERE; material; face of a lamp, -1 for none; row of a triangle
    vec4 plane;    // n and c of n . x = c; of a sphere its centre and radius
    vec4 more;     // reach; of a sphere its side; media in front and behind
    vec4 u;        // along which u runs; of a sphere two axes
    vec4 v;
};

Surface surfaces_at(int k);

struct Hit {
    vec3 p;
    int primitive;
    vec3 ng;
    vec3 n;       // shading normal
    vec3 wo;
    int face;     // of those that shine, -1 for none
    float bound;
    Material material;
};

float reach_of(int primitive) { return surfaces_at(primitive).more.x; }

Near intersect(Ray r)
{
    Near near = Near(INFINITE, -1);
    meet_all(r, near);
    return near;
}

Hit surface_hit(Ray r, Near near)
{
    Surface s = surfaces_at(near.primitive);
    vec3 p = r.o + near.t * r.d, n = s.plane.xyz;
    if (s.number.x == SPHERE) {
        vec3 out_ = p - s.plane.xyz;
        out_ = out_ / length(out_);
        p = s.plane.xyz + s.plane.w * out_;
        n = s.more.y * out_;
    } else
        p = p - (dot(n, p) - s.plane.w) * n;
    vec3 shading = n;
#if ANY_TRIANGLE
    if (s.number.x == TRIANGLE) {
        Triangle t = triangles_at(s.number.w);
        p = put_inside(t, p);
#if ANY_SMOOTH
        shading = shading_normal(smooths_at(s.number.w), barycentric(t, p), n, -r.d);
#endif
    }
#endif
    return Hit(
        p, near.primitive, n, shading, -r.d, s.number.z, error_bound(p, n, s.more.x), materials_at(s.number.y));
}

// Whether wi is on the same side of the surface by its shading and by its true normal (Veach 1997, 5.3).
bool sides_agree(Hit hit, vec3 wi) { return dot(hit.n, wi) * dot(hit.ng, wi) > 0.0; }

Ray spawn(Hit hit, vec3 wi)
{
    bool outside = surfaces_at(hit.primitive).number.x == SPHERE || sign_bit(dot(hit.ng, wi)) > 0.0;
    return Ray(leave(hit.p, hit.ng, hit.bound, wi), wi, hit.primitive, -1, hit.bound, outside);
}

// The surface's u runs along s where the material can tell, and any frame will do where not.
Frame surface_frame(Hit hit)
{
#if ANY_ANISOTROPIC
    if (is(hit.material, ANISOTROPIC)) {
        Surface s = surfaces_at(hit.primitive);
        if (s.number.x != SPHERE)
            return along(hit.n, s.u.xyz);
        vec3 away = hit.p - s.plane.xyz;
        vec2 at = vec2(dot(s.u.xyz, away), dot(s.v.xyz, away));
        float size = length(at);
        at = at / (size > 0.0 ? size : 1.0);
        return along(hit.n, s.v.xyz * at.x - s.u.xyz * at.y);
    }
#endif
    return around(hit.n);
}

bool occluded(Hit hit, LightSample light)
{
    Ray r = spawn(hit, light.wi);
    float reach = light.primitive < 0 ? 0.0 : reach_of(light.primitive);
    vec3 goal = leave(light.q, light.nq, error_bound(light.q, light.nq, reach), -light.wi);
    vec3 gap = goal - r.o;
    Near near = Near(length(gap), -1);
    r.d = gap / near.t;
    r.target = light.primitive;
    return blocked(r, near);
}

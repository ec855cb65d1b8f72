// A flat parallelogram, or a face of a cube: the twin of tracer/shape/rectangle.py.

struct Quad {
    ivec4 number;  // its primitive; whether it may hide a lamp
    vec4 plane;    // n and c of n . x = c
    vec4 first;    // a coordinate along it, and that of the middle
    vec4 second;
    vec4 limits;   // of both coordinates; margin within which rounding may decide; reach
    vec4 more;     // by what a lamp in a wall's plane is met before it
};

Quad quads_at(int k);

// Whether a ray passes through a quad, forwards or backwards; t where, height above its plane, heading out of it.
bool crosses(Ray r, Quad quad, out float t, out float height, out float heading)
{
    height = dot(quad.plane.xyz, r.o) - quad.plane.w;
    heading = dot(quad.plane.xyz, r.d);
    t = -height / heading;
    float x = dot(quad.first.xyz, r.o) + t * dot(quad.first.xyz, r.d) - quad.first.w;
    float y = dot(quad.second.xyz, r.o) + t * dot(quad.second.xyz, r.d) - quad.second.w;
    return abs(x) <= quad.limits.x && abs(y) <= quad.limits.y && heading != 0.0 && quad.number.x != r.source
        && quad.number.x != r.target;
}

bool starts_close_by(Ray r, Quad quad, float height) { return abs(height) <= quad.limits.z && r.source >= 0; }

// hair: by what a lamp in a wall's plane is met before it.
void take(Quad quad, float t, float heading, float hair, inout Near near)
{
    t = max(t + hair / heading, 0.0);
    if (t < near.t)
        near = Near(t, quad.number.x);
}

void meet_quad(Ray r, inout Near near, Quad quad, float hair)
{
    float t, height, heading;
    if (!crosses(r, quad, t, height, heading))
        return;
    bool met = t > 0.0;
    if (starts_close_by(r, quad, height)) {
        float bound = error_bound(r.o, quad.plane.xyz, quad.limits.w);
        met = met_from_close_by(r, quad.number.x, height, heading, bound, t);
    }
    if (met)
        take(quad, t, heading, hair, near);
}

#if !RELATIONS
// The same, but from close by it only says so: what it takes to decide that is long, and should stand in few places.
void meet_far_quad(Ray r, inout Near near, inout bool close_by, Quad quad, float hair)
{
    float t, height, heading;
    if (!crosses(r, quad, t, height, heading))
        return;
    if (starts_close_by(r, quad, height))
        close_by = true;
    else if (t > 0.0)
        take(quad, t, heading, hair, near);
}
#endif

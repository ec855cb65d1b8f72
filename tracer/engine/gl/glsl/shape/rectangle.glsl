// A flat parallelogram, or a face of a cube: the twin of tracer/shape/rectangle.py.

struct Quad {
    vec4 plane;   // n and c of n . x = c
    vec4 first;   // a coordinate along it, and that of the middle
    vec4 second;
    vec4 limits;  // of both coordinates; margin within which rounding may decide; reach
};

// hair: by what a lamp in a wall's plane is met before it.
void meet_quad(Ray r, inout Near near, int primitive, Quad quad, float hair)
{
    float height = dot(quad.plane.xyz, r.o) - quad.plane.w, heading = dot(quad.plane.xyz, r.d);
    float t = -height / heading;
    float x = dot(quad.first.xyz, r.o) + t * dot(quad.first.xyz, r.d) - quad.first.w;
    float y = dot(quad.second.xyz, r.o) + t * dot(quad.second.xyz, r.d) - quad.second.w;
    if (!(abs(x) <= quad.limits.x && abs(y) <= quad.limits.y) || heading == 0.0)
        return;
    if (primitive == r.source || primitive == r.target)
        return;
    if (abs(height) <= quad.limits.z && r.source >= 0) {
        float bound = error_bound(r.o, quad.plane.xyz, quad.limits.w);
        if (!met_from_close_by(r, primitive, height, heading, bound, t))
            return;
    } else if (!(t > 0.0))
        return;
    t = max(t + hair / heading, 0.0);
    if (t < near.t)
        near = Near(t, primitive);
}

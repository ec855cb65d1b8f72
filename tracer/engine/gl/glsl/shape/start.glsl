// Starts within rounding of another face than their own, from tracer/shape/start.py: the definition says on which
// side of that face they are. Starts are not moved off the faces they touch: one that is touched is met at a distance
// of 0.

#if RELATIONS
int relations_at(int k);  // made of that module's `relation` for all pairs

int relation(int own, int other, bool outside)
{
    int sides = relations_at(own * PRIMITIVES + other);
    return ((outside ? sides : sides >> 2) & 3) - 1;
}
#else
struct Definition {  // of a primitive, as Faces has it
    dvec4 plane;
    dvec4 x;  // of the four corners
    dvec4 y;
    dvec4 z;
};

#define SAME 32.0
#define PARALLEL 8.0
#define EPS_64 2.220446049250313e-16lf

dvec4 exact(int word)
{
    uvec4 one = words(word), other = words(word + 1);
    return dvec4(packDouble2x32(one.xy), packDouble2x32(one.zw), packDouble2x32(other.xy), packDouble2x32(other.zw));
}

Definition definitions_at(int k);
float reach_of(int primitive);

bool any_above(dvec4 height, dvec4 size) { return any(greaterThan(height, size)); }

// Whether `body` reaches in front of the plane of another primitive, and behind it.
bvec2 sides(Definition plane, float reach, Definition body)
{
    dvec3 n = plane.plane.xyz, m = body.plane.xyz;
    dvec4 height = n.x * body.x + n.y * body.y + n.z * body.z - plane.plane.w;
    dvec4 size = abs(n.x * body.x) + abs(n.y * body.y) + abs(n.z * body.z) + double(reach);
    double eps = double(EPS) * SAME;
    bvec2 found = bvec2(any_above(height, eps * size), any_above(-height, eps * size));
    dvec3 tilt = abs(cross(n, m));
    if (found.x || found.y || max(max(tilt.x, tilt.y), tilt.z) <= double(EPS) * PARALLEL)
        return found;
    eps = EPS_64 * SAME;
    return bvec2(any_above(height, eps * size), any_above(-height, eps * size));
}

// On which side of the plane of `other` a ray starts that leaves `own`: 1, -1, or 0 where it can never meet it.
int relation(int own, int other, bool outside)
{
    Definition mine = definitions_at(own), theirs = definitions_at(other);
    bool even = mine.plane.xyz != dvec3(0.0);
    bvec2 reaches = sides(mine, reach_of(own), theirs), lies = sides(theirs, reach_of(other), mine);
    if (even && !(outside ? reaches.x : reaches.y))
        return 0;
    return lies.x ? 1 : lies.y ? -1 : 0;
}
#endif

// Whether a plane is met by a ray that starts within rounding of it; t is put right.
bool met_from_close_by(Ray r, int primitive, float height, float heading, float bound, inout float t)
{
    if (abs(height) > 1.5 * (r.bound + bound))
        return t > 0.0;
    t = max(t, 0.0);
    return float(relation(r.source, primitive, r.outside)) * heading < 0.0;
}

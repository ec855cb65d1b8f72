// Starts within rounding of another face than their own, from tracer/shape/start.py: the definition says on which
// side of that face they are. The table is made of that module's `relation`. Starts are not moved off
// the faces they touch: faces are asked one by one here, and one that is touched is met at a distance of 0.

// Whether a plane is met by a ray that starts within rounding of it; t is put right.
bool met_from_close_by(Ray r, int primitive, float height, float heading, float bound, inout float t)
{
    if (abs(height) > 1.5 * (r.bound + bound))
        return t > 0.0;
    int sides = relations[r.source * PRIMITIVES + primitive];
    int side = ((r.outside ? sides : sides >> 2) & 3) - 1;
    t = max(t, 0.0);
    return float(side) * heading < 0.0;
}

// Whether a ray passes a box before the nearest hit so far, or misses it by less than rounding (Ize 2013): the twin
// of _enters in tracer/shape/bvh.py.

bool passes(Ray r, Near near, vec3 low, vec3 high)
{
    vec3 tiny = vec3(sign_bit(r.d.x), sign_bit(r.d.y), sign_bit(r.d.z)) * 1e-19;
    vec3 inverse = 1.0 / mix(r.d, tiny, lessThan(abs(r.d), vec3(1e-19)));
    vec3 one = (low - r.o) * inverse, other = (high - r.o) * inverse;
    vec3 enter = min(one, other), leave = max(one, other);
    float first = max(max(enter.x, enter.y), enter.z);
    float last = min(min(near.t, leave.x), min(leave.y, leave.z));
    last = last + 8.0 * EPS * abs(last);
    return first - 8.0 * EPS * abs(first) <= last && last >= 0.0;
}

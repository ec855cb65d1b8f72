// All lights as one, chosen by power: the twin of tracer/light/table.py.

float cdf_at(int k);

int chosen(float u)
{
    int low = 0, high = ENTRIES - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (cdf_at(middle) <= u)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

#if ELSEWHERE
LightSample elsewhere_sample(Elsewhere light, vec3 p, vec2 u)
{
    int kind = light.number.x;
    return kind == POINT ? point_sample(light, p)
        : kind == DIRECTIONAL ? directional_sample(light, p) : constant_sample(light, p, u);
}
#endif

LightSample sample_light(vec3 p, vec3 u)
{
    int entry = chosen(u.x);
#if !FACES
    return elsewhere_sample(elsewhere_at(entry), p, u.yz);
#else
#if ELSEWHERE
    if (entry >= FACES)
        return elsewhere_sample(elsewhere_at(entry - FACES), p, u.yz);
#endif
    return area_sample(faces_at(entry), p, u.yz);
#endif
}

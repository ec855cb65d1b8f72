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

LightSample sample_light(vec3 p, vec3 u)
{
    int entry = chosen(u.x);
#if ELSEWHERE
    if (entry >= FACES) {
        Elsewhere light = elsewhere_at(entry - FACES);
        int kind = light.number.x;
        return kind == POINT ? point_sample(light, p)
            : kind == DIRECTIONAL ? directional_sample(light, p) : constant_sample(light, p, u.yz);
    }
#endif
    return area_sample(faces_at(entry), p, u.yz);
}

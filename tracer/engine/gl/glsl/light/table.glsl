// All lights as one, chosen by power: the twin of tracer/light/table.py.

int chosen(float u)
{
    int entry = 0;
    while (entry < ENTRIES - 1 && cdf[entry] <= u)
        ++entry;
    return entry;
}

LightSample sample_light(vec3 p, vec3 u)
{
    int entry = chosen(u.x);
#if ELSEWHERE
    if (entry >= FACES) {
        Elsewhere light = elsewhere[entry - FACES];
        int kind = light.number.x;
        return kind == POINT ? point_sample(light, p)
            : kind == DIRECTIONAL ? directional_sample(light, p) : constant_sample(light, p, u.yz);
    }
#endif
    return area_sample(faces[entry], p, u.yz);
}

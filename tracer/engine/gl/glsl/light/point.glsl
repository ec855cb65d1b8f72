// A lamp without size: the twin of tracer/light/point.py.

LightSample point_sample(Elsewhere light, vec3 p)
{
    vec3 to_light = light.where.xyz - p;
    float square = dot(to_light, to_light);
    vec3 wi = to_light / sqrt(square), brought = square > 0.0 ? light.colour.rgb / square : vec3(0.0);
    return LightSample(-1, light.where.xyz, -wi, wi, brought, light.colour.w, true);
}

// A lamp so far away that its light falls in from one direction: the twin of tracer/light/directional.py.

LightSample directional_sample(Elsewhere light, vec3 p)
{
    vec3 wi = -light.where.xyz;
    return LightSample(-1, p + wi * far_side(p), -wi, wi, light.colour.rgb, light.colour.w, true);
}

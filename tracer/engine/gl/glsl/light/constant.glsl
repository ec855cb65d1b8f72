// A sky that shines alike from everywhere: the twin of tracer/light/constant.py.

LightSample constant_sample(Elsewhere light, vec3 p, vec2 u)
{
    vec3 wi = uniform_sphere(u);
    float pdf = uniform_sphere_pdf() * light.colour.w;
    return LightSample(-1, p + wi * far_side(p), -wi, wi, light.colour.rgb, pdf, false);
}

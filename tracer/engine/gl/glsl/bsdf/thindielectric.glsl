// A pane of glass, two faces taken for one: the twin of tracer/bsdf/thindielectric.py. a: specular reflectance and
// eta, b: specular transmittance.

vec3 thindielectric_eval(Material m, vec3 wo, vec3 wi) { return vec3(0.0); }

float thindielectric_pdf(Material m, vec3 wo, vec3 wi) { return 0.0; }

Sample thindielectric_sample(Material m, vec3 wo, vec3 u)
{
    float cos_t, one = dielectric_mean(min(abs(wo.z), 1.0), m.a.w, m.number.z != 0, cos_t);
    float share = 2.0 * one / (1.0 + one);
    if (u.x < share)
        return Sample(vec3(-wo.xy, wo.z), share * m.a.rgb, share, true, REFLECTION);
    return Sample(-wo, (1.0 - share) * m.b.rgb, 1.0 - share, true, TRANSMISSION);
}

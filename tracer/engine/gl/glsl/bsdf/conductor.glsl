// Smooth metal: the twin of tracer/bsdf/conductor.py. a: eta, b: k, c: specular reflectance.

vec3 conductor_eval(Material m, vec3 wo, vec3 wi) { return vec3(0.0); }

float conductor_pdf(Material m, vec3 wo, vec3 wi) { return 0.0; }

Sample conductor_sample(Material m, vec3 wo, vec3 u)
{
    bool above = wo.z > 0.0;
    vec3 f = above ? metal_reflectance_at(m, clamp(wo.z, 0.0, 1.0)) : vec3(0.0);
    return Sample(vec3(-wo.xy, wo.z), f, above ? 1.0 : 0.0, true, REFLECTION);
}

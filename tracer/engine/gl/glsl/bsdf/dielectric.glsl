// Smooth glass or water: the twin of tracer/bsdf/dielectric.py. a: specular reflectance and eta,
// b: specular transmittance.

vec3 dielectric_eval(Material m, vec3 wo, vec3 wi) { return vec3(0.0); }

float dielectric_pdf(Material m, vec3 wo, vec3 wi) { return 0.0; }

Sample dielectric_sample(Material m, vec3 wo, vec3 u)
{
    float eta = relative_eta(m, wo.z), cos_t;
    float reflectance = dielectric_mean(min(abs(wo.z), 1.0), eta, m.number.z != 0, cos_t);
    if (u.x < reflectance)
        return Sample(vec3(-wo.xy, wo.z), reflectance * m.a.rgb, reflectance, true, REFLECTION);
    vec3 wi = vec3(-wo.xy / eta, -cos_t * sign_bit(wo.z));
    return Sample(wi, (1.0 - reflectance) / (eta * eta) * m.b.rgb, 1.0 - reflectance, true, TRANSMISSION);
}

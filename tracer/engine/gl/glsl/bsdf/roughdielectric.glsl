// Rough glass: the twin of tracer/bsdf/roughdielectric.py. a: specular reflectance and eta,
// b: specular transmittance, c: alpha_u, alpha_v.

Facets roughdielectric_facets(Material m) { return Facets(m.c.xy, m.number.w != 0); }

// f without its colour, and the density.
vec2 roughdielectric_both(Material material, vec3 wo, vec3 wi)
{
    Facets facets = roughdielectric_facets(material);
    float eta = relative_eta(material, wo.z), cos_t;
    bool same = wo.z * wi.z > 0.0;
    vec3 h = wo + (same ? 1.0 : eta) * wi, m = unit(h) * sign_bit(h.z);
    if (!(dot(wo, m) * wo.z > 0.0 && dot(wi, m) * wi.z > 0.0))
        return vec2(0.0);
    float F = dielectric_mean(min(abs(dot(wo, m)), 1.0), eta, material.number.z != 0, cos_t);
    float both = facets_both(facets, wo, wi), spread = abs(dot(wo, m) * dot(wi, m)) / max(dot(h, h), TINY);
    float lobe = (same ? 0.25 * F : (1.0 - F) * spread) * facets_D(facets, m);
    return vec2(
        lobe / (both > 0.0 ? both : 1.0), lobe * (same ? 1.0 : eta * eta) / facets_facing(facets, wo));
}

vec3 roughdielectric_eval(Material m, vec3 wo, vec3 wi)
{
    return roughdielectric_both(m, wo, wi).x * (wo.z * wi.z > 0.0 ? m.a.rgb : m.b.rgb);
}

float roughdielectric_pdf(Material m, vec3 wo, vec3 wi) { return roughdielectric_both(m, wo, wi).y; }

Sample roughdielectric_sample(Material material, vec3 wo, vec3 u)
{
    float eta = relative_eta(material, wo.z), up = sign_bit(wo.z), cos_t;
    vec3 m = up * facets_visible(roughdielectric_facets(material), upwards(up * wo), u.yz);
    float cos = clamp(dot(wo, m), 0.0, 1.0);
    bool back = u.x < dielectric_mean(cos, eta, material.number.z != 0, cos_t);
    vec3 wi = back ? reflected(wo, m) : renormalised((cos / eta - cos_t) * m - wo / eta);
    bool right = back == (wo.z * wi.z > 0.0);
    vec3 f = right ? roughdielectric_eval(material, wo, wi) : vec3(0.0);
    float pdf = right ? roughdielectric_pdf(material, wo, wi) : 0.0;
    return Sample(wi, f, pdf, false, back ? REFLECTION : TRANSMISSION);
}

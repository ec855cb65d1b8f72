// Rough metal: the twin of tracer/bsdf/roughconductor.py. a: eta and alpha_u, b: k and alpha_v,
// c: specular reflectance.

Facets roughconductor_facets(Material m) { return Facets(vec2(m.a.w, m.b.w), m.number.w != 0); }

vec3 roughconductor_eval(Material m, vec3 wo, vec3 wi)
{
    Mirrored at = mirrored(roughconductor_facets(m), wo, wi);
    return metal_reflectance_at(m, at.cos) * at.f;
}

float roughconductor_pdf(Material m, vec3 wo, vec3 wi) { return mirrored(roughconductor_facets(m), wo, wi).pdf; }

Sample roughconductor_sample(Material m, vec3 wo, vec3 u)
{
    vec3 wi = reflected(wo, facets_visible(roughconductor_facets(m), upwards(wo), u.yz));
    return Sample(wi, roughconductor_eval(m, wo, wi), roughconductor_pdf(m, wo, wi), false, REFLECTION);
}

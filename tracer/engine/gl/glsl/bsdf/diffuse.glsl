// Lambertian reflection: the twin of tracer/bsdf/diffuse.py. a: reflectance.

vec3 diffuse_eval(Material m, vec3 wo, vec3 wi)
{
    return wo.z > 0.0 && wi.z > 0.0 ? m.a.rgb * INV_PI : vec3(0.0);
}

float diffuse_pdf(Material m, vec3 wo, vec3 wi)
{
    return wo.z > 0.0 ? HEMISPHERE_PDF(wi) : 0.0;
}

Sample diffuse_sample(Material m, vec3 wo, vec3 u)
{
    vec3 wi = HEMISPHERE(u.yz);
    return Sample(wi, diffuse_eval(m, wo, wi), diffuse_pdf(m, wo, wi), false, DIFFUSE_LOBE);
}

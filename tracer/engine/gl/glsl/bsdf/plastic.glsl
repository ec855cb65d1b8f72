// A diffuse base under a smooth clear coat: the twin of tracer/bsdf/plastic.py. a: diffuse reflectance and eta,
// b: specular reflectance and inside, c: whether it is nonlinear.

vec3 plastic_base(Material m)
{
    vec3 rho = m.a.rgb;
    return rho / (1.0 - (m.c.x > 0.0 ? rho : vec3(1.0)) * m.b.w) / (m.a.w * m.a.w);
}

float plastic_mirror_chance(Material m, float F)
{
    float mirror = F * largest(m.b.rgb);
    float base = (1.0 - F) * largest(plastic_base(m) * (1.0 - m.b.w) * m.a.w * m.a.w);
    return mirror + base > 0.0 ? mirror / (mirror + base) : 0.0;
}

vec3 plastic_eval(Material m, vec3 wo, vec3 wi)
{
    if (!(wo.z > 0.0 && wi.z > 0.0))
        return vec3(0.0);
    float through = (1.0 - coat_reflectance_at(m, wo.z)) * (1.0 - coat_reflectance_at(m, wi.z));
    return plastic_base(m) * (through * INV_PI);
}

float plastic_pdf(Material m, vec3 wo, vec3 wi)
{
    float chance = plastic_mirror_chance(m, coat_reflectance_at(m, wo.z));
    return wo.z > 0.0 ? (1.0 - chance) * cosine_hemisphere_pdf(wi) : 0.0;
}

Sample plastic_sample(Material m, vec3 wo, vec3 u)
{
    float F = coat_reflectance_at(m, wo.z), above = wo.z > 0.0 ? 1.0 : 0.0;
    float chance = plastic_mirror_chance(m, F);
    if (u.x < chance)
        return Sample(vec3(-wo.xy, wo.z), F * m.b.rgb * above, chance * above, true, REFLECTION);
    vec3 wi = cosine_hemisphere(u.yz);
    return Sample(wi, plastic_eval(m, wo, wi), plastic_pdf(m, wo, wi), false, DIFFUSE_LOBE);
}

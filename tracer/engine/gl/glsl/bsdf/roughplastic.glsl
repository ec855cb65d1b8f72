// A diffuse base under a rough clear coat: the twin of tracer/bsdf/roughplastic.py. a: diffuse reflectance and eta,
// b: specular reflectance and inside, c: alpha, out, whether it is nonlinear, where its part of `through` begins.

float through_at(int k);

Facets roughplastic_facets(Material m) { return Facets(vec2(m.c.x), m.number.w != 0); }

// T, between the nodes of its table.
float roughplastic_through(Material m, float cos)
{
    float x = sqrt(clamp(cos, 0.0, 1.0)) * (NODES - 1.0);
    int k = min(int(x), int(NODES) - 2), first = int(m.c.w);
    float low = through_at(first + k), high = through_at(first + k + 1);
    return low + (x - float(k)) * (high - low);
}

vec3 roughplastic_base(Material m)
{
    vec3 rho = m.a.rgb;
    return rho / (1.0 - (m.c.z > 0.0 ? rho : vec3(1.0)) * m.b.w) / (m.a.w * m.a.w);
}

float roughplastic_glossy_chance(Material m, vec3 wo)
{
    vec3 base = roughplastic_base(m) * m.c.y;
    float glossy = coat_reflectance_at(m, wo.z) * largest(m.b.rgb);
    float whole = glossy + roughplastic_through(m, wo.z) * largest(base);
    return whole > 0.0 ? glossy / whole : 1.0;
}

vec3 roughplastic_eval(Material m, vec3 wo, vec3 wi)
{
    Mirrored at = mirrored(roughplastic_facets(m), wo, wi);
    vec3 glossy = coat_reflectance_at(m, at.cos) * at.f * m.b.rgb;
    if (!(wo.z > 0.0 && wi.z > 0.0))
        return glossy;
    float base = roughplastic_through(m, wo.z) * roughplastic_through(m, wi.z) * INV_PI;
    return glossy + roughplastic_base(m) * base;
}

float roughplastic_pdf(Material m, vec3 wo, vec3 wi)
{
    float chance = roughplastic_glossy_chance(m, wo);
    float diffuse = wo.z > 0.0 ? (1.0 - chance) * cosine_hemisphere_pdf(wi) : 0.0;
    return chance * mirrored(roughplastic_facets(m), wo, wi).pdf + diffuse;
}

Sample roughplastic_sample(Material m, vec3 wo, vec3 u)
{
    bool glossy = u.x < roughplastic_glossy_chance(m, wo);
    vec3 mirror = reflected(wo, facets_visible(roughplastic_facets(m), upwards(wo), u.yz));
    vec3 wi = glossy ? mirror : cosine_hemisphere(u.yz);
    return Sample(
        wi, roughplastic_eval(m, wo, wi), roughplastic_pdf(m, wo, wi), false, glossy ? REFLECTION : DIFFUSE_LOBE);
}

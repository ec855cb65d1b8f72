// All materials as one: the twin of tracer/bsdf/table.py, and of twosided.py.

vec3 over(Material m, vec3 w, vec3 wo) { return is(m, TWO_SIDED) && wo.z < 0.0 ? vec3(w.xy, -w.z) : w; }

bool reflects(Material m, vec3 wo)
{
    return !is(m, BLACK) && (wo.z > 0.0 || (!is(m, ONE_SIDED) && wo.z < 0.0));
}

vec3 bsdf_eval(Material m, vec3 wo, vec3 wi) { return any_eval(m, over(m, wo, wo), over(m, wi, wo)); }

float bsdf_pdf(Material m, vec3 wo, vec3 wi) { return any_pdf(m, over(m, wo, wo), over(m, wi, wo)); }

Sample bsdf_sample(Material m, vec3 wo, vec3 u)
{
    Sample s = any_sample(m, over(m, wo, wo), u);
    s.wi = over(m, s.wi, wo);
    return s;
}

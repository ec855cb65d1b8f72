// Rough boundaries as many small mirrors: the twin of tracer/bsdf/microfacet.py.

struct Facets { vec2 alpha; bool beckmann; };  // roughness along x and y

vec3 unit(vec3 v) { return v / sqrt(max(dot(v, v), TINY)); }

vec3 renormalised(vec3 w) { return w * (1.5 - 0.5 * dot(w, w)); }

vec3 reflected(vec3 w, vec3 m) { return renormalised(2.0 * dot(w, m) * m - w); }

vec3 upwards(vec3 w) { return vec3(w.xy, abs(w.z)); }

float facets_D(Facets facets, vec3 m)
{
    vec2 at = m.xy / facets.alpha;
    float square = dot(at, at);
    float density = facets.beckmann ? beckmann_density(square, m.z) : ggx_density(square, m.z);
    return density / (facets.alpha.x * facets.alpha.y);
}

// |cos| Lambda: area that faces w but is hidden from it.
float facets_hidden(Facets facets, vec3 w)
{
    float r = length(facets.alpha * w.xy), z = abs(w.z);
    return facets.beckmann ? beckmann_hidden(r, z) : ggx_hidden(r, z);
}

// |cos_o cos_i| / G2: what D is divided by in every microfacet BSDF.
float facets_both(Facets facets, vec3 wo, vec3 wi)
{
    float zo = abs(wo.z), zi = abs(wi.z);
    return zo * zi + zo * facets_hidden(facets, wi) + zi * facets_hidden(facets, wo);
}

// cos (1 + Lambda): area of the facets that face w, hidden ones included.
float facets_facing(Facets facets, vec3 w) { return abs(w.z) + facets_hidden(facets, w); }

// A normal that is seen from w (above the surface).
vec3 facets_visible(Facets facets, vec3 w, vec2 u)
{
    vec3 stretched = vec3(facets.alpha * w.xy, w.z);
    vec3 m = facets.beckmann ? beckmann_visible(stretched, u) : ggx_visible(stretched, u);
    return unit(vec3(facets.alpha * m.xy, m.z));
}

struct Mirrored { float cos; float f; float pdf; };

// Reflection at the facets, F = 1; both directions on the upper side (Torrance and Sparrow 1967).
Mirrored mirrored(Facets facets, vec3 wo, vec3 wi)
{
    vec3 m = unit(wo + wi);
    float density = wo.z > 0.0 && wi.z > 0.0 ? 0.25 * facets_D(facets, m) : 0.0;
    float both = facets_both(facets, wo, wi);
    return Mirrored(
        clamp(dot(wo, m), 0.0, 1.0), both > 0.0 ? density / max(both, TINY) : 0.0,
        density / facets_facing(facets, wo));
}

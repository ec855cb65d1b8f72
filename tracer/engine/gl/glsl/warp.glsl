// From the unit square to the domains light lives on: the twin of tracer/warp.py.

#define INV_PI 0.318309886
#define INV_2PI 0.159154943

vec2 concentric_disk(vec2 u)
{
    vec2 p = 2.0 * u - 1.0;
    bool wide = abs(p.x) > abs(p.y);
    float r = wide ? p.x : p.y;
    float ratio = (wide ? p.y : p.x) / (r == 0.0 ? 1.0 : r);
    return r * cos_sin(wide ? 0.785398163 * ratio : 1.57079633 - 0.785398163 * ratio);
}

vec3 cosine_hemisphere(vec2 u) { return vec3(sqrt(u.x) * cos_sin_turn(u.y), sqrt(1.0 - u.x)); }

float cosine_hemisphere_pdf(vec3 w) { return max(w.z, 0.0) * INV_PI; }

vec3 uniform_hemisphere(vec2 u)
{
    return vec3(sqrt(u.x * (2.0 - u.x)) * cos_sin_turn(u.y), 1.0 - u.x);
}

float uniform_hemisphere_pdf(vec3 w) { return w.z > 0.0 ? INV_2PI : 0.0; }

vec3 uniform_sphere(vec2 u)
{
    return vec3(2.0 * sqrt(u.x * (1.0 - u.x)) * cos_sin_turn(u.y), 1.0 - 2.0 * u.x);
}

float uniform_sphere_pdf() { return 0.5 * INV_2PI; }

vec2 uniform_triangle(vec2 u) { return vec2(1.0 - sqrt(u.x), u.y * sqrt(u.x)); }

float uniform_cone_pdf(float one_minus_cos) { return INV_2PI / one_minus_cos; }

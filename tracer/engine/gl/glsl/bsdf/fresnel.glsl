// How much light a smooth boundary reflects: the twin of tracer/bsdf/fresnel.py, in float32.

float schlick(float cos, float head_on)
{
    float miss = 1.0 - cos;
    return head_on + (1.0 - head_on) * (miss * miss) * (miss * miss) * miss;
}

// Unpolarised reflectance; cos_t: the refracted cosine, 0 beyond the critical angle.
float dielectric_mean(float cos, float eta, bool approximate, out float cos_t)
{
    float contrast = (eta - 1.0) * (eta + 1.0), square = contrast + cos * cos;
    cos_t = cos;
    if (contrast == 0.0)
        return approximate ? schlick(cos, 0.0) : 0.0;
    float g = sqrt(max(square, 0.0));
    cos_t = g / eta;
    if (approximate) {
        float head_on = (eta - 1.0) * (eta - 1.0) / ((eta + 1.0) * (eta + 1.0));
        return cos_t == 0.0 && eta < 1.0 ? 1.0 : schlick(eta < 1.0 ? cos_t : cos, head_on);
    }
    if (square <= 0.0)
        return 1.0;
    float eta2 = eta * eta;
    float s = contrast / (square + cos * (cos + 2.0 * g));
    float p = contrast * ((eta2 + 1.0) * cos * cos - 1.0) / (square + eta2 * cos * (eta2 * cos + 2.0 * g));
    return 0.5 * (min(s * s, 1.0) + min(p * p, 1.0));
}

// Unpolarised reflectance of one channel; k below 0 stands for a perfect mirror.
float conductor_mean(float cos, float eta, float k, bool approximate)
{
    if (k < 0.0)
        return 1.0;
    float eta2 = eta * eta, k2 = k * k;
    if (approximate)
        return schlick(cos, ((eta - 1.0) * (eta - 1.0) + k2) / ((eta + 1.0) * (eta + 1.0) + k2));
    float cos2 = cos * cos, sin2 = 1.0 - cos2, t0 = eta2 - k2 - sin2;
    float a2b2 = sqrt(t0 * t0 + 4.0 * eta2 * k2);
    float part = 2.0 * cos * sqrt(max(0.5 * (a2b2 + t0), 0.0));
    float rs = (a2b2 + cos2 - part) / max(a2b2 + cos2 + part, TINY);
    float sum = cos2 * a2b2 + sin2 * sin2;
    float rp = rs * (sum - part * sin2) / max(sum + part * sin2, TINY);
    return 0.5 * (clamp(rs, 0.0, 1.0) + clamp(rp, 0.0, 1.0));
}

// What a material's boundary reflects. A metal, smooth or rough; a: eta, b: k, c: specular reflectance.
vec3 metal_reflectance_at(Material m, float cos)
{
    bool approximate = m.number.z != 0;
    return m.c.rgb
        * vec3(
            conductor_mean(cos, m.a.r, m.b.r, approximate), conductor_mean(cos, m.a.g, m.b.g, approximate),
            conductor_mean(cos, m.a.b, m.b.b, approximate));
}

// The coat over a diffuse base, smooth or rough; a.w: eta.
float coat_reflectance_at(Material m, float cos)
{
    float cos_t;
    return dielectric_mean(clamp(cos, 0.0, 1.0), m.a.w, m.number.z != 0, cos_t);
}

// Index of what lies beyond over that of the side of the direction, of glass smooth or rough; a.w: eta.
float relative_eta(Material m, float cos) { return cos > 0.0 ? m.a.w : 1.0 / m.a.w; }

float largest(vec3 colour) { return max(max(colour.r, colour.g), colour.b); }

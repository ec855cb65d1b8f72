// Beckmann's normals, those of Gaussian slopes, at roughness 1: the twin of tracer/bsdf/beckmann.py, in float32.

#define INV_SQRT_PI 0.564189584
#define STEPS 8

float beckmann_density(float square, float z)
{
    float z2 = max(z * z, 4.3e-19);
    return z > 0.0 ? INV_PI * exp(-square / z2) / (z2 * z2) : 0.0;
}

// exp(x^2) erfc(x) for x >= 0, to 2e-7 (Press et al. 2007, 6.2.2).
float erfcx(float x)
{
    float t = 1.0 / (1.0 + 0.5 * x);
    float p = 0.17087277;
    p = t * p - 0.82215223;
    p = t * p + 1.48851587;
    p = t * p - 1.13520398;
    p = t * p + 0.27886807;
    p = t * p - 0.18628806;
    p = t * p + 0.09678418;
    p = t * p + 0.37409196;
    p = t * p + 1.00002368;
    return t * exp(t * p - 1.26551223);
}

// The x with erfc(x) = q, 0 < q < 2 (Giles 2010).
float erfcinv(float q)
{
    float w = -log(q * (2.0 - q)), p;
    if (w < 5.0) {
        w -= 2.5;
        p = 2.81022636e-8;
        p = p * w + 3.43273939e-7;
        p = p * w - 3.5233877e-6;
        p = p * w - 4.39150654e-6;
        p = p * w + 2.1858087e-4;
        p = p * w - 1.25372503e-3;
        p = p * w - 4.17768164e-3;
        p = p * w + 2.46640727e-1;
        p = p * w + 1.50140941;
    } else {
        w = sqrt(w) - 3.0;
        p = -2.00214257e-4;
        p = p * w + 1.00950558e-4;
        p = p * w + 1.34934322e-3;
        p = p * w - 3.67342844e-3;
        p = p * w + 5.73950773e-3;
        p = p * w - 7.6224613e-3;
        p = p * w + 9.43887047e-3;
        p = p * w + 1.00167406;
        p = p * w + 2.83297682;
    }
    return p * (1.0 - q);
}

// z Lambda: exp(-a^2) (r / sqrt(pi) - z erfcx(a)) / 2 with a = z/r.
float beckmann_hidden(float r, float z)
{
    float a = min(z / max(r, TINY), 100.0);
    return max(0.5 * exp(-a * a) * (r * INV_SQRT_PI - z * erfcx(a)), 0.0);
}

// A stretched normal (x, y, 1) seen from the stretched direction w, by Newton's method for q = erfc(x).
vec3 beckmann_visible(vec3 w, vec2 u)
{
    float r = length(w.xy), safe = max(r, TINY), z = w.z, cot = min(z / safe, 1e3), cell = 5.96046448e-8;
    float most = 2.0 - exp(-cot * cot) * erfcx(cot), beyond = 1.0 - max(u.x, 0.5 * cell);
    float wanted = beyond * (z * most + r * INV_SQRT_PI * exp(-cot * cot));
    float exponent = 0.5 + 0.5 * cot / (0.7 + cot);
    float q = most * (1.0 - pow(1.0 - beyond, exponent));
    for (int k = 0; k < STEPS; ++k) {
        q = clamp(q, TINY, most);
        float slope = erfcinv(q), rise = max(z + r * slope, TINY);
        q = q + (wanted - (z * q + r * INV_SQRT_PI * exp(-slope * slope))) / rise;
    }
    float near = max(erfcinv(clamp(q, TINY, most)), -cot), across_ = erfcinv(2.0 * max(u.y, 0.5 * cell));
    vec2 turn = r > 0.0 ? w.xy / safe : vec2(1.0, 0.0);
    return vec3(turn.x * near - turn.y * across_, turn.y * near + turn.x * across_, 1.0);
}

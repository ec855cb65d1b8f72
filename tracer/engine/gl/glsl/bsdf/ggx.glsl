// GGX normals, those of an ellipsoid, at roughness 1: the twin of tracer/bsdf/ggx.py.

float ggx_density(float square, float z)
{
    float whole = square + z * z;
    return z > 0.0 ? INV_PI / (whole * whole) : 0.0;
}

// z Lambda: with tan = r/z it is (sqrt(z^2 + r^2) - z) / 2, without the difference.
float ggx_hidden(float r, float z) { return 0.5 * r * r / max(z + sqrt(z * z + r * r), TINY); }

// A stretched normal, of any length, seen from the stretched direction w (Dupuy and Benyoub 2023).
vec3 ggx_visible(vec3 w, vec2 u)
{
    w = w / sqrt(max(dot(w, w), TINY));
    float drop = u.x * (1.0 + w.z), r = sqrt(drop * max(2.0 - drop, 0.0));
    return vec3(r * cos_sin_turn(u.y) + w.xy, (1.0 - u.x) * (1.0 + w.z));
}

// The hash and words as numbers: the twin of tracer/sampler/numbers.py. The same integers.

uvec4 pcg4d(uvec4 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

uint dimension(int depth, uint use) { return uint(depth) * USES + use; }

vec3 uniform_numbers(uvec3 words) { return vec3(words >> 8u) * 5.9604644775390625e-8; }

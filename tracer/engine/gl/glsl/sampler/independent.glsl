// Independent uniform numbers: the twin of tracer/sampler/independent.py.

vec3 random(uint pixel, uint number, int depth, uint use)
{
    return uniform_numbers(pcg4d(uvec4(pixel, number, dimension(depth, use), seed)).xyz);
}

// A rank-1 lattice in radical-inverse order, shifted at random: the twin of tracer/sampler/lattice.py.

vec3 random(uint pixel, uint number, int depth, uint use)
{
    uint replicate = number % REPLICATES;
    uint point = bitfieldReverse(number / REPLICATES);
    uint group = uint(depth) / DEPTHS;
    if (group > 0u)
        point *= pcg4d(uvec4(pixel, replicate, ~group, seed)).x | 1u;
    uvec3 shifts = pcg4d(uvec4(pixel, replicate, dimension(depth, use), seed)).xyz;
    return uniform_numbers(COMPONENTS[use * DEPTHS + uint(depth) % DEPTHS] * point + shifts);
}

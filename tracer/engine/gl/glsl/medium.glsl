// Coloured glass: the twin of tracer/medium.py. Of a surface more.z and more.w are the media in front and behind,
// below 0 where both are the same.

vec4 media_at(int k);

vec3 transmittance(int medium, float distance) { return exp(-media_at(medium).rgb * distance); }

// Medium of a ray that leaves a hit along wi, which came there through `medium`.
int towards(Hit hit, vec3 wi, int medium)
{
    vec4 sides = surfaces_at(hit.primitive).more;
    float beyond = sign_bit(dot(hit.ng, wi)) < 0.0 ? sides.w : sides.z;
    return beyond < 0.0 ? medium : int(beyond);
}

// One path: sample k of a pixel that the task names.

uniform uint samples;

uvec2 pixel_at(uint k);  // packed pixel, first sample

vec4 traced(uint path)
{
    uvec2 of = pixel_at(path / samples);
    uint rays = 0u;
    begin_path();
    vec3 L = trace(of.x, of.y + path % samples, rays);
    return vec4(L, float(rays));
}

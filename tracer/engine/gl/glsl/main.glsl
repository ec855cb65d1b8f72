// One invocation traces one path: sample k of a pixel that the task names.

layout(local_size_x = GROUP) in;

uniform uint paths;
uniform uint samples;

layout(std430, binding = 0) readonly buffer Pixels { uvec2 pixels[]; };      // packed pixel, first sample
layout(std430, binding = 1) writeonly buffer Radiance { vec4 radiance[]; };  // and the number of rays

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= paths)
        return;
    uvec2 of = pixels[path / samples];
    uint rays = 0u;
    begin_path(path);
    vec3 L = trace(of.x, of.y + path % samples, rays);
    radiance[path] = vec4(L, float(rays));
}

// One invocation for each path: the twin of fragment/main.glsl.

layout(local_size_x = GROUP) in;

uniform uint paths;

layout(std430, binding = 1) readonly buffer Pixels { uvec2 pixels[]; };      // packed pixel, first sample
layout(std430, binding = 2) writeonly buffer Radiance { vec4 radiance[]; };  // and the number of rays
#if WATCHED
layout(std430, binding = 3) writeonly buffer Vertices { Vertex vertices[]; };
#endif

uvec2 pixel_at(uint k) { return pixels[k]; }

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= paths)
        return;
    radiance[path] = traced(path);
#if WATCHED
    for (int k = 0; k < WATCHED; ++k)
        vertices[path * uint(WATCHED) + uint(k)] = watched_vertex(k);
#endif
}

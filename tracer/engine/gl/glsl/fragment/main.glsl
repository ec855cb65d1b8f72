// One pixel of a picture for each path: the twin of compute/main.glsl. Of the vertices it keeps one.

uniform uint paths;
uniform usampler2D pixels;  // packed pixel, first sample

layout(location = 0) out vec4 radiance;  // and the number of rays
#if WATCHED
uniform int watched;

layout(location = 1) out ivec4 number;
layout(location = 2) out vec4 p;
#endif

uvec2 pixel_at(uint k) { return texelFetch(pixels, ivec2(int(k) % ACROSS, int(k) / ACROSS), 0).xy; }

void main()
{
    uint path = uint(gl_FragCoord.y) * uint(ACROSS) + uint(gl_FragCoord.x);
    if (path >= paths)
        discard;
    radiance = traced(path);
#if WATCHED
    number = watched_vertex(watched).number;
    p = watched_vertex(watched).p;
#endif
}

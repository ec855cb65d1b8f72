// The words of all tables where shaders read pictures only: the twin of compute/tables.glsl.

uniform usampler2D tables;

uvec4 words(int k) { return texelFetch(tables, ivec2(k % ACROSS, k / ACROSS), 0); }

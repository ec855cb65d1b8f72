// The words of all tables where shaders read and write buffers: the twin of fragment/tables.glsl.

layout(std430, binding = 0) readonly buffer Tables { uvec4 tables[]; };

uvec4 words(int k) { return tables[k]; }

// Tables of rows of four numbers each; NAME_at(k) reads row k of the table NAME.

vec4 reals(int word) { return uintBitsToFloat(words(word)); }

ivec4 whole(int word) { return ivec4(words(word)); }

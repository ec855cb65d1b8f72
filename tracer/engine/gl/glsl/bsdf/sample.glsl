// What a BSDF is and answers: the twin of tracer/bsdf/sample.py.

struct Material {
    ivec4 number;  // kind; flags; whether Fresnel's formula is Schlick's, facets Beckmann's
    vec4 a;        // what these are, the file of the kind says
    vec4 b;
    vec4 c;
    ivec4 painted;  // number of the texture in the place of the colour of a, b, c; -1 for none
};

Material materials_at(int k);

#define ONE_SIDED 1
#define BLACK 2
#define DELTA 4
#define TWO_SIDED 8  // the same material on both sides
#define ANISOTROPIC 16

#define NONE 0
#define DIFFUSE_LOBE 1
#define REFLECTION 2
#define TRANSMISSION 3

struct Sample { vec3 wi; vec3 f; float pdf; bool delta; int lobe; };

bool is(Material m, int flag) { return (m.number.y & flag) != 0; }

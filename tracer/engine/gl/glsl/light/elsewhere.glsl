// Lights that are no shapes, and where rays to far ones end.

struct Elsewhere {
    ivec4 number;  // which kind
    vec4 where;    // or whither
    vec4 colour;   // and the probability of the light
};

Elsewhere elsewhere_at(int k);

float far_side(vec3 p) { return 2.0 * max(BALL.w, length(p - BALL.xyz)); }

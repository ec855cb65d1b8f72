// Rays, and the bound on where they may start: the twin of tracer/shape/rays.py.

#define EPS 1.1920929e-7

struct Ray {
    vec3 o;
    vec3 d;
    int source;   // primitive it starts on, -1 at the camera
    int target;   // primitive it is aimed at, -1 for none
    float bound;  // how far it may lie off the primitive it starts on
    bool outside; // whether it left to the side of that primitive's normal
};

struct Near { float t; int primitive; };  // the nearest hit so far

float error_bound(vec3 p, vec3 n, float reach) { return 8.0 * EPS * (dot(abs(n), abs(p)) + reach); }

vec3 leave(vec3 p, vec3 n, float bound, vec3 w) { return p + n * (bound * sign_bit(dot(n, w))); }

// What a light hands to a receiver: the twin of tracer/light/sample.py.

struct LightSample {
    int primitive;  // that q lies on, -1 if on none
    vec3 q;
    vec3 nq;
    vec3 wi;
    vec3 Le;        // radiance back along wi, 0 behind the light; of a light without size the irradiance
    float pdf;      // of wi in sr^-1, choice of the light included, 0 behind the light
    bool delta;     // whether the light has no size
};

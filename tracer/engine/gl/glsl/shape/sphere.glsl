// A sphere: the twin of tracer/shape/sphere.py.

struct Ball {
    ivec4 number;  // its primitive; whether it may hide a lamp
    vec4 place;    // centre and radius
};

Ball balls_at(int k);

void meet_sphere(Ray r, inout Near near, Ball sphere)
{
    int primitive = sphere.number.x;
    vec4 ball = sphere.place;
    vec3 oc = r.o - ball.xyz;
    float b = dot(oc, r.d), t;
    if (primitive == r.target)
        return;
    if (primitive == r.source)
        t = -2.0 * b;
    else {
        vec3 foot = oc - b * r.d;
        float disc = ball.w * ball.w - dot(foot, foot);
        if (!(disc >= 0.0))
            return;
        float away = -(b + sqrt(disc) * sign_bit(b)), size = length(oc);
        float close = (size - ball.w) * (size + ball.w) / away;
        t = min(close, away) > 0.0 ? min(close, away) : max(close, away);
    }
    if (t > 0.0 && t < near.t)
        near = Near(t, primitive);
}

// A sphere that shines outwards, sampled over the cone in which it is seen: the twin of tracer/light/sphere.py.

float one_minus_cos(float radius, float distance, float slack)
{
    if (!(distance > radius + slack))
        return 0.0;
    float sine = radius / distance;
    float square = max((distance - radius) * (distance + radius), 0.0) / (distance * distance);
    return sine * sine / (1.0 + sqrt(square));
}

// The normal at the point; the point is center + radius n.
vec3 uniform_cone(vec3 p, vec3 center, float radius, vec2 u, float slack, out float least)
{
    vec3 out_ = p - center;
    float distance = length(out_);
    least = one_minus_cos(radius, distance, slack);
    if (!(least > 0.0))
        return vec3(0.0);
    float drop = u.x * least, sin = sqrt(drop * (2.0 - drop)), cos = 1.0 - drop, sin_most = radius / distance;
    float rim = sqrt((1.0 - u.x) * max(2.0 - least * (1.0 + u.x), 0.0) / (2.0 - least));
    float aside = sin * (cos / sin_most - rim), along = sin * sin / sin_most + cos * rim;
    return to_world(around(out_ / distance), vec3(aside * cos_sin_turn(u.y), along));
}

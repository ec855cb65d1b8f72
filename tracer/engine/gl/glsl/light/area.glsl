// Surfaces that shine: the twin of tracer/light/area.py.

#define AREA 0
#define SOLID_ANGLE 1
#define CONE 2

struct Face {
    ivec4 number;  // kind; how it is sampled; primitive; -
    vec4 corner;   // or the centre of a sphere; 1 / area
    vec4 e1;       // a side, or the radius of a sphere; its length
    vec4 e2;       // the other side; its length
    vec4 n;        // normal, or +1 or -1 of a sphere; probability of the face
    vec4 Le;       // radiance; how far a point may be off the face
};

Face faces_at(int k);

Seen face_seen(Face face, vec3 p)
{
    float width = face.e1.w, height = face.e2.w;
    Seen seen = seen_from(
        p, face.corner.xyz, face.e1.xyz / width, face.e2.xyz / height, face.n.xyz, width, height);
    if (!(seen.z > face.Le.w))  // the rectangle itself, but for rounding, sees nothing of it
        seen.z = 0.0;
    return seen;
}

float per_angle(float density, float square, float cos)
{
    return cos > 0.0 ? density * square / max(cos, TINY) : 0.0;
}

// q, nq and a density per m^2.
float by_area(Face face, vec3 p, vec2 u, out vec3 q, out vec3 nq)
{
    nq = face.n.xyz;
    if (face.number.x == SPHERE) {
        vec3 around_ = uniform_sphere(u);
        bool within = length(p - face.corner.xyz) <= face.e1.x + face.Le.w;
        q = face.corner.xyz + face.e1.x * around_;
        nq = face.n.x * around_;
        return (face.n.x > 0.0) == within ? 0.0 : face.corner.w;
    }
    if (face.number.x == TRIANGLE)
        u = uniform_triangle(u);
    q = face.corner.xyz + u.x * face.e1.xyz + u.y * face.e2.xyz;
    return face.corner.w;
}

LightSample area_sample(Face face, vec3 p, vec2 u)
{
    vec3 q, nq;
    int way = face.number.y;
    float density = 0.0;
    if (way == SOLID_ANGLE) {
        Seen seen = face_seen(face, p);
        float omega = solid_angle(seen);
        if (omega > LEAST) {
            u = uniform_solid_angle(seen, omega, u);
            density = 1.0 / omega;
        } else
            way = AREA;
        float by_m2 = by_area(face, p, u, q, nq);
        density = way == AREA ? by_m2 : density;
    } else {
        density = by_area(face, p, u, q, nq);
        if (way == CONE) {
            float least;
            vec3 n = uniform_cone(p, face.corner.xyz, face.e1.x, u, face.Le.w, least);
            if (least > 0.0) {
                nq = n;
                q = face.corner.xyz + face.e1.x * n;
                density = uniform_cone_pdf(least);
            } else
                way = AREA;
        }
    }
    vec3 to_light = q - p;
    float square = dot(to_light, to_light);
    vec3 wi = to_light / sqrt(square);
    if (way == AREA)
        density = per_angle(density, square, -dot(nq, wi));
    return LightSample(
        face.number.z, q, nq, wi, density > 0.0 ? face.Le.rgb : vec3(0.0), density * face.n.w, false);
}

// Density in sr^-1 with which area_sample, from p, gives the direction to q on the face, whose normal there is n.
float area_pdf(Face face, vec3 p, vec3 q, vec3 n)
{
    vec3 to_light = q - p;
    float square = dot(to_light, to_light);
    float density = face.corner.w * square * sqrt(square) / abs(dot(n, to_light));
    if (face.number.y == SOLID_ANGLE) {
        float omega = solid_angle(face_seen(face, p));
        density = omega > LEAST ? 1.0 / omega : density;
    } else if (face.number.y == CONE) {
        float least = one_minus_cos(face.e1.x, length(p - face.corner.xyz), face.Le.w);
        density = least > 0.0 ? uniform_cone_pdf(least) : 0.0;
    }
    return density * face.n.w;
}

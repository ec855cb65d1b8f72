// A rectangle sampled uniformly over the solid angle it covers: the twin of tracer/light/rectangle.py.

#define LEAST 1e-6
#define OPPOSITE 0.1

struct Seen { float x0; float x1; float y0; float y1; float z; float width; float height; };

Seen seen_from(vec3 p, vec3 corner, vec3 x, vec3 y, vec3 n, float width, float height)
{
    vec3 to_corner = corner - p;
    float x0 = dot(x, to_corner), y0 = dot(y, to_corner);
    return Seen(x0, x0 + width, y0, y0 + height, -dot(n, to_corner), width, height);
}

float share(float x0, float x1, float y, float z, float zz, float width)
{
    float rest = y * y + zz, r0 = sqrt(x0 * x0 + rest), r1 = sqrt(x1 * x1 + rest);
    float one = x1 * r0, other = x0 * r1;
    float apart = x0 * x1 > 0.0 ? rest * width * (x0 + x1) / (one + other) : one - other;
    return atan2(y * z * apart, zz * r0 * r1 + x0 * x1 * y * y);
}

// Where the receiver's foot lies between two opposite sides, from those two sides' shares.
float from_close(Seen r)
{
    float zz = r.z * r.z;
    if (r.y0 < 0.0 && r.y1 > 0.0)
        return share(r.x0, r.x1, r.y1, r.z, zz, r.width) - share(r.x0, r.x1, r.y0, r.z, zz, r.width);
    return share(r.y0, r.y1, r.x1, r.z, zz, r.height) - share(r.y0, r.y1, r.x0, r.z, zz, r.height);
}

// In sr, as that of two triangles (Van Oosterom and Strackee 1983); 0 from behind.
float solid_angle(Seen r)
{
    if (!(r.z > 0.0))
        return 0.0;
    float xx = r.x0 * r.x1, yy = r.y0 * r.y1, zz = r.z * r.z;
    float low = r.x0 * r.x0, high = r.x1 * r.x1, near = r.y0 * r.y0 + zz, far = r.y1 * r.y1 + zz;
    float r00 = sqrt(low + near), r10 = sqrt(high + near), r01 = sqrt(low + far), r11 = sqrt(high + far);
    float diagonal = r00 * r11, volume = r.z * r.width * r.height / diagonal;
    float both = 1.0 + (xx + yy + zz) / diagonal;
    float sine_a = volume / r10, cosine_a = both + (xx + near) / (r00 * r10) + (high + yy + zz) / (r10 * r11);
    float sine_b = volume / r01, cosine_b = both + (low + yy + zz) / (r00 * r01) + (xx + far) / (r01 * r11);
    if (min(sine_a * sine_a + cosine_a * cosine_a, sine_b * sine_b + cosine_b * cosine_b) < OPPOSITE)
        return from_close(r);
    return 2.0 * atan2(sine_a * cosine_b + sine_b * cosine_a, cosine_a * cosine_b - sine_a * sine_b);
}

// gamma(x); of no use far to the left of 0, where it loses its digits.
float beyond(Seen r, float x)
{
    float zz = r.z * r.z, square = x * x;
    float a = sqrt(square + r.y0 * r.y0 + zz), b = sqrt(square + r.y1 * r.y1 + zz);
    float product = a * b, inner = square + r.y0 * r.y1 + zz;
    float crossed = r.height * r.height * (square + zz) / (product + abs(inner));
    return 2.0 * atan2(r.z * r.height, (inner < 0.0 ? crossed : product + inner) + x * (a + b));
}

// x with the share u of the solid angle between x0 and x.
float across(Seen r, float omega, float u)
{
    float side = r.z * r.height, level = r.y0 * r.y1 + r.z * r.z;
    float right = beyond(r, r.x1) + (1.0 - u) * omega;
    bool positive = right <= atan2(side, level);
    float gamma = positive ? right : beyond(r, -r.x0) + u * omega;
    vec2 turn = cos_sin(0.5 * gamma);
    float sin = turn.y, cos = turn.x;
    float first = side * (1.0 - 2.0 * sin * sin) - level * (2.0 * sin * cos);
    float second = (side * cos - level * sin) * sin;
    float third = (r.z * cos + r.y1 * sin) * (r.z * cos - r.y0 * sin);
    float x = 0.5 * r.z * first / sqrt(second * third);
    return positive ? x : -x;
}

// Where on the rectangle, each from 0 to 1, so that directions are uniform over its solid angle.
vec2 uniform_solid_angle(Seen r, float omega, vec2 u)
{
    float x = across(r, omega, u.x);
    x = x > r.x0 ? min(x, r.x1) : r.x0;  // not so for NaN
    float d = x * x + r.z * r.z;
    float h0 = r.y0 / sqrt(d + r.y0 * r.y0), h1 = r.y1 / sqrt(d + r.y1 * r.y1);
    float h = h0 + u.y * (h1 - h0);
    float y = h * sqrt(d / ((1.0 - h) * (1.0 + h)));
    float t = (y - r.y0) / r.height;
    return vec2(min((x - r.x0) / r.width, 1.0), t > 0.0 ? min(t, 1.0) : 0.0);
}

// Vectors and local frames: the twin of tracer/frame.py.

struct Frame { vec3 s; vec3 t; vec3 n; };  // n is the local z axis

float sign_bit(float x) { return floatBitsToInt(x) < 0 ? -1.0 : 1.0; }  // of -0, too

// The frame around a unit normal that has no singular direction (Duff et al. 2017).
Frame around(vec3 n)
{
    float sign = sign_bit(n.z);
    float a = -1.0 / (sign + n.z);
    float b = n.x * n.y * a;
    return Frame(
        vec3(1.0 + sign * (n.x * n.x) * a, sign * b, -sign * n.x), vec3(b, sign + n.y * n.y * a, -n.y), n);
}

// The frame around a unit normal with s as near to a unit tangent as it can be.
Frame along(vec3 n, vec3 tangent)
{
    vec3 s = tangent - n * dot(n, tangent);
    float size = length(s);
    if (!(size > 0.01))
        return around(n);
    s = s / size;
    return Frame(s, cross(n, s), n);
}

vec3 to_local(Frame f, vec3 w) { return vec3(dot(f.s, w), dot(f.t, w), dot(f.n, w)); }

vec3 to_world(Frame f, vec3 w) { return f.s * w.x + f.t * w.y + f.n * w.z; }

bool any_channel(vec3 colour) { return any(notEqual(colour, vec3(0.0))); }

// Sines, cosines and angles by polynomials (Moshier's Cephes): what a driver has for them may be off by 1e-3
// where they are small, and no two drivers agree.

vec2 cos_sin_near(float x)  // |x| <= pi/4
{
    float s = x * x;
    float c = ((2.443315711809948e-5 * s - 1.388731625493765e-3) * s + 4.166664568298827e-2) * s * s;
    float y = ((-1.9515295891e-4 * s + 8.3321608736e-3) * s - 1.6666654611e-1) * s * x + x;
    return vec2(c - 0.5 * s + 1.0, y);
}

vec2 quarter_turned(vec2 v, int quarters)
{
    v = (quarters & 1) != 0 ? vec2(-v.y, v.x) : v;
    return (quarters & 2) != 0 ? -v : v;
}

vec2 cos_sin(float x)  // |x| up to a few turns
{
    float q = round(x * 0.636619772);
    float rest = ((x - q * 1.5703125) - q * 4.837512969970703125e-4) - q * 7.549789948768648e-8;
    return quarter_turned(cos_sin_near(rest), int(q));
}

vec2 cos_sin_turn(float u)  // of 2 pi u, u from 0 to 1
{
    float q = floor(4.0 * u + 0.5);
    return quarter_turned(cos_sin_near(6.28318531 * (u - 0.25 * q)), int(q));
}

float atan2(float y, float x)
{
    float ax = abs(x), ay = abs(y), most = max(ax, ay), least = min(ax, ay);
    if (most == 0.0)
        return 0.0;
    bool far = least > 0.414213562 * most;
    float z = far ? (least - most) / (least + most) : least / most, s = z * z;
    float a = (((8.05374449538e-2 * s - 1.38776856032e-1) * s + 1.99777106478e-1) * s - 3.33329491539e-1) * s * z + z;
    a = far ? a + 0.785398163 : a;
    a = ay > ax ? 1.57079633 - a : a;
    a = x < 0.0 ? PI - a : a;
    return y < 0.0 ? -a : a;
}

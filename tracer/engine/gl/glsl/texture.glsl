// Colours that vary over a surface: the twin of tracer/texture/ and of uv in tracer/shape/chart.py.

struct Chart { vec4 a; vec4 b; vec4 c; };  // a corner and u, grad u and v, grad v; of a sphere its axes

struct Texture {
    ivec4 number;  // width, 0 for a checkerboard; height; filter; wrap mode
    vec4 u;        // the affine map of coordinates, its first row; where the texels begin
    vec4 v;
};

Chart charts_at(int k);
Texture textures_at(int k);
vec4 texels_at(int k);

#define NEAREST 1
#define REPEAT 0
#define MIRROR 1

vec2 surface_uv(Hit hit)
{
    Chart chart = charts_at(hit.primitive);
    Surface s = surfaces_at(hit.primitive);
    if (s.number.x != SPHERE) {
        vec3 away = hit.p - chart.a.xyz;
        return vec2(chart.a.w + dot(chart.b.xyz, away), chart.b.w + dot(chart.c.xyz, away));
    }
    vec3 away = hit.p - s.plane.xyz;
    vec3 at = vec3(dot(chart.a.xyz, away), dot(chart.b.xyz, away), dot(chart.c.xyz, away));
    float u = atan2(at.y, at.x) * INV_2PI;
    return vec2(u < 0.0 ? u + 1.0 : u, atan2(length(at.xy), at.z) * INV_PI);
}

int wrapped(float k, int size, int mode)
{
    if (mode == REPEAT)
        return int(k - float(size) * floor(k / float(size)));
    if (mode != MIRROR)
        return int(clamp(k, 0.0, float(size - 1)));
    int there = int(k - float(2 * size) * floor(k / float(2 * size)));
    return min(there, 2 * size - 1 - there);
}

vec3 texel(Texture t, float column, float row)
{
    int place = wrapped(row, t.number.y, t.number.w) * t.number.x + wrapped(column, t.number.x, t.number.w);
    return texels_at(int(t.u.w) + place).rgb;
}

vec3 bitmap_at(Texture t, vec2 uv)
{
    vec2 at = uv * vec2(t.number.xy);
    if (t.number.z == NEAREST)
        return texel(t, floor(at.x), floor(at.y));
    at -= 0.5;
    vec2 low = floor(at);
    at -= low;
    vec3 above = mix(texel(t, low.x, low.y), texel(t, low.x + 1.0, low.y), at.x);
    vec3 below = mix(texel(t, low.x, low.y + 1.0), texel(t, low.x + 1.0, low.y + 1.0), at.x);
    return mix(above, below, at.y);
}

vec3 checkerboard_at(Texture t, vec2 uv)
{
    bvec2 past = greaterThan(uv - floor(uv), vec2(0.5));
    return texels_at(int(t.u.w) + (past.x == past.y ? 0 : 1)).rgb;
}

vec3 texture_at(Texture t, vec2 uv)
{
    uv = vec2(t.u.x * uv.x + t.u.y * uv.y + t.u.z, t.v.x * uv.x + t.v.y * uv.y + t.v.z);
    return t.number.x == 0 ? checkerboard_at(t, uv) : bitmap_at(t, uv);
}

// The material there, with what its textures say in the place of parameters.
Material painted(Hit hit)
{
    Material m = hit.material;
    if (m.painted.x < 0 && m.painted.y < 0 && m.painted.z < 0)
        return m;
    vec2 uv = surface_uv(hit);
    if (m.painted.x >= 0)
        m.a.rgb = texture_at(textures_at(m.painted.x), uv);
    if (m.painted.y >= 0)
        m.b.rgb = texture_at(textures_at(m.painted.y), uv);
    if (m.painted.z >= 0)
        m.c.rgb = texture_at(textures_at(m.painted.z), uv);
    return m;
}

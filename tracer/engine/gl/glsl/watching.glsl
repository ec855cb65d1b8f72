// What happens to a path's first vertices, where somebody looks; nothing at all elsewhere.

#define ESCAPED 0
#define ABSORBED 1
#define ROULETTE_END 2
#define MAX_DEPTH 3
#define BLACK_END 4

#if WATCHED
struct Vertex {
    ivec4 number;  // primitive; lobe of the bounce; light sample: 0 none, 1 hidden, 2 seen; whether it was reached
    vec4 p;        // and why the path ended
};

Vertex kept[WATCHED];
int reason_of_end;

void begin_path()
{
    for (int k = 0; k < WATCHED; ++k)
        kept[k] = Vertex(ivec4(-1, 0, 0, 0), vec4(0.0));
}

void seen_vertex(int depth, int primitive, vec3 p)
{
    if (depth < WATCHED)
        kept[depth] = Vertex(ivec4(primitive, 0, 0, 1), vec4(p, 1.0));
}

void seen_light(int depth, bool visible)
{
    if (depth < WATCHED)
        kept[depth].number.z = visible ? 2 : 1;
}

void seen_bounce(int depth, int lobe)
{
    if (depth < WATCHED)
        kept[depth].number.y = lobe;
}

vec3 end(int reason, vec3 L)
{
    reason_of_end = reason;
    return L;
}

Vertex watched_vertex(int k) { return Vertex(kept[k].number, vec4(kept[k].p.xyz, float(reason_of_end))); }
#else
void begin_path() {}
void seen_vertex(int depth, int primitive, vec3 p) {}
void seen_light(int depth, bool visible) {}
void seen_bounce(int depth, int lobe) {}
vec3 end(int reason, vec3 L) { return L; }
#endif

// A tree of boxes over triangles: the twin of tracer/shape/bvh.py. The same arrays, but each ray goes down alone,
// the nearest child first.

struct Mesh {
    ivec4 number;  // its first primitive; how many; rows of its root and of its first leaf
    ivec4 more;    // steps of the way down; children of the root; triangles in a leaf; whether it may hide a lamp
    vec4 low;      // corners of the box around everything
    vec4 high;
};

Mesh meshes_at(int k);
vec4 nodes_at(int k);  // twelve a node: low x of its eight children, low y, ..., high z

#define SLACK (8.0 * EPS)

vec3 inverse(vec3 d)
{
    vec3 tiny = vec3(sign_bit(d.x), sign_bit(d.y), sign_bit(d.z)) * 1e-19;
    return 1.0 / mix(d, tiny, lessThan(abs(d), vec3(1e-19)));
}

// Whether a ray passes a box before `within`, or misses it by less than rounding (Ize 2013).
bool enters(vec3 low, vec3 high, vec3 o, vec3 over_d, float within)
{
    vec3 one = (low - o) * over_d, other = (high - o) * over_d;
    vec3 enter = min(one, other), leave = max(one, other);
    float near = max(max(enter.x, enter.y), enter.z);
    float far = min(min(within, leave.x), min(leave.y, leave.z));
    far += SLACK * abs(far);
    return near - SLACK * abs(near) <= far && far >= 0.0;
}

#if DEEPEST
// Four boxes at once, from row k of the table on: where they are entered, below 0 as 0, as integers in the same
// order; the largest there is where a ray does not pass.
uvec4 four_entered(int k, vec3 o, vec3 over_d, float within)
{
    vec4 near = vec4(-INFINITE), far = vec4(within);
    for (int axis = 0; axis < 3; ++axis) {
        vec4 one = (nodes_at(k + 2 * axis) - o[axis]) * over_d[axis];
        vec4 other = (nodes_at(k + 2 * axis + 6) - o[axis]) * over_d[axis];
        near = max(near, min(one, other));
        far = min(far, max(one, other));
    }
    far += SLACK * abs(far);
    bvec4 past = greaterThan(near - SLACK * abs(near), far), behind = lessThan(far, vec4(0.0));
    return floatBitsToUint(max(near, 0.0)) | uvec4(past) * 0xFFFFFFFFu | uvec4(behind) * 0xFFFFFFFFu;
}

#define IN_ORDER(a, b) least = min(key[a], key[b]); key[b] = max(key[a], key[b]); key[a] = least;

// Those of the first `width` children of a node that a ray passes, the nearest in the lowest four bits, each as 8 more
// than its number.
uint children(int node, int width, vec3 o, vec3 over_d, float within)
{
    uvec4 some = four_entered(12 * node, o, over_d, within), others = four_entered(12 * node + 1, o, over_d, within);
    some = (some & ~7u) | uvec4(0u, 1u, 2u, 3u);
    others = (others & ~7u) | uvec4(4u, 5u, 6u, 7u);
    uint key[8] = uint[8](some.x, some.y, some.z, some.w, others.x, others.y, others.z, others.w), least;
    IN_ORDER(0, 2) IN_ORDER(1, 3) IN_ORDER(4, 6) IN_ORDER(5, 7)
    IN_ORDER(0, 4) IN_ORDER(1, 5) IN_ORDER(2, 6) IN_ORDER(3, 7)
    IN_ORDER(0, 1) IN_ORDER(2, 3) IN_ORDER(4, 5) IN_ORDER(6, 7)
    IN_ORDER(2, 4) IN_ORDER(3, 5)
    IN_ORDER(1, 4) IN_ORDER(3, 6)
    IN_ORDER(1, 2) IN_ORDER(3, 4) IN_ORDER(5, 6)
    uint order = 0u;
    for (int k = 0; k < 8; ++k)
        order |= key[k] < 0xFFFFFFF8u && int(key[k] & 7u) < width ? (8u | (key[k] & 7u)) << (4 * k) : 0u;
    return order;
}

// Row of a node that lies so many steps below the root of a mesh.
int row_of(Mesh mesh, int step, int node)
{
    return mesh.number.z + node + (step == 0 ? 0 : 1 + mesh.more.y * ((1 << (3 * step - 3)) - 1) / 7);
}
#endif

// Small functions whose accuracy the API leaves open or that need care with rounding.
#ifndef ISOLUX_CORE_MATH_GLSL
#define ISOLUX_CORE_MATH_GLSL

const float kPi = 3.14159265358979;
const float kInvPi = 0.318309886183791;
const float kFarthest = 3.402823466e38; // the largest float: stands for "none" where infinities may be optimised away

// Bound on n roundings in a row, (n u)/(1 - n u) with u = 2^-24 (Higham 2002; pbrt 6.8.1).
float errorBound(float n) { return (n * 5.9604645e-8) / (1.0 - n * 5.9604645e-8); }

// sin and cos for |x| <= pi/4, to about 1 ulp: minimax polynomials (Cephes, Moshier 1989). The built-in ones may be
// off by 2^-11.
vec2 sinCosOctant(float x) {
    float x2 = x * x;
    float sine = x + x * x2 * (-1.6666654611e-1 + x2 * (8.3321608736e-3 + x2 * -1.9515295891e-4));
    float cosine = 1.0 - 0.5 * x2 + x2 * x2 * (4.166664568298827e-2 + x2 * (-1.388731625493765e-3 + x2 * 2.443315711809948e-5));
    return vec2(sine, cosine);
}

// (cos, sin) of 2 pi u for u in [0, 1): the reduction to an octant is exact.
vec2 cosSinTurn(float u) {
    float quarterTurns = u * 4.0;
    float quadrant = floor(quarterTurns + 0.5);
    vec2 sc = sinCosOctant((quarterTurns - quadrant) * (0.5 * kPi));
    uint q = uint(quadrant) & 3u;
    vec2 rotated = (q & 1u) == 0u ? vec2(sc.y, sc.x) : vec2(-sc.x, sc.y);
    return (q & 2u) == 0u ? rotated : -rotated;
}

// atan2(y, x) as a fraction of a turn, in [-1/2, 1/2], to about 1 ulp of a quarter turn: a minimax polynomial up to
// tan(pi/8) (Cephes, Moshier 1989), since the built-in ones may be off by 4096 ulp. (0, 0) gives 0.
float atan2Turns(float y, float x) {
    float largest = max(abs(x), abs(y));
    float ratio = largest == 0.0 ? 0.0 : min(abs(x), abs(y)) / largest;
    bool upper = ratio > 0.41421356;
    float t = upper ? (ratio - 1.0) / (ratio + 1.0) : ratio;
    float t2 = t * t;
    float angle = t + t * t2 * (-3.33329491539e-1 + t2 * (1.99777106478e-1 + t2 * (-1.38776856032e-1 + t2 * 8.05374449538e-2)));
    float turns = (upper ? 0.125 : 0.0) + angle * (0.5 * kInvPi);
    turns = abs(y) > abs(x) ? 0.25 - turns : turns;
    turns = x < 0.0 ? 0.5 - turns : turns;
    return y < 0.0 ? -turns : turns;
}

// Concentric map of the square to the disk (Shirley and Chiu 1997); `radius`: signed distance from the centre.
vec2 concentricDisk(vec2 u, out float radius) {
    vec2 d = 2.0 * u - 1.0;
    bool byX = abs(d.x) > abs(d.y);
    radius = byX ? d.x : d.y;
    float other = byX ? d.y : d.x;
    vec2 sc = sinCosOctant(radius == 0.0 ? 0.0 : 0.25 * kPi * (other / radius));
    return radius * (byX ? sc.yx : sc.xy);
}

// The height of the hemisphere over a point of the disk. On the rim itself a direction would lie in the surface, and one
// path in 2^23 would end there.
float heightOverDisk(float radius) {
    float inside = min(abs(radius), 1.0 - 1.0 / 16777216.0);
    return sqrt((1.0 - inside) * (1.0 + inside));
}

float maxComponent(vec3 v) { return max(v.x, max(v.y, v.z)); }

float luminance(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

// Tests on bits: drivers may assume that no NaN or infinity exists.
bool isFiniteBits(float x) { return (floatBitsToUint(x) & 0x7F800000u) != 0x7F800000u; }
bool isFiniteBits(vec3 v) { return isFiniteBits(v.x) && isFiniteBits(v.y) && isFiniteBits(v.z); }

// The neighbouring float away from zero if `up` has x's sign, else towards it; x finite. Zero moves to the least
// normal number, since denormals may be flushed.
float nextFloat(float x, bool up) {
    uint bits = floatBitsToUint(x);
    bool away = up == (x > 0.0);
    float fromZero = up ? 1.17549435e-38 : -1.17549435e-38;
    return x == 0.0 ? fromZero : uintBitsToFloat(away ? bits + 1u : bits - 1u);
}

// Orthonormal frame about n (Duff et al. 2017). The sign switches where few scenes have normals, so that rounding
// cannot make two backends choose differently.
void frameAbout(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float sigma = n.z < -0.38 ? -1.0 : 1.0;
    float a = -1.0 / (sigma + n.z);
    float b = n.x * n.y * a;
    tangent = vec3(1.0 + sigma * n.x * n.x * a, sigma * b, -sigma * n.x);
    bitangent = vec3(b, sigma + n.y * n.y * a, -n.y);
}

// The weight of a sample of density f beside another technique of density g: f^p / (f^p + g^p) with p = 1 or 2 (balance
// and power heuristic, Veach 1997, 9.2.2) in ratio form: no pdf is ever squared.
float misWeight(float f, float g, bool balance) {
    float ratio = g <= f ? g / f : f / g;
    float powered = balance ? ratio : ratio * ratio;
    return (g <= f ? 1.0 : powered) / (1.0 + powered);
}

#endif

// An equirectangular map of what comes from infinitely far: its radiance and density in a direction, and choosing one
// (host/scene/README.md, "Environment maps").
#ifndef ISOLUX_LIGHT_ENVIRONMENT_MAP_GLSL
#define ISOLUX_LIGHT_ENVIRONMENT_MAP_GLSL

#include "light/light_sample.glsl"
#include "core/math.glsl"
#include "core/philox.glsl"

// Where the map is and how it is turned. A texel's word holds its radiance and, in w, the density with which its cell's
// directions are sampled.
struct EnvironmentMap {
    uint texels;
    uint bins; // of the alias table that chooses cells
    uint bits;
    ivec2 size;
    float rotation; // turns
};

// Columns and rows, as real numbers, in which a direction lies.
vec2 mapCoordinates(EnvironmentMap map, vec3 direction) {
    float column = 0.5 + atan2Turns(direction.x, -direction.z) + map.rotation;
    float row = 2.0 * atan2Turns(length(direction.xz), direction.y);
    return vec2(column - floor(column), row) * vec2(map.size);
}

vec4 mapTexel(EnvironmentMap map, ivec2 at) { return tableWord(map.texels + uint(at.y * map.size.x + at.x)); }

// Bilinear; columns wrap, rows end.
vec3 mapRadiance(EnvironmentMap map, vec2 coordinates) {
    vec2 s = coordinates - 0.5;
    ivec2 base = ivec2(floor(s));
    vec2 f = s - floor(s);
    ivec2 next = base + 1;
    ivec2 columns = ivec2(base.x < 0 ? map.size.x - 1 : base.x, next.x >= map.size.x ? 0 : next.x);
    columns = min(columns, map.size.x - 1);
    ivec2 rows = clamp(ivec2(base.y, next.y), 0, map.size.y - 1);
    vec3 above = mix(mapTexel(map, ivec2(columns.x, rows.x)).rgb, mapTexel(map, ivec2(columns.y, rows.x)).rgb, f.x);
    vec3 below = mix(mapTexel(map, ivec2(columns.x, rows.y)).rgb, mapTexel(map, ivec2(columns.y, rows.y)).rgb, f.x);
    return mix(above, below, f.y);
}

// Per solid angle, of the cell in which a direction lies.
float mapPdf(EnvironmentMap map, vec2 coordinates) {
    return mapTexel(map, min(ivec2(coordinates), map.size - 1)).w;
}

// The direction at a place in a cell. sin^2(theta/2) is uniform in solid angle, and taken from the nearer pole so that it
// keeps its digits there.
vec3 mapDirection(EnvironmentMap map, ivec2 cell, vec2 u) {
    bool south = 2 * cell.y >= map.size.y;
    float row = float(south ? map.size.y - cell.y : cell.y);
    float turnsARow = 0.25 / float(map.size.y); // of theta/2
    float edge = cosSinTurn(row * turnsARow).y;
    float otherEdge = cosSinTurn((row + (south ? -1.0 : 1.0)) * turnsARow).y;
    float s = mix(edge * edge, otherEdge * otherEdge, u.y);
    float column = (float(cell.x) + u.x) / float(map.size.x) - 0.5 - map.rotation;
    vec2 around = 2.0 * sqrt(s * (1.0 - s)) * cosSinTurn(column - floor(column));
    float y = 1.0 - 2.0 * s;
    return vec3(around.y, south ? -y : y, -around.x);
}

// By the block of random words of its own; `samples` are expected of the environment.
LightSample sampleEnvironmentMap(EnvironmentMap map, vec3 factor, float samples, uvec4 random) {
    uint bin = map.bits == 0u ? 0u : random.x >> (32u - map.bits);
    uvec2 entry = fetchTable(map.bins + bin).xy;
    uint chosen = random.y < entry.x ? bin : entry.y;
    ivec2 cell = ivec2(chosen % uint(map.size.x), chosen / uint(map.size.x));
    LightSample result;
    result.direction = mapDirection(map, cell, vec2(unitReal(random.z), unitReal(random.w)));
    result.way = result.direction;
    result.limit = kFarthest;
    result.pdf = samples * mapTexel(map, cell).w;
    result.emission = factor * mapRadiance(map, mapCoordinates(map, result.direction));
    result.delta = false;
    result.primitive = kNone;
    result.mapped = false;
    return result;
}

#endif

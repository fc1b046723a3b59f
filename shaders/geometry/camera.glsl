// Camera rays: pinhole or thin lens, perspective or orthographic, through a point of a pixel that its filter chooses.
#ifndef ISOLUX_GEOMETRY_CAMERA_GLSL
#define ISOLUX_GEOMETRY_CAMERA_GLSL

#include "core/scene_access.glsl"
#include "core/philox.glsl"
#include "geometry/ray.glsl"
#include "shared/path_records.h"

layout(constant_id = 20) const bool kThinLens = false;
layout(constant_id = 21) const bool kPixelFilter = false;

// Offset from the pixel's centre by the filter's quantiles, in pixels.
float filterOffset(uint tableOffset, float u) {
    float place = u * float(kFilterCells);
    uint cell = uint(place);
    vec4 cells = uintBitsToFloat(fetchTable(tableOffset + cell / 2u));
    vec2 ends = (cell & 1u) == 0u ? cells.xy : cells.zw;
    return ends.x + (ends.y - ends.x) * (place - float(cell));
}

vec2 offsetInPixel(uint tableOffset, vec2 u) {
    return kPixelFilter ? vec2(filterOffset(tableOffset, u.x), filterOffset(tableOffset, u.y)) : u - 0.5;
}

// `random`: words for the position in the pixel and on the lens.
Ray cameraRay(RenderParameters render, uvec2 pixel, uvec4 random) {
    // 2 (pixel + u) / size - 1, with the whole numbers apart: the sum keeps more of u's bits, all near the centre.
    vec2 whole = vec2(2 * ivec2(pixel) + 1 - ivec2(render.imageSeed.xy));
    vec2 within = 2.0 * offsetInPixel(render.tableOffsets.w, vec2(unitReal(random.x), unitReal(random.y)));
    vec2 position = (whole + within) / vec2(render.imageSeed.xy);
    vec3 across = position.x * render.cameraRight.xyz - position.y * render.cameraUp.xyz;
    bool orthographic = render.cameraPosition.w != 0.0;
    vec3 direction = render.cameraForward.xyz + (orthographic ? vec3(0.0) : across);
    float start = render.cameraForward.w;
    vec3 origin = render.cameraPosition.xyz + across * (orthographic ? 1.0 : start);
    if (kThinLens) {
        float radius;
        vec2 disk = concentricDisk(vec2(unitReal(random.z), unitReal(random.w)), radius) * render.methods.x;
        vec3 lens = disk.x * render.lensRight.xyz + disk.y * render.lensUp.xyz;
        origin += lens * (1.0 - start * render.methods.y);
        direction -= lens * render.methods.y;
    }
    return Ray(origin, orthographic && !kThinLens ? direction : normalize(direction));
}

#endif

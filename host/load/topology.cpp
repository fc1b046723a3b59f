#include "load/topology.h"

#include "load/model.h"

namespace isolux {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangle `i` of a mode (glTF 2.0, 3.7.2.1). A strip swaps two corners of every other one, to keep its winding.
Triangle triangle(int mode, std::span<const std::uint32_t> v, std::size_t i) {
    switch (mode) {
    case TINYGLTF_MODE_TRIANGLE_STRIP: return {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]};
    case TINYGLTF_MODE_TRIANGLE_FAN: return {v[i + 1], v[i + 2], v[0]};
    default: return {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
    }
}

bool repeatsIndex(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

} // namespace

bool isTriangleMode(int mode) {
    return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
           mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

std::size_t usedIndices(int mode, std::size_t indexCount) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return indexCount - indexCount % 3;
    return indexCount < 3 ? 0 : indexCount;
}

std::size_t mostTriangles(int mode, std::size_t indexCount) {
    const std::size_t used = usedIndices(mode, indexCount);
    if (mode == TINYGLTF_MODE_TRIANGLES) return used / 3;
    return used == 0 ? 0 : used - 2;
}

std::vector<Triangle> assembleTriangles(int mode, std::span<const std::uint32_t> indices) {
    const std::size_t count = mostTriangles(mode, indices.size());
    std::vector<Triangle> triangles;
    triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle next = triangle(mode, indices, i);
        if (mode == TINYGLTF_MODE_TRIANGLES || !repeatsIndex(next)) triangles.push_back(next);
    }
    return triangles;
}

} // namespace isolux

#include "load/vertices.h"

#include "load/context.h"

#include <fmt/format.h>

namespace isolux {
namespace {

template <int N> bool isFiniteVector(const glm::vec<N, float>& v) {
    for (int i = 0; i < N; ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

template <int N> std::string textOf(const glm::vec<N, float>& v) {
    std::string text;
    for (int i = 0; i < N; ++i) text += fmt::format("{}{}", i == 0 ? "" : ", ", v[i]);
    return text;
}

/// Unit, with a sign of 1 or -1; a tangent without length stays zero, and normal maps have no effect there.
glm::vec4 repaired(const glm::vec4& tangent) {
    const Vec3d direction(tangent);
    const double length = glm::length(direction);
    const Vec3f unit(length > 0.0 ? direction / length : Vec3d(0.0));
    return {unit, tangent.w < 0.0f ? -1.0f : 1.0f};
}

/// Unit; one without length stays zero, and the face's own normal takes its place.
Vec3f repaired(const Vec3f& normal) {
    const double length = glm::length(Vec3d(normal));
    return Vec3f(length > 0.0 ? Vec3d(normal) / length : Vec3d(0.0));
}

/// As far from unit as rounding to the coarsest type, bytes, can bring a direction: half a step of 1/127 in each
/// component.
bool isUnit(const Vec3d& v) {
    const double error = std::sqrt(3.0) / 254.0;
    return std::abs(glm::length(v) - 1.0) <= error;
}

/// The same attribute for the corners of every triangle in turn.
template <typename T> void splitCorners(std::vector<T>& attribute, const Mesh& mesh) {
    if (attribute.empty()) return;
    std::vector<T> corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) corners.push_back(attribute[vertex]);
    attribute = std::move(corners);
}

Vec3f flatNormal(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3d normal = glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
    const double length = glm::length(normal);
    return length > 0.0 ? Vec3f(normal / length) : Vec3f(0.0f);
}

} // namespace

std::uint64_t VertexAccessors::bytesPerVertex() const {
    std::uint64_t bytes = sizeof(Vec3f) + uvs.size() * sizeof(Vec2<float>);
    if (normal >= 0) bytes += sizeof(Vec3f);
    if (color >= 0) bytes += sizeof(glm::vec4);
    if (tangent >= 0) bytes += sizeof(glm::vec4);
    return bytes;
}

template <int N>
std::vector<glm::vec<N, float>> VertexReader::gather(int accessor, std::span<const std::uint32_t> vertices) const {
    const AccessorView view(asset_, static_cast<std::size_t>(accessor), context_);
    std::vector<glm::vec<N, float>> result;
    result.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices) {
        const glm::vec<N, float> value = result.emplace_back(view.read<N>(vertex));
        if (!isFiniteVector(value))
            context_.fail(fmt::format("/accessors/{}", accessor),
                          fmt::format("element {} is not finite ({})", vertex, textOf(value)));
    }
    return result;
}

std::vector<glm::vec4> VertexReader::readColors(int accessor, std::span<const std::uint32_t> vertices) const {
    const bool hasAlpha = asset_.model.accessors[static_cast<std::size_t>(accessor)].type == TINYGLTF_TYPE_VEC4;
    std::vector<glm::vec4> colors;
    if (hasAlpha)
        colors = gather<4>(accessor, vertices);
    else
        for (const Vec3f& color : gather<3>(accessor, vertices)) colors.emplace_back(color, 1.0f);
    bool areClamped = false;
    for (glm::vec4& color : colors) {
        const glm::vec4 clamped = glm::clamp(color, 0.0f, 1.0f);
        areClamped = areClamped || clamped != color;
        color = clamped;
    }
    if (areClamped) context_.warn(pointer_, "vertex colours beyond [0, 1] are clamped");
    return colors;
}

std::vector<glm::vec4> VertexReader::readTangents(int accessor, std::span<const std::uint32_t> vertices) const {
    std::vector<glm::vec4> tangents = gather<4>(accessor, vertices);
    bool areUnit = true;
    for (glm::vec4& tangent : tangents) {
        areUnit = areUnit && isUnit(Vec3d(tangent)) && std::abs(tangent.w) == 1.0f;
        tangent = repaired(tangent);
    }
    if (!areUnit) context_.warn(pointer_, "tangents that are not of length 1, or have no sign, are put right");
    return tangents;
}

/// Normals that are as near unit as their type allows stay as they are, to the last bit.
std::vector<Vec3f> VertexReader::readNormals(int accessor, std::span<const std::uint32_t> vertices) const {
    std::vector<Vec3f> normals = gather<3>(accessor, vertices);
    bool areUnit = true;
    for (Vec3f& normal : normals) {
        if (isUnit(Vec3d(normal))) continue;
        areUnit = false;
        normal = repaired(normal);
    }
    if (!areUnit)
        context_.warn(pointer_, "normals that are not of length 1 are put right; those of length 0 count as "
                                "none");
    return normals;
}

void VertexReader::read(const VertexAccessors& accessors, std::span<const std::uint32_t> vertices, Mesh& mesh) const {
    mesh.positions = gather<3>(accessors.position, vertices);
    if (accessors.normal >= 0) mesh.normals = readNormals(accessors.normal, vertices);
    if (accessors.tangent >= 0) mesh.tangents = readTangents(accessors.tangent, vertices);
    if (accessors.color >= 0) mesh.colors = readColors(accessors.color, vertices);
    for (const int uv : accessors.uvs) mesh.uvs.push_back(gather<2>(uv, vertices));
}

void makeFlat(Mesh& mesh) {
    splitCorners(mesh.positions, mesh);
    splitCorners(mesh.tangents, mesh);
    splitCorners(mesh.colors, mesh);
    for (auto& uvs : mesh.uvs) splitCorners(uvs, mesh);
    mesh.normals.clear();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto first = static_cast<std::uint32_t>(3 * i);
        mesh.triangles[i] = {first, first + 1, first + 2};
        const Vec3f normal = flatNormal(mesh.positions[first], mesh.positions[first + 1], mesh.positions[first + 2]);
        mesh.normals.insert(mesh.normals.end(), 3, normal);
    }
}

} // namespace isolux

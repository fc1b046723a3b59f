// Instances to world-space triangles: positions, geometric and shading normals, boxes.
#include "reference/world.h"

#include <cmath>
#include <utility>

namespace isolux {
namespace {

/// A float box that holds the double one however the numbers in it were rounded.
Box3f roundOutward(const Box3d& box) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Box3f rounded;
    for (int axis = 0; axis < 3; ++axis) {
        rounded.lower[axis] = std::nextafter(static_cast<float>(box.lower[axis]), -kInfinity);
        rounded.upper[axis] = std::nextafter(static_cast<float>(box.upper[axis]), kInfinity);
    }
    return rounded;
}

/// The inverse transpose up to a factor, as the matrix of cofactors: it exists for singular matrices too. Scaled to
/// entries near 1, since tiny or huge instances would leave the range of float.
Mat3d normalMatrix(const Mat3d& m) {
    const Mat3d cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) largest = std::max(largest, maxComponent(glm::abs(cofactors[column])));
    return largest > 0.0 ? cofactors / largest : Mat3d(0.0);
}

/// One mesh as one instance places it.
struct Placement {
    const Mesh& mesh;
    std::uint32_t object;
    Mat4d worldFromObject;
    Mat3d normalFromObject;
    bool mirrored; ///< the front is then the side seen clockwise (glTF 2.0, 3.7.4)

    Placement(const Scene& scene, const Instance& instance, std::uint32_t index)
        : mesh(scene.meshes[instance.mesh]), object(index), worldFromObject(instance.worldFromObject),
          normalFromObject(normalMatrix(Mat3d(instance.worldFromObject))),
          mirrored(glm::determinant(Mat3d(instance.worldFromObject)) < 0.0) {}

    [[nodiscard]] Vec3d position(std::uint32_t vertex) const {
        return Vec3d(worldFromObject * glm::dvec4(Vec3d(mesh.positions[vertex]), 1.0));
    }
    [[nodiscard]] Vec3d normal(std::uint32_t vertex) const {
        return mesh.normals.empty() ? Vec3d(0.0) : normalFromObject * Vec3d(mesh.normals[vertex]);
    }
};

/// a b - c d to within 1.5 ulp (Kahan; Jeannerod, Louvet and Muller 2013).
double differenceOfProducts(double a, double b, double c, double d) {
    const double product = c * d;
    const double error = std::fma(-c, d, product);
    return std::fma(a, b, -product) + error;
}

Vec3d accurateCross(const Vec3d& a, const Vec3d& b) {
    return {differenceOfProducts(a.y, b.z, a.z, b.y), differenceOfProducts(a.z, b.x, a.x, b.z),
            differenceOfProducts(a.x, b.y, a.y, b.x)};
}

/// Twice the area, along the normal. Of the two shorter edges: a sliver's long ones are nearly parallel, and a normal
/// that is wrong by more than rounding lets rays meet the triangle that they leave.
Vec3d areaVector(const std::array<Vec3d, 3>& p) {
    const std::array edges{p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (glm::dot(edges[i], edges[i]) > glm::dot(edges[longest], edges[longest])) longest = i;
    return accurateCross(edges[(longest + 1) % 3], edges[(longest + 2) % 3]);
}

template <typename Real>
void addTriangle(World<Real>& world, const Placement& placement, std::array<std::uint32_t, 3> vertices) {
    if (placement.mirrored) std::swap(vertices[1], vertices[2]);
    WorldTriangle<Real> triangle;
    triangle.material = placement.mesh.material;
    triangle.object = placement.object;
    triangle.vertices = vertices;
    std::array<Vec3d, 3> kept; // everything follows from the corners as they are kept, or rays would leak
    Box3d bounds;
    for (std::size_t i = 0; i < 3; ++i) {
        triangle.positions[i] = Vec3<Real>(placement.position(vertices[i]));
        triangle.normals[i] = Vec3<Real>(placement.normal(vertices[i]));
        kept[i] = Vec3d(triangle.positions[i]);
        bounds.extend(kept[i]);
    }
    const Vec3d cross = areaVector(kept);
    const double length = glm::length(cross);
    if (length > 0.0 && std::isfinite(length)) {
        triangle.ng = Vec3<Real>(cross / length);
        triangle.area = static_cast<Real>(length / 2);
    }
    world.triangles.push_back(triangle);
    world.boxes.push_back(roundOutward(bounds));
}

template <typename Real> void addSphere(World<Real>& world, const Sphere& sphere, std::uint32_t object) {
    world.spheres.push_back({Vec3<Real>(sphere.center), static_cast<Real>(sphere.radius), sphere.material, object});
    const Vec3d center(world.spheres.back().center);
    const Vec3d radius(static_cast<double>(world.spheres.back().radius));
    world.boxes.push_back(roundOutward({center - radius, center + radius}));
}

} // namespace

template <typename Real> World<Real> flatten(const Scene& scene) {
    World<Real> world;
    std::uint32_t object = 0;
    for (const Instance& instance : scene.instances) {
        const Placement placement(scene, instance, object++);
        world.instances.push_back(
            {Mat3<Real>(Mat3d(instance.worldFromObject)), placement.mirrored ? Real(-1) : Real(1)});
        for (const auto& triangle : placement.mesh.triangles) addTriangle(world, placement, triangle);
    }
    for (const Sphere& sphere : scene.spheres) addSphere(world, sphere, object++);
    return world;
}

template World<float> flatten(const Scene& scene);
template World<double> flatten(const Scene& scene);

} // namespace isolux

// Rays of every kind: what the BVH finds must be what testing every primitive finds, and no block may let one in.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include "core/philox.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace isolux {
namespace {

/// Random numbers, of one ray: a function of its number alone, as rays are asked for in pieces.
class Dice {
public:
    explicit Dice(std::uint64_t ray) : ray_{static_cast<std::uint32_t>(ray), static_cast<std::uint32_t>(ray >> 32)} {}

    std::uint32_t word() {
        if (used_ == block_.size()) {
            block_ = philox4x32({ray_[0], ray_[1], blocks_++, 0}, {42, 0});
            used_ = 0;
        }
        return block_[used_++];
    }
    /// In (0, 1): neither end, so that 2 unit() - 1 is never 0.
    double unit() { return unitReal<double>(word()) + 0x1p-25; }
    std::size_t index(std::size_t count) { return word() % count; }
    double sign() { return word() % 2 == 0 ? -1.0 : 1.0; }
    Vec3d inCube(double halfSide) {
        const double x = unit(), y = unit();
        return halfSide * (2.0 * Vec3d(x, y, unit()) - 1.0);
    }
    Vec3d direction() { return glm::normalize(inCube(1.0)); }

private:
    std::array<std::uint32_t, 2> ray_;
    PhiloxBlock block_{};
    std::uint32_t blocks_ = 0;
    std::size_t used_ = 4;
};

constexpr int kTriangles = 200;
constexpr int kSpheres = 40;
constexpr int kBlocks = 10;
const Vec3d kCenter(10.0, -3.0, 0.1);
constexpr double kHalfSide = 2.0;

/// Triangles and spheres of sizes from 1e-3 to 1, and blocks along the axes.
Scene soup() {
    Dice dice(0);
    const auto size = [&dice] { return std::pow(10.0, -3.0 * dice.unit()); };
    SceneBuilder builder;
    for (int i = 0; i < kBlocks; ++i) {
        const Vec3d halfSides = Vec3d(0.05) + glm::abs(dice.inCube(0.4));
        builder.mesh(blockMesh(0), translation(kCenter + dice.inCube(1.5)) * scaling(halfSides));
    }
    Mesh mesh;
    for (std::uint32_t i = 0; i < kTriangles; ++i) {
        const Vec3d middle = dice.inCube(1.5);
        const double halfSide = size();
        for (int corner = 0; corner < 3; ++corner) mesh.positions.emplace_back(middle + dice.inCube(halfSide));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    builder.mesh(mesh, translation(kCenter));
    for (int i = 0; i < kSpheres; ++i) {
        const Vec3d middle = kCenter + dice.inCube(1.5);
        builder.scene.spheres.push_back({"", middle, size(), 0});
    }
    return builder.scene;
}

/// What rays are aimed at.
struct Targets {
    std::vector<std::array<Vec3d, 3>> triangles; ///< those of blocks first
    std::vector<Sphere> spheres;

    const std::array<Vec3d, 3>& triangle(Dice& dice) const { return triangles[dice.index(triangles.size())]; }
    const std::array<Vec3d, 3>& face(Dice& dice) const { return triangles[dice.index(12 * kBlocks)]; }
};

Targets targetsOf(const Scene& scene) {
    Targets targets{{}, scene.spheres};
    for (const Instance& instance : scene.instances)
        for (const auto& [a, b, c] : scene.meshes[instance.mesh].triangles) {
            const auto& positions = scene.meshes[instance.mesh].positions;
            const Mat4d& pose = instance.worldFromObject;
            targets.triangles.push_back({transformPoint(pose, positions[a]), transformPoint(pose, positions[b]),
                                         transformPoint(pose, positions[c])});
        }
    return targets;
}

/// In the plane of the triangle, and often on it.
Vec3d pointNear(const std::array<Vec3d, 3>& triangle, Dice& dice) {
    const double u = dice.unit();
    return triangle[0] + u * (triangle[1] - triangle[0]) + dice.unit() * (1.0 - u) * (triangle[2] - triangle[0]);
}

Vec3d normalOf(const std::array<Vec3d, 3>& triangle) {
    return glm::normalize(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
}

/// One or two components as small as asked for, of either sign; half of the rays run at the height of a corner.
AimedRay smallComponents(const Targets& targets, Dice& dice, double size) {
    AimedRay ray{kCenter + dice.inCube(1.25 * kHalfSide), dice.direction()};
    const Vec3d corner = targets.triangle(dice)[dice.index(3)];
    const int first = static_cast<int>(dice.index(3)), count = 1 + static_cast<int>(dice.index(2));
    const std::size_t aimed = dice.index(2);
    for (int i = 0; i < count; ++i) {
        const int axis = (first + i) % 3;
        ray.direction[axis] = dice.sign() * size;
        if (aimed == 1) ray.origin[axis] = corner[axis];
    }
    return ray;
}

/// Almost in the plane of a triangle, from before it.
AimedRay inPlane(const Targets& targets, Dice& dice, double tilt) {
    const auto& triangle = targets.triangle(dice);
    const Vec3d point = pointNear(triangle, dice);
    const Vec3d along = glm::normalize(pointNear(triangle, dice) - point);
    const double distance = kHalfSide * dice.unit();
    return {point - distance * along, along + dice.sign() * tilt * normalOf(triangle)};
}

/// Along an axis or across it, beside a face of a block.
AimedRay besideFace(const Targets& targets, Dice& dice, double distance) {
    const auto& face = targets.face(dice);
    const Vec3d normal = normalOf(face);
    const int axis = std::abs(normal.x) > 0.5 ? 0 : std::abs(normal.y) > 0.5 ? 1 : 2;
    AimedRay ray{kCenter + dice.inCube(1.25 * kHalfSide), dice.direction()};
    ray.origin[axis] = face[0][axis] + dice.sign() * distance;
    ray.direction[axis] = dice.sign() * 0.0;
    if (dice.index(2) == 0) ray.direction[(axis + 1) % 3] = dice.sign() * 0.0;
    return ray;
}

AimedRay fromSurface(const Targets& targets, Dice& dice, double distance) {
    const Vec3d direction = dice.direction();
    if (dice.index(4) > 0) {
        const auto& triangle = targets.triangle(dice);
        return {pointNear(triangle, dice) + dice.sign() * distance * normalOf(triangle), direction};
    }
    const Sphere& sphere = targets.spheres[dice.index(targets.spheres.size())];
    const double radius = sphere.radius + dice.sign() * distance;
    return {sphere.center + radius * dice.direction(), direction};
}

AimedRay ofLength(const Targets& targets, Dice& dice, double length) {
    const Vec3d origin = kCenter + dice.inCube(1.25 * kHalfSide);
    const Vec3d target = dice.index(2) == 0 ? targets.triangle(dice)[0] : kCenter + dice.inCube(kHalfSide);
    return {origin, length * glm::normalize(target - origin)};
}

AimedRay fromAfar(const Targets& targets, Dice& dice, double distance) {
    const Vec3d origin = kCenter + (kHalfSide * distance) * dice.direction();
    return {origin, glm::normalize(pointNear(targets.triangle(dice), dice) - origin)};
}

using MakeRay = AimedRay (*)(const Targets&, Dice&, double);

RayTrial raysAt(MakeRay makeRay, double parameter, std::uint64_t count) {
    RayTrial trial;
    trial.scene = soup();
    trial.count = count;
    trial.check = RayCheck::bruteForce;
    trial.make = [makeRay, parameter, targets = targetsOf(trial.scene)](std::uint64_t first, std::size_t number) {
        std::vector<AimedRay> rays;
        rays.reserve(number);
        for (std::uint64_t i = first; i < first + number; ++i) {
            Dice dice(i);
            rays.push_back(makeRay(targets, dice, parameter));
        }
        return rays;
    };
    return trial;
}

/// Zero is shown a decade before the smallest parameter, as the axis is logarithmic.
PlannedSweep against(const StressSweep& about, Extent extent, MakeRay makeRay, const std::vector<double>& parameters) {
    std::vector<PlannedStep> steps;
    double shown = 1.0;
    const std::uint64_t count = extent == Extent::quick ? 10'000 : 100'000;
    for (const double parameter : parameters) {
        shown = parameter == 0.0 ? 0.1 * shown : parameter;
        steps.push_back({shown, fmt::format("{:g}", parameter),
                         trialOf([makeRay, parameter, count] { return raysAt(makeRay, parameter, count); })});
    }
    return {about, thinned(std::move(steps), extent)};
}

const std::vector<double> kDownToZero{0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 0.0};

PlannedSweep componentSweep(Extent extent) {
    const StressSweep about{
        .name = "components",
        .title = "Rays with small components of either sign among triangles, spheres and blocks",
        .axisTitle = "size of one or two components",
        .limit =
            "None: for boxes a component below 2^-100 counts as 2^-100, so that no quotient is infinite and none times "
            "0; a "
            "ray moves across by less than a last bit of any coordinate either way. Denormal numbers may count as 0."};
    return against(about, extent, smallComponents, {1e-2, 1e-5, 1e-7, 1e-10, 1e-20, 1e-30, 1e-38, 1e-41, 1e-44, 0.0});
}

PlannedSweep planeSweep(Extent extent) {
    const StressSweep about{.name = "plane",
                            .title = "Rays almost in the plane of a triangle",
                            .axisTitle = "tilt, rad",
                            .limit =
                                "None: rounding may let a ray that runs in a triangle's plane meet it or pass it by, "
                                "but boxes reach further than "
                                "that, 16 u (u = 2^-24) of the distances where the test of triangles errs by 8 u."};
    return against(about, extent, inPlane, kDownToZero);
}

PlannedSweep faceSweep(Extent extent) {
    const StressSweep about{
        .name = "faces",
        .title = "Rays along faces of blocks",
        .axisTitle = "distance from the face",
        .limit = "None: boxes of blocks are those of the BVH's nodes, whose planes lie 16 u (u = 2^-24) further "
                 "out. A ray in the plane itself meets the edge of a face or nothing."};
    return against(about, extent, besideFace, kDownToZero);
}

PlannedSweep surfaceSweep(Extent extent) {
    const StressSweep about{
        .name = "surfaces",
        .title = "Rays that start at triangles and spheres",
        .axisTitle = "distance from the surface",
        .limit = "None: whatever side of a surface rounding puts the start on, both searches see the same bits. That "
                 "paths leave surfaces well is for other sweeps to show."};
    return against(about, extent, fromSurface, kDownToZero);
}

PlannedSweep lengthSweep(Extent extent) {
    const std::vector<double> all{1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12, 1e15};
    const StressSweep about{
        .name = "length",
        .title = "Directions of any length",
        .axisTitle = "length",
        .limit =
            "Spheres square it: its square times that of their radius, 1e-3 of the scene or less, must keep 24 bits "
            "above "
            "2^-126, or rays that narrowly miss a sphere meet it. The last bits go below 1e-12, all of them at 1e-15. "
            "Renders use unit vectors."};
    return against(about, extent, ofLength, extent == Extent::quick ? std::vector{1e-12, 1.0, 1e12} : all);
}

PlannedSweep afarSweep(Extent extent) {
    const StressSweep about{
        .name = "afar",
        .title = "Rays from far away",
        .axisTitle = "distance in half sizes of the scene",
        .limit = "None: at a distance D corners are seen with an error of 8 u D, u = 2^-24, and boxes are met 16 u D "
                 "further out. The "
                 "hits themselves are wrong by u D, of which images are spared: rays of cameras start at the scene."};
    return against(about, extent, fromAfar, {1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8});
}

/// Blocks seen straight from before, about an edge of the middle one that runs along the rays: in the end all rays that
/// single precision can tell apart run along its faces. Who gets into a block does not get out.
RenderTrial edgeOn(double halfHeight) {
    SceneBuilder builder;
    builder.scene.environment.radiance = Vec3d(1.0);
    for (int column = -1; column <= 1; ++column)
        for (int row = -1; row <= 1; ++row)
            builder.mesh(blockMesh(0),
                         translation({0.75 * column, 0.75 * row, 0.125 * (column - row)}) * scaling(Vec3d(0.25)));
    parallelCamera(builder, {0.25, 0.25, 5.0}, {0.25, 0.25, 0.0}, halfHeight);
    RenderTrial trial = expecting(1.0, builder.scene, scatteringAlone(64));
    trial.probe = Probe{1.0, 1.0, Symptom::leak};
    return trial;
}

PlannedSweep edgeSweep(Extent extent) {
    const StressSweep about{
        .name = "edge on",
        .title =
            "A parallel view along an edge of a white block in a white world: rays that get into blocks are counted",
        .axisTitle = "half height of the view",
        .limit = "None: below 2^-25 of the scene rays run along the faces exactly. A face seen edge-on is not met, and "
                 "the one "
                 "before it counts its edge as inside, so rays meet that or nothing."};
    return {about, thinned(stepsBy({0, -8, -1}, edgeOn), extent)};
}

} // namespace

std::vector<PlannedSweep> raySweeps(Extent extent) {
    return {componentSweep(extent), planeSweep(extent), faceSweep(extent), surfaceSweep(extent),
            lengthSweep(extent),    afarSweep(extent),  edgeSweep(extent)};
}

} // namespace isolux

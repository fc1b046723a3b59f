// Scenes far from the origin, and cameras far from scenes.
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace isolux {
namespace {

constexpr double kEdge = 2.0; // of the box: distances count in sizes of the scene
constexpr const char* kFromOrigin = "distance from the origin in sizes of the scene";

RenderTrial boxAt(const Vec3d& offset) {
    RenderTrial trial;
    trial.scene = moved(cornellBox(), offset);
    trial.settings = stressSettings(32, 16);
    return trial;
}

/// No coordinate is a short binary number.
RenderTrial alongDiagonal(double sizes) { return boxAt(glm::normalize(Vec3d(1.0, 1.01, 0.99)) * (sizes * kEdge)); }

RenderTrial alongAxis(double sizes) { return boxAt({sizes * kEdge, 0.0, 0.0}); }

/// Every corner, centre and radius is a multiple of 1/64, so that a move by a power of two rounds nothing.
Scene dyadicRoom() {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material({0.75, 0.5, 0.625}, Vec3d(0.0), Faces::front);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(8.0), Faces::front);
    builder.mesh(roomMesh(grey));
    builder.mesh(blockMesh(grey), translation({-0.375, -0.6875, -0.25}) * scaling(Vec3d(0.25)));
    builder.mesh(blockMesh(lamp), translation({0.25, 0.875, 0.125}) * scaling({0.25, 1.0 / 64.0, 0.25}));
    builder.scene.spheres = {{"", {0.5, -0.5, 0.125}, 0.25, grey}};
    builder.camera({0.75, 0.25, 0.875}, {-0.25, -0.25, -0.5}, 1.2);
    return builder.scene;
}

RenderTrial exactlyMoved(int exponent) {
    const double distance = kEdge * std::exp2(exponent);
    RenderTrial trial;
    trial.scene = moved(dyadicRoom(), Vec3d(1.0, -0.5, 0.25) * distance);
    trial.settings = stressSettings(32, 16);
    trial.sameBitsAs = std::make_shared<const Scene>(dyadicRoom());
    return trial;
}

/// The box fills the image from any distance.
RenderTrial telephoto(double sizes) {
    SceneBuilder builder;
    builder.scene = cornellBox();
    builder.scene.cameras.clear();
    const double distance = sizes * kEdge;
    builder.camera(glm::normalize(Vec3d(0.1, 0.07, 1.0)) * distance, Vec3d(0.0), 2.0 * std::atan(1.1 / distance));
    RenderTrial trial;
    trial.scene = builder.scene;
    trial.settings = stressSettings(32, 16);
    return trial;
}

PlannedSweep overDecades(const StressSweep& about, Extent extent, const TrialAt& trialAt) {
    return {about, thinned(stepsBy({0, 8}, trialAt), extent)};
}

PlannedSweep diagonalSweep(Extent extent) {
    const StressSweep about{
        .name = "diagonal",
        .title = "A Cornell box away from the origin, along no axis",
        .axisTitle = kFromOrigin,
        .limit =
            "At D sizes from the origin double knows a corner to 2^-53 D of the box, and single precision, once the "
            "scene "
            "was moved to the origin in double, to 2^-24: up to D = 2^29 = 5e8 the distance costs less than single "
            "precision does. Without the move the error is 2^-24 D: 0.1 % of the box at 1e4, all of it at 2e7."};
    return overDecades(about, extent, alongDiagonal);
}

PlannedSweep axisSweep(Extent extent) {
    const StressSweep about{.name = "axis",
                            .title = "A Cornell box away from the origin, along x",
                            .axisTitle = kFromOrigin,
                            .limit = "As along the diagonal, in one coordinate alone. Without the move walls across "
                                     "the axis merge where 2^-24 D "
                                     "reaches the distance between them."};
    return overDecades(about, extent, alongAxis);
}

PlannedSweep exactMovesSweep(Extent extent) {
    const StressSweep about{
        .name = "exact moves",
        .title = "A room of short binary numbers moved by a power of two: the same image to the last bit",
        .axisTitle = kFromOrigin,
        .limit =
            "Nothing is rounded: at a distance of 2^k corners of 6 binary places need k + 8 of double's 53 bits, and "
            "the "
            "move back is exact. Bits would stay to 2^45; the double reference, which leaves the scene where it is, "
            "ends before."};
    std::vector<PlannedStep> steps;
    for (const int exponent : {0, 6, 12, 18, 24, 27, 30})
        steps.push_back({std::exp2(exponent), fmt::format("2^{}", exponent),
                         trialOf([exponent] { return exactlyMoved(exponent); })});
    return {about, thinned(std::move(steps), extent)};
}

PlannedSweep telephotoSweep(Extent extent) {
    const StressSweep about{
        .name = "telephoto",
        .title = "A camera away from a Cornell box that fills its image",
        .axisTitle = "distance of the camera in sizes of the box",
        .limit =
            "A direction's rounding, 2^-24, is 2^-24 D of the box at D sizes. But rays start on a plane before the "
            "scene, "
            "where a point across the image is known to 2^-24 of its size, and a direction errs by 2^-24 of the box's "
            "depth. Double's 2^-53 D, in the reference, comes up to that at 5e8."};
    return overDecades(about, extent, telephoto);
}

} // namespace

std::vector<PlannedSweep> distanceSweeps(Extent extent) {
    return {diagonalSweep(extent), axisSweep(extent), exactMovesSweep(extent), telephotoSweep(extent)};
}

} // namespace isolux

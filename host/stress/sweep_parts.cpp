#include "stress/sweep_parts.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <string>
#include <utility>

namespace isolux {

std::vector<PlannedStep> stepsBy(const Decades& decades, const TrialAt& trialAt) {
    std::vector<PlannedStep> steps;
    const int count = (decades.last - decades.first) / decades.stride + 1;
    for (int i = 0; i < count; ++i) {
        const int exponent = decades.first + i * decades.stride;
        const std::string label = exponent == 0 ? "1" : fmt::format("1e{}", exponent);
        const double parameter = std::stod(label); // the nearest number, which pow need not find
        steps.push_back({parameter, label, trialOf([trialAt, parameter] { return trialAt(parameter); })});
    }
    return steps;
}

std::vector<PlannedStep> stepsAt(const std::vector<double>& parameters, const TrialAt& trialAt) {
    std::vector<PlannedStep> steps;
    steps.reserve(parameters.size());
    for (const double parameter : parameters)
        steps.push_back({parameter, fmt::format("{:g}", parameter), trialOf([=] { return trialAt(parameter); })});
    return steps;
}

std::vector<PlannedStep> thinned(std::vector<PlannedStep> steps, Extent extent) {
    if (extent == Extent::full || steps.size() <= 3) return steps;
    return {steps.front(), steps[steps.size() / 2], steps.back()};
}

Mat4d askew() { return glm::rotate(Mat4d(1.0), 0.7, glm::normalize(Vec3d(1.0, 2.0, 3.0))); }

Vec3d placed(const Mat4d& pose, const Vec3d& point) { return Vec3d(pose * glm::dvec4(point, 1.0)); }

void parallelCamera(SceneBuilder& builder, const Vec3d& position, const Vec3d& target, double halfHeight) {
    constexpr double kUnused = 1.0; // a field of view
    builder.camera(position, target, kUnused);
    builder.scene.cameras.back().projection = Projection::orthographic;
    builder.scene.cameras.back().ymag = halfHeight;
}

RenderSettings directLight() {
    RenderSettings settings = stressSettings(32, 16);
    settings.maxDepth = 1;
    return settings;
}

RenderSettings scatteringAlone(std::uint32_t maxDepth) {
    RenderSettings settings = stressSettings(32, 16);
    settings.maxDepth = maxDepth;
    settings.lightSampling = LightSampling::bsdf;
    settings.roulette.kind = Roulette::off;
    return settings;
}

RenderTrial expecting(double mean, Scene scene, const RenderSettings& settings) {
    RenderTrial trial;
    trial.scene = std::move(scene);
    trial.settings = settings;
    trial.expected = mean;
    return trial;
}

double meanOverSquare(double halfSize, int cells, const std::function<double(double, double)>& f) {
    const auto middle = [&](int cell) { return halfSize * ((2.0 * cell + 1.0) / cells - 1.0); };
    double sum = 0.0;
    for (int row = 0; row < cells; ++row)
        for (int column = 0; column < cells; ++column) sum += f(middle(column), middle(row));
    return sum / cells / cells;
}

} // namespace isolux

// What `converge` leaves in its folder: figures, pictures that took equal time, and the report.
#pragma once

#include "app/converge_options.h"
#include "app/converge_reference.h"
#include "app/converge_run.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// The picture a variant makes in the time that all are given.
struct EqualTimeImage {
    std::string name; ///< of the variant
    std::string image;
    std::string flip; ///< its map
    double samplesPerPixel = 0.0;
    double seconds = 0.0;
    double relativeRmse = 0.0;
    double flipMean = 0.0;
};

struct EqualTimeImages {
    std::string reference;
    double seconds = 0.0;
    std::vector<EqualTimeImage> variants;
};

/// Renders the first seed of each variant for as long as the quickest of them took for a whole one, and writes the
/// images and where FLIP sees them differ from the reference. Nothing more once it is interrupted.
[[nodiscard]] EqualTimeImages writeImages(const std::filesystem::path& folder,
                                          const std::vector<MeasuredVariant>& variants, const ConvergeLimits& limits,
                                          const ErrorMeter& meter, ProgressBar& bar);

/// The names of files that stand for variants, without extension: letters, digits and `._-`, all different.
[[nodiscard]] std::vector<std::string> fileNames(const std::vector<std::string>& variants);

/// What a run was of, and on what.
struct ConvergeScene {
    const ConvergeOptions& options;
    const SceneRun& run;
    const Device* device = nullptr; ///< null: the processor rendered
    const References& references;
};

/// The parts of convergence.json that are not the report's, for a run and for statistics alone.
[[nodiscard]] nlohmann::ordered_json describeScene(const ConvergeScene& scene, const Diagnostics& diagnostics,
                                                   const std::vector<ErrorSample>& samples,
                                                   const ConvergenceReport& report);
[[nodiscard]] nlohmann::ordered_json describeFit(const ConvergeOptions& options,
                                                 const std::vector<ErrorSample>& samples);

/// Writes convergence.json: `description` with the report and the images in it.
void writeReport(const std::filesystem::path& folder, nlohmann::ordered_json description,
                 const ConvergenceReport& report, const std::optional<EqualTimeImages>& images);

} // namespace isolux

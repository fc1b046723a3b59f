#include "app/output.h"

#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"
#include "scene/camera_matrices.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <optional>

namespace isolux {
namespace {

constexpr const char* kMeanSamples = "isolux/sampleMean";

/// The options that decide the image, beside the seed and the samples that have entries of their own.
std::string optionsText(const SceneRun& run, const RunReport& report) {
    std::string text = fmt::format("--backend {} --size {}x{} --camera {}", report.backend, report.width, report.height,
                                   run.settings.camera);
    text += run.environment.options;
    if (report.maxDepth) text += fmt::format(" --max-depth {}", *report.maxDepth);
    for (const MethodChoice& method : report.methods) text += fmt::format(" --{} {}", method.option, method.value);
    if (report.timeLimit) text += fmt::format(" --time {}", *report.timeLimit);
    if (report.errorTarget) text += fmt::format(" --until-error {}", *report.errorTarget);
    if (!report.adaptive) return text;
    const AdaptiveRule& rule = report.adaptive->rule;
    return text + fmt::format(" --adaptive {} --adaptive-batch {} --adaptive-min {} --spp {}", rule.tolerance,
                              rule.batch, rule.minSamples, report.adaptive->maximum);
}

Metadata metadataOf(const SceneRun& run, const RunReport& report) {
    const Camera& camera = run.scene.cameras[run.settings.camera];
    const double aspect = static_cast<double>(run.settings.width) / static_cast<double>(run.settings.height);
    Metadata metadata{{"worldToCamera", matrixMetadata(cameraFromWorld(camera))},
                      {"worldToNDC", matrixMetadata(ndcFromWorld(camera, aspect))},
                      {"samplesPerPixel", unsignedMetadata(report.samplesPerPixel)},
                      {"renderTimeSeconds", report.timings.render},
                      {"isolux/version", std::string(ISOLUX_VERSION)},
                      {"isolux/seed", unsignedMetadata(report.seed)},
                      {"isolux/sampleFirst", unsignedMetadata(report.firstSample)},
                      {"isolux/sampleCount", unsignedMetadata(report.samplesPerPixel)},
                      {"isolux/sceneHash", report.sceneHash},
                      {"isolux/device", report.deviceName},
                      {"isolux/driver", fmt::format("{} {}", report.driverName, report.driverVersion)},
                      {"isolux/options", optionsText(run, report)}};
    if (report.adaptive) metadata[kMeanSamples] = report.adaptive->mean;
    return metadata;
}

/// Of an image whose pixels stop by their error, which makes the least and the most say little.
std::optional<double> meanSamples(const Metadata& metadata) {
    const auto mean = metadata.find(kMeanSamples);
    if (mean == metadata.end() || !std::holds_alternative<double>(mean->second)) return std::nullopt;
    return std::get<double>(mean->second);
}

/// Samples a pixel that an image says it holds.
std::optional<double> samplesHeld(const Metadata& metadata) {
    if (const std::optional<double> mean = meanSamples(metadata)) return mean;
    const auto count = metadataUnsigned(metadata, "isolux/sampleCount");
    if (!count) return std::nullopt;
    return static_cast<double>(*count);
}

/// Samples a pixel that count when a render which is not whole is held against a file.
double samplesFinished(const Film& film, const Metadata& metadata) {
    return meanSamples(metadata).value_or(static_cast<double>(film.minSampleCount()));
}

/// Whether the file at `path` may hold more samples than `samples`: it says so, or says nothing of samples.
bool mayHoldMore(const std::filesystem::path& path, double samples) {
    std::error_code error;
    if (!std::filesystem::exists(path, error) && !error) return false;
    try {
        const std::optional<double> held = samplesHeld(readImage(path).metadata);
        return !held || *held > samples;
    } catch (const std::exception&) {
        return true; // not an image of ours, or not to be read: not ours to replace half-done
    }
}

std::filesystem::path partialName(const std::filesystem::path& path) {
    return path.parent_path() / (path.stem().string() + ".partial" + path.extension().string());
}

/// Names by FirstHit::object: the instances, then the spheres.
ObjectNames namesOf(const Scene& scene) {
    ObjectNames names;
    const auto add = [&](const std::string& name, std::uint32_t material) {
        names.objects.push_back(name);
        names.materials.push_back(scene.materials[material].name);
    };
    for (const Instance& instance : scene.instances) add(instance.name, scene.meshes[instance.mesh].material);
    for (const Sphere& sphere : scene.spheres) add(sphere.name, sphere.material);
    return names;
}

std::string_view whatStopped(Completion completion) {
    return completion == Completion::failed ? "stopped by the error" : "interrupted";
}

/// Says what a render that is not whole left. After a failure even to those who want to read errors alone: it may have
/// gone to another name than the one they gave.
void tellWhatIsKept(const std::filesystem::path& path, const Film& film, Completion completion) {
    const std::uint64_t least = film.minSampleCount();
    const std::uint64_t most = film.maxSampleCount();
    const std::string count = least == most ? fmt::format("{}", most) : fmt::format("{} to {}", least, most);
    const std::string text = fmt::format("{}: {} sample{} a pixel {} in {}", whatStopped(completion), count,
                                         most == 1 ? "" : "s", most == 1 ? "is" : "are", path.string());
    if (completion == Completion::failed)
        fmt::print(stderr, "isolux: {}\n", text); // below its error, of which it is a part
    else
        spdlog::warn("{}", text);
}

/// One file. Throws Error if a render that is not whole finds a better one under both of its names.
void writeOutput(const std::filesystem::path& path, const Image& image, const DisplayTransform& display,
                 const Film& film, Completion completion) {
    if (completion == Completion::whole) {
        writeImage(path, image, display);
        return;
    }
    const double samples = samplesFinished(film, image.metadata);
    const std::filesystem::path target = mayHoldMore(path, samples) ? partialName(path) : path;
    if (target != path && mayHoldMore(target, samples))
        throwFailure(path.string(), fmt::format("{}, and {} may hold more samples: nothing was written",
                                                whatStopped(completion), target.string()));
    writeImage(target, image, display);
    tellWhatIsKept(target, film, completion);
}

} // namespace

void writeOutputs(const OutputRequest& request, const Film& film, const SceneRun& run, const RunReport& report,
                  Completion completion) {
    const Image image = imageFromFilm(film, request.layers, namesOf(run.scene), metadataOf(run, report));
    std::optional<Error> first;
    for (const std::filesystem::path path : request.paths) {
        try {
            writeOutput(path, image, request.display, film, completion);
        } catch (const Error& error) {
            if (first)
                spdlog::error("{}", error.what());
            else
                first = error; // the other files are worth writing all the same
        }
    }
    if (first) throw Error(*first);
}

void checkTextPath(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) throwBadInput(path, "is a folder");
    if (!std::filesystem::is_directory(folder, ignored)) throwBadInput(path, "its folder does not exist");
}

void makeFolder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!isWritableFolder(folder)) throwBadInput(folder, "cannot be made, or nothing can be written there");
}

void writeText(const std::string& path, const std::string& text) {
    const std::string temporary = fmt::format("{}.{}.tmp", path, processId());
    {
        std::ofstream file(temporary, std::ios::binary);
        file << text;
        if (!file.flush()) {
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            throwFailure(path, "cannot write");
        }
    }
    replaceFile(temporary, path);
}

} // namespace isolux

#include "report/explain.h"

#include <fmt/format.h>

namespace isolux {
namespace {

std::string nonFiniteText(const ImageSymptoms& symptoms) {
    std::string text = fmt::format("{} samples were NaN or infinite", symptoms.diagnostics.nonFiniteSamples);
    if (symptoms.nonFinitePixels != 0) {
        text += fmt::format(", in {} pixels ({:.3g} %)", symptoms.nonFinitePixels,
                            100.0 * static_cast<double>(symptoms.nonFinitePixels) /
                                static_cast<double>(symptoms.pixelCount));
    }
    if (symptoms.firstNonFinite)
        text += fmt::format(", first at pixel ({}, {})", symptoms.firstNonFinite->x, symptoms.firstNonFinite->y);
    return text + "; look for extreme values in the scene, and try --backend reference, which computes in double";
}

void explainFaults(std::vector<std::string>& lines, const ImageSymptoms& symptoms) {
    const Diagnostics& diagnostics = symptoms.diagnostics;
    if (diagnostics.nonFiniteSamples + symptoms.nonFinitePixels != 0) lines.push_back(nonFiniteText(symptoms));
    if (diagnostics.negativeSamples != 0) {
        lines.push_back(fmt::format("{} samples were negative; look for negative colours in the scene",
                                    diagnostics.negativeSamples));
    }
    if (diagnostics.stackOverflows + diagnostics.invalidIndices != 0) {
        lines.push_back(fmt::format("surfaces may be missing: {} traversal stack overflows and {} invalid indices; try "
                                    "another --device, or --backend reference",
                                    diagnostics.stackOverflows, diagnostics.invalidIndices));
    }
}

/// Why no camera ray met anything, if none did.
std::optional<std::string> explainView(const ImageSymptoms& symptoms) {
    if (symptoms.surfaceCount == 0) return "the scene has no surface; check that the file holds meshes and a scene";
    if (symptoms.sceneSide == SceneSide::behind)
        return "the camera looks away from everything: the scene lies behind it; turn it, or choose another camera";
    if (symptoms.hitShare == 0.0)
        return "no camera ray met anything: the scene lies beside the image; turn the camera or widen its view";
    return std::nullopt;
}

/// Why what the camera sees is dark, where lights and surfaces are in their places.
std::string explainDarkness(const ImageSymptoms& symptoms) {
    if (symptoms.maxDepth == 0u)
        return "--max-depth 0 shows emitted light alone, and no emitter is in view; use --max-depth 1 or more";
    if (symptoms.maxDepth == 1u)
        return "--max-depth 1 shows direct light alone, and none reaches what the camera sees; use --max-depth 2 or "
               "more";
    return "no light reaches what the camera sees: emitters shine from their front only unless their material is "
           "doubleSided, and closed walls keep light out; turn or open them, or take more --spp";
}

void explainBlack(std::vector<std::string>& lines, const ImageSymptoms& symptoms) {
    const std::size_t before = lines.size();
    const auto add = [&](const std::string& cause) { lines.push_back("the image is black: " + cause); };
    if (symptoms.lightCount == 0) add("the scene has no light; add one, or --environment 1,1,1");
    if (const auto view = explainView(symptoms)) add(*view);
    if (symptoms.cameraPlace == CameraPlace::insideSolid)
        add("every path ends inside a solid: the camera lies inside a closed object; move it out, or open the object");
    if (lines.size() == before) add(explainDarkness(symptoms));
}

bool finite(const PixelStatistics& pixel) { return isFinite(pixel.mean); }

} // namespace

ImageSymptoms symptomsOf(const Film& film) {
    ImageSymptoms symptoms;
    symptoms.pixelCount = film.pixels.size();
    symptoms.diagnostics = film.diagnostics;
    double luminanceSum = 0.0;
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelStatistics& pixel = film.pixels[i];
        luminanceSum += luminance(pixel.mean);
        symptoms.sampleCount += pixel.sampleCount;
        hits += pixel.hitCount;
        if (finite(pixel)) continue;
        if (symptoms.nonFinitePixels++ == 0) {
            symptoms.firstNonFinite =
                PixelPosition{static_cast<std::uint32_t>(i % film.width), static_cast<std::uint32_t>(i / film.width)};
        }
    }
    symptoms.meanLuminance = luminanceSum / static_cast<double>(film.pixels.size());
    if (symptoms.sampleCount != 0)
        symptoms.hitShare = static_cast<double>(hits) / static_cast<double>(symptoms.sampleCount);
    return symptoms;
}

std::vector<std::string> explainImage(const ImageSymptoms& symptoms) {
    std::vector<std::string> lines;
    if (symptoms.sampleCount == 0) return lines;
    explainFaults(lines, symptoms);
    if (symptoms.meanLuminance == 0.0) explainBlack(lines, symptoms);
    return lines;
}

} // namespace isolux

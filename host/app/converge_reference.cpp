#include "app/converge_reference.h"

#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"

#include <fmt/format.h>

namespace isolux {
namespace {

Image readReference(const std::string& file, const SceneRun& run) {
    Image image = readImage(file);
    if (image.width != run.settings.width || image.height != run.settings.height)
        throwBadInput(file, fmt::format("the reference has {} x {} pixels, what is rendered {} x {}", image.width,
                                        image.height, run.settings.width, run.settings.height));
    const std::optional<std::string> hash = metadataText(image.metadata, "isolux/sceneHash");
    if (hash && *hash != run.scene.contentHash)
        spdlog::warn("{}: the reference shows another scene, by its hash ({}, not {})", file, *hash,
                     run.scene.contentHash);
    return image;
}

Metadata metadataOf(const SceneRun& run, const ReferenceRequest& request, std::uint64_t seed) {
    Metadata metadata{{"isolux/version", std::string(ISOLUX_VERSION)},
                      {"isolux/seed", unsignedMetadata(seed)},
                      {"isolux/sceneHash", run.scene.contentHash}};
    if (request.device != nullptr) metadata["isolux/device"] = request.device->description().name;
    return metadata;
}

/// Nothing if it was interrupted.
std::optional<Image> renderReference(SeedRenderer& renderer, const SceneRun& run, const ReferenceRequest& request,
                                     std::uint32_t index) {
    const std::uint64_t seed = kFirstReferenceSeed + index;
    ProgressBar bar(fmt::format("reference {} of 2", index + 1), request.display);
    const Film film = renderer.render({seed, request.samples, {}}, {}, bar.callback());
    if (film.minSampleCount() < request.samples) return std::nullopt;
    if (!film.diagnostics.clean()) throwFailure("reference", "it has faulty samples; `isolux render` says which");
    return imageFromFilm(film, metadataOf(run, request, seed));
}

void announce(const ReferenceRequest& request, const ReferenceCache& cache) {
    spdlog::info("rendering two references of {} samples a pixel{}", request.samples,
                 cache.path(0).empty() ? ", not kept" : "");
}

} // namespace

References readReferences(const std::vector<std::string>& files, const SceneRun& run) {
    References references;
    references.files = files;
    Image first = readReference(files.front(), run);
    if (files.size() == 1) {
        references.method = "variance subtracted";
        references.meter.emplace(std::move(first));
        return references;
    }
    references.method = "two independent";
    references.meter.emplace(std::move(first), readReference(files.back(), run));
    return references;
}

References renderReferences(const SceneRun& run, const ReferenceRequest& request, const ReferenceCache& cache) {
    References references;
    references.method = "two independent";
    std::vector<Image> images;
    std::unique_ptr<SeedRenderer> renderer;
    for (std::uint32_t index = 0; index < 2; ++index) {
        std::optional<Image> image = cache.find(index, request.samples);
        if (!image) {
            if (!renderer) {
                announce(request, cache);
                renderer = makeSeedRenderer(request.device, run.scene, request.settings, request.dispatchSeconds);
            }
            image = renderReference(*renderer, run, request, index);
            if (!image) return references;
            cache.store(index, *image);
        }
        images.push_back(std::move(*image));
        if (!cache.path(index).empty()) references.files.push_back(cache.path(index).string());
    }
    references.meter.emplace(std::move(images.front()), std::move(images.back()));
    return references;
}

} // namespace isolux

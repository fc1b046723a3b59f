// Renders a scene on a Vulkan device: uploads, specialises the kernel to the scene, dispatches, joins the batches.
#pragma once

#include "core/progress.h"
#include "film/film.h"
#include "film/sample_plan.h"
#include "gpu/commands.h"
#include "gpu/kernel.h"
#include "pack/scene_features.h"
#include "render/device_scene.h"
#include "render/schedule.h"

#include "shared/path_records.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace isolux {

struct RenderOptions {
    /// How long a dispatch should last, about: with its scatter below a tenth of a second. Watchdogs end one after two.
    double dispatchSeconds = 0.07;
    ReadPath readPath = ReadPath::automatic;
    PathSignatures signatures = PathSignatures::off;
    Aovs aovs = Aovs::off;
    TraversalCounts counts = TraversalCounts::off;
    StoppingRule stopping;
    FirstPasses firstPasses = FirstPasses::full;
    /// Told after each pass what is done; saying `no` ends the render there. May be empty.
    std::function<Continue(const Film&)> pass;
    std::function<void(std::string_view)> stage; ///< told what is being prepared; may be empty
    std::optional<SceneFeatures> features;       ///< instead of what the scene needs (for tests and benchmarks)
    std::optional<std::uint32_t> maxLanes;       ///< instead of what suits the device
};

struct RenderStatistics {
    double packSeconds = 0.0; ///< flattening and BVH, on the CPU
    double uploadSeconds = 0.0;
    double compileSeconds = 0.0; ///< pipeline and an empty dispatch: some drivers compile only then
    double deviceSeconds = 0.0;  ///< sum of the dispatches, by device timestamps where there are any
    double longestDispatchSeconds = 0.0;
    std::uint64_t dispatchCount = 0;
    std::size_t sceneBytes = 0;
    SceneFeatures features;
    Specialization specialization; ///< of the kernel
};

class PathRenderer {
public:
    PathRenderer(const Device& device, const Scene& scene, const RenderSettings& settings,
                 const RenderOptions& options);

    /// Renders the samples of all pixels that are due by the stopping rule into `film` (of the settings' resolution).
    /// If it is interrupted or throws, the film holds what was finished until then.
    void render(Film& film, const ProgressCallback& progress) { render(film, wholeImage(), progress); }
    /// The same for the pixels of a region; the others keep zero samples.
    void render(Film& film, const Tile& region, const ProgressCallback& progress);

    /// Renders other samples or a lesser depth from now on; resolution and camera stay, and so does what the kernel was
    /// specialised to.
    void setSamples(const SampleRange& samples);
    void setMaxDepth(std::uint32_t maxDepth);
    /// Other random numbers, and other reasons to stop.
    void setSeed(std::uint64_t seed);
    void setStopping(const StoppingRule& stopping) { options_.stopping = stopping; }

    [[nodiscard]] const RenderStatistics& statistics() const { return statistics_; }

private:
    [[nodiscard]] Tile wholeImage() const;
    [[nodiscard]] std::uint32_t laneLimit() const;
    void createKernel();
    void createPathBuffers();
    void writeParameters();
    enum class Lanes { start, resume };
    void createOptionalBuffers(VkDeviceSize lanes);
    double dispatch(const Pass& chunk, std::uint32_t budget, Lanes lanes);
    Continue renderPass(Film& film, const Pass& pass, const std::function<Continue(double)>& progress);
    Continue renderChunk(const Pass& chunk, const std::function<Continue(double)>& progress);
    void joinChunk(Film& film, const Pass& chunk) const;
    void joinAovs(PixelAovs& aovs, const shared::AovRecord& record) const;
    void joinReplicates(PixelReplicates& replicates, const Pass& chunk, std::size_t lane) const;
    [[nodiscard]] bool keepsSamples() const { return usesReplicates(settings_.sampler); }

    const Device& device_;
    RenderOptions options_;
    RenderSettings settings_;
    CommandRunner runner_;
    RenderStatistics statistics_;
    shared::RenderParameters parameters_{};
    std::uint32_t stackSize_ = 1;
    std::uint32_t maxLanes_ = 0;
    std::uint32_t budget_ = 0;
    std::unique_ptr<DeviceScene> scene_;
    std::unique_ptr<Kernel> kernel_;
    std::unique_ptr<Buffer> parameterBuffer_;
    std::unique_ptr<Buffer> paths_;
    std::unique_ptr<Buffer> films_;
    std::unique_ptr<Buffer> aovs_;
    std::unique_ptr<Buffer> pixelList_; ///< of the current chunk, a lane each
    std::unique_ptr<Buffer> sampleRadiance_;
    std::vector<std::uint32_t> firstOfObject_;
    double valuePerDevice_ = 1.0; ///< of what a sample's value is: radiance, depth, or a number without unit
    double worldPerDevice_ = 1.0; ///< length
    std::unique_ptr<Buffer> stacks_;
    std::unique_ptr<Buffer> completion_;
};

} // namespace isolux

#include "render/path_renderer.h"

#include "core/error.h"
#include "core/pacing.h"
#include "core/stopwatch.h"

#include "kernels/spirv.h"
#include "shared/interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace isolux {
namespace {

static_assert(shared::kAovBatchSamples == kBatchSamples);

constexpr std::uint32_t kWorkgroupSize = 64;
constexpr std::uint32_t kFirstBudget = 256;
constexpr std::uint32_t kSoftwareLanes = 1u << 14;
constexpr std::uint32_t kHardwareLanes = 1u << 18;

Vec3d toDouble(const glm::vec4& v) { return {v.x, v.y, v.z}; }

/// `unit`: world radiance over device radiance.
PixelStatistics statisticsOf(const shared::FilmRecord& record, double unit) {
    PixelStatistics pixel;
    pixel.mean = toDouble(record.mean) * unit;
    pixel.squaredDeviation = toDouble(record.squaredDeviation) * (unit * unit);
    pixel.luminanceSquaredDeviation = record.squaredDeviation.w * (unit * unit);
    pixel.sampleCount = record.counts.x;
    pixel.hitCount = static_cast<std::uint64_t>(record.mean.w);
    pixel.pathSignature = record.counts.z;
    return pixel;
}

template <typename Record> std::span<const Record> recordsIn(const Buffer& buffer) {
    return {reinterpret_cast<const Record*>(buffer.mapped().data()), buffer.mapped().size() / sizeof(Record)};
}

} // namespace

PathRenderer::PathRenderer(const Device& device, const Scene& scene, const RenderSettings& settings,
                           const RenderOptions& options)
    : device_(device), options_(options), samples_{settings.firstSample, settings.sampleCount}, runner_(device) {
    const auto announce = [&](std::string_view name) {
        if (options.stage) options.stage(name);
    };
    announce("building the BVH");
    Stopwatch packing;
    PackedScene packed = packScene(scene);
    statistics_.features = options.features.value_or(findFeatures(scene, settings));
    if (!statistics_.features.smoothNormals) packed.normals.clear(); // nothing will read them
    parameters_ = packParameters(packed, scene, settings);
    stackSize_ = packed.stackBound;
    firstOfObject_ = packed.firstOfObject;
    worldPerDevice_ = 1.0 / packed.space.scale;
    radiancePerDevice_ = 1.0 / packed.radianceScale;
    statistics_.packSeconds = packing.seconds();

    announce("uploading");
    Stopwatch uploading;
    scene_ = std::make_unique<DeviceScene>(device, runner_, packed, options.readPath);
    statistics_.sceneBytes = scene_->bytes();
    createPathBuffers();
    writeParameters();
    statistics_.uploadSeconds = uploading.seconds();

    announce("compiling");
    Stopwatch compiling;
    createKernel();
    statistics_.compileSeconds = compiling.seconds();
}

Tile PathRenderer::wholeImage() const { return {0, 0, parameters_.imageSeed.x, parameters_.imageSeed.y}; }

std::uint32_t PathRenderer::laneLimit() const {
    const std::uint32_t wanted =
        options_.maxLanes.value_or(device_.description().software ? kSoftwareLanes : kHardwareLanes);
    const std::size_t laneBytes = std::max(sizeof(shared::PathRecord), std::size_t{8} * stackSize_);
    const auto storable = static_cast<std::uint32_t>(
        std::min<VkDeviceSize>(device_.limits().maxStorageBufferRange / laneBytes, kHardwareLanes));
    return std::max(std::min(wanted, storable), kWorkgroupSize);
}

void PathRenderer::createPathBuffers() {
    const Schedule schedule = makeSchedule(wholeImage(), {laneLimit()});
    maxLanes_ = schedule.maxLaneCount;
    const VkDeviceSize lanes = maxLanes_;
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    paths_ = std::make_unique<Buffer>(device_, lanes * sizeof(shared::PathRecord), kStorage, BufferAccess::deviceOnly);
    stacks_ = std::make_unique<Buffer>(device_, lanes * stackSize_ * 8, kStorage, BufferAccess::deviceOnly);
    films_ = std::make_unique<Buffer>(device_, lanes * sizeof(shared::FilmRecord), kStorage, BufferAccess::hostReads);
    const VkDeviceSize aovLanes = options_.aovs == Aovs::on ? lanes : 0;
    aovs_ = std::make_unique<Buffer>(device_, aovLanes * sizeof(shared::AovRecord), kStorage, BufferAccess::hostReads);
    completion_ =
        std::make_unique<Buffer>(device_, sizeof(shared::CompletionRecord), kStorage, BufferAccess::hostReads);
    parameterBuffer_ = std::make_unique<Buffer>(device_, sizeof(parameters_), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                                BufferAccess::hostWrites);
}

void PathRenderer::writeParameters() {
    std::memcpy(parameterBuffer_->mapped().data(), &parameters_, sizeof(parameters_));
    parameterBuffer_->flush();
}

void PathRenderer::setMaxDepth(std::uint32_t maxDepth) {
    parameters_.depthLights.x = maxDepth;
    writeParameters();
}

void PathRenderer::createKernel() {
    const SceneFeatures& features = statistics_.features;
    KernelSource source;
    source.spirv = kernels::path;
    source.pushConstantSize = sizeof(shared::DispatchParameters);
    source.specialization = {{shared::kSpecWorkgroupSize, kWorkgroupSize},
                             {shared::kSpecTexelBuffers, scene_->usesTexelBuffers() ? 1u : 0u},
                             {shared::kSpecStackSize, stackSize_},
                             {shared::kSpecSpheres, features.spheres ? 1u : 0u},
                             {shared::kSpecLights, static_cast<std::uint32_t>(features.lights)},
                             {shared::kSpecSmoothNormals, features.smoothNormals ? 1u : 0u},
                             {shared::kSpecRoulette, features.roulette ? 1u : 0u},
                             {shared::kSpecAreaLights, features.areaLights ? 1u : 0u},
                             {shared::kSpecPunctualLights, features.punctualLights ? 1u : 0u},
                             {shared::kSpecEnvironment, features.environment ? 1u : 0u},
                             {shared::kSpecAovs, options_.aovs == Aovs::on ? 1u : 0u},
                             {shared::kSpecPathSignatures, options_.signatures == PathSignatures::on ? 1u : 0u}};
    kernel_ = std::make_unique<Kernel>(device_, source);
    scene_->bindTo(*kernel_);
    kernel_->bind(shared::kBindRender, *parameterBuffer_);
    kernel_->bind(shared::kBindPaths, *paths_);
    kernel_->bind(shared::kBindFilm, *films_);
    kernel_->bind(shared::kBindStack, *stacks_);
    kernel_->bind(shared::kBindCompletion, *completion_);
    kernel_->bind(shared::kBindAovs, *aovs_);
    // A tile without rows: every lane returns at once, and drivers that compile at the first dispatch have done so.
    dispatch({0, 0, 1, 0}, {0, 0}, 1, true);
    budget_ = std::min(kFirstBudget, maxStepBudget(device_.limits().subgroupSize));
}

double PathRenderer::dispatch(const Tile& tile, const Batch& batch, std::uint32_t budget, bool fresh) {
    const shared::DispatchParameters parameters{{tile.x, tile.y, tile.width, tile.height},
                                                {batch.firstSample, batch.sampleCount, budget, fresh ? 1u : 0u}};
    const std::uint32_t groups = std::max(tile.laneCount() / kWorkgroupSize, 1u);
    return runner_.run(
        [&](VkCommandBuffer commands) { kernel_->record(commands, std::as_bytes(std::span(&parameters, 1)), groups); });
}

void PathRenderer::render(Film& film, const Tile& region, const ProgressCallback& progress) {
    if (options_.aovs == Aovs::on) film.keepAovs();
    const Schedule schedule = makeSchedule(region, {maxLanes_});
    const Pacing pacing(options_.seconds, kBatchSamples);
    const auto tileCount = static_cast<double>(schedule.tiles.size());
    std::uint32_t done = 0;
    while (const std::uint32_t count = pacing.nextPass(done, samples_.sampleCount)) {
        const Batch batch{samples_.firstSample + done, count};
        double finishedTiles = 0.0;
        for (const Tile& tile : schedule.tiles) {
            const auto tileProgress = [&](double fraction) {
                const double part = (finishedTiles + fraction) / tileCount;
                return progress(pacing.fraction(done + count * part, samples_.sampleCount));
            };
            if (renderTile(tile, batch, tileProgress) == Continue::no) return;
            joinTile(film, tile, batch);
            finishedTiles += 1.0;
        }
        done += count;
    }
}

Continue PathRenderer::renderTile(const Tile& tile, const Batch& batch,
                                  const std::function<Continue(double)>& progress) {
    const std::uint32_t maximum = maxStepBudget(device_.limits().subgroupSize);
    std::memset(completion_->mapped().data(), 0, completion_->mapped().size());
    completion_->flush();
    std::uint32_t finishedLanes = 0;
    bool fresh = true;
    while (finishedLanes < tile.pixelCount()) {
        const double seconds = dispatch(tile, batch, budget_, fresh);
        fresh = false;
        ++statistics_.dispatchCount;
        statistics_.deviceSeconds += seconds;
        statistics_.longestDispatchSeconds = std::max(statistics_.longestDispatchSeconds, seconds);
        completion_->invalidate();
        finishedLanes = recordsIn<shared::CompletionRecord>(*completion_)[0].finishedLanes.x;
        // A dispatch in which most lanes had already finished says nothing about a full one.
        const bool full = finishedLanes < tile.pixelCount() / 2;
        if (full || seconds > options_.dispatchSeconds)
            budget_ = nextStepBudget(budget_, seconds, options_.dispatchSeconds, maximum);
        if (progress(static_cast<double>(finishedLanes) / tile.pixelCount()) == Continue::no) return Continue::no;
    }
    return Continue::yes;
}

void PathRenderer::joinTile(Film& film, const Tile& tile, const Batch& batch) const {
    films_->invalidate();
    aovs_->invalidate();
    const auto records = recordsIn<shared::FilmRecord>(*films_);
    const auto aovRecords = recordsIn<shared::AovRecord>(*aovs_);
    const std::uint32_t blocksPerRow = (tile.width + 7) / 8;
    for (std::uint32_t y = 0; y < tile.height; ++y)
        for (std::uint32_t x = 0; x < tile.width; ++x) {
            const std::uint32_t lane = ((y / 8) * blocksPerRow + x / 8) * 64 + (y % 8) * 8 + x % 8;
            const shared::FilmRecord& record = records[lane];
            if (record.counts.x != batch.sampleCount)
                throwFailure(device_.description().name,
                             fmt::format("it took {} of {} samples of pixel ({}, {}): the driver cut the work short",
                                         record.counts.x, batch.sampleCount, tile.x + x, tile.y + y));
            film.at(tile.x + x, tile.y + y).merge(statisticsOf(record, radiancePerDevice_));
            film.rays += record.counts.y;
            film.diagnostics.merge({record.counts.w, record.faults.x, record.faults.y, record.faults.z});
            if (options_.aovs == Aovs::on) joinAovs(film.aovsAt(tile.x + x, tile.y + y), aovRecords[lane]);
        }
}

void PathRenderer::joinAovs(PixelAovs& aovs, const shared::AovRecord& record) const {
    aovs.albedo += toDouble(record.albedoDepth);
    aovs.normal += toDouble(record.normal);
    aovs.depth += record.albedoDepth.w * worldPerDevice_;
    for (const glm::uvec4& four : record.primitiveId)
        for (int i = 0; i < 4; ++i) {
            if (four[i] == shared::kNone) continue;
            const auto next = std::upper_bound(firstOfObject_.begin(), firstOfObject_.end(), four[i]);
            aovs.addCoverage(static_cast<std::uint32_t>(next - firstOfObject_.begin() - 1), 1);
        }
}

} // namespace isolux

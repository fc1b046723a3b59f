#include "render/path_renderer.h"

#include "core/error.h"
#include "core/stopwatch.h"
#include "scene/pixel_filter.h"

#include "kernels/spirv.h"
#include "shared/interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace isolux {
namespace {

static_assert(shared::kBatchSamples == SamplePlan::kLargestPass && shared::kFilterCells == kFilterCells);

constexpr std::uint32_t kWorkgroupSize = 64;
constexpr std::uint32_t kFirstBudget = 256;
constexpr std::uint32_t kSoftwareLanes = 1u << 14;
constexpr std::uint32_t kHardwareLanes = 1u << 18;

/// kIntegrator... of the kernel, for which direct light is a matter of depth.
std::uint32_t kernelIntegrator(Integrator integrator) {
    switch (integrator) {
    case Integrator::path:
    case Integrator::direct: return shared::kIntegratorPath;
    case Integrator::normals: return shared::kIntegratorNormals;
    case Integrator::albedo: return shared::kIntegratorAlbedo;
    case Integrator::depth: return shared::kIntegratorDepth;
    case Integrator::ao: return shared::kIntegratorAmbient;
    }
    return shared::kIntegratorPath;
}

std::uint64_t joinWords(std::uint32_t low, std::uint32_t high) { return std::uint64_t{high} << 32 | low; }

Vec3d toDouble(const glm::vec4& v) { return {v.x, v.y, v.z}; }

/// `unit`: a value in the world over the same on the device.
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

/// The constants that follow from the settings alone.
Specialization specializeMethods(const RenderSettings& settings, const shared::RenderParameters& parameters) {
    const auto flag = [](bool on) { return on ? 1u : 0u; };
    return {{shared::kSpecSampler, static_cast<std::uint32_t>(settings.sampler)},
            {shared::kSpecIntegrator, kernelIntegrator(settings.integrator)},
            {shared::kSpecLightSampling, static_cast<std::uint32_t>(settings.lightSampling)},
            {shared::kSpecBalanceHeuristic, flag(settings.misHeuristic == MisHeuristic::balance)},
            {shared::kSpecLightLoop, flag(parameters.lightSamples.x > 1)},
            {shared::kSpecAllLights, flag(settings.lightChoice == LightChoice::all)},
            {shared::kSpecBounceRange, flag(parameters.sampling.x > 0)},
            {shared::kSpecThinLens, flag(!settings.lens.isPinhole())},
            {shared::kSpecPixelFilter, flag(settings.filter.kind != PixelFilter::box)},
            {shared::kSpecEveryPrimitive, flag(settings.intersection.acceleration == Acceleration::none)},
            {shared::kSpecMollerTrumbore, flag(settings.intersection.triangleTest == TriangleTest::mollerTrumbore)},
            {shared::kSpecKeepSamples, flag(usesReplicates(settings.sampler))}};
}

/// Which constant each feature is.
constexpr auto kFeatureConstants = std::to_array<std::pair<std::uint32_t, bool SceneFeatures::*>>({
    {shared::kSpecSpheres, &SceneFeatures::spheres},
    {shared::kSpecSmoothNormals, &SceneFeatures::smoothNormals},
    {shared::kSpecAreaLights, &SceneFeatures::areaLights},
    {shared::kSpecPunctualLights, &SceneFeatures::punctualLights},
    {shared::kSpecEnvironment, &SceneFeatures::environment},
    {shared::kSpecEnvironmentMap, &SceneFeatures::environmentMap},
    {shared::kSpecSpecular, &SceneFeatures::specular},
    {shared::kSpecRoughSpecular, &SceneFeatures::roughSpecular},
    {shared::kSpecGlass, &SceneFeatures::glass},
    {shared::kSpecRoughGlass, &SceneFeatures::roughGlass},
    {shared::kSpecSolids, &SceneFeatures::solids},
    {shared::kSpecAbsorption, &SceneFeatures::absorption},
    {shared::kSpecBaseColorMaps, &SceneFeatures::baseColorMaps},
    {shared::kSpecMetallicRoughnessMaps, &SceneFeatures::metallicRoughnessMaps},
    {shared::kSpecNormalMaps, &SceneFeatures::normalMaps},
    {shared::kSpecEmissionMaps, &SceneFeatures::emissionMaps},
    {shared::kSpecTransmissionMaps, &SceneFeatures::transmissionMaps},
    {shared::kSpecSpecularMaps, &SceneFeatures::specularMaps},
    {shared::kSpecVertexColors, &SceneFeatures::vertexColors},
    {shared::kSpecAlphaMask, &SceneFeatures::alphaMask},
    {shared::kSpecAlphaBlend, &SceneFeatures::alphaBlend},
    {shared::kSpecUnlit, &SceneFeatures::unlit},
});

Specialization specializeFeatures(const SceneFeatures& features) {
    Specialization constants{{shared::kSpecLights, static_cast<std::uint32_t>(features.lights)},
                             {shared::kSpecRoulette, static_cast<std::uint32_t>(features.roulette)}};
    for (const auto& [constant, flag] : kFeatureConstants) constants[constant] = features.*flag ? 1u : 0u;
    return constants;
}

template <typename Record> std::span<const Record> recordsIn(const Buffer& buffer) {
    return {reinterpret_cast<const Record*>(buffer.mapped().data()), buffer.mapped().size() / sizeof(Record)};
}

} // namespace

PathRenderer::PathRenderer(const Device& device, const Scene& scene, const RenderSettings& settings,
                           const RenderOptions& options)
    : device_(device), options_(options), settings_(settings), runner_(device) {
    const auto announce = [&](std::string_view name) {
        if (options.stage) options.stage(name);
    };
    announce("building the BVH");
    Stopwatch packing;
    statistics_.features = options.features.value_or(findFeatures(scene, settings));
    const PackedScene packed = packScene(scene, settings, statistics_.features);
    parameters_ = packParameters(packed, scene, settings);
    stackSize_ = packed.stackBound;
    firstOfObject_ = packed.firstOfObject;
    worldPerDevice_ = 1.0 / packed.space.scale;
    if (followsLight(settings)) valuePerDevice_ = 1.0 / packed.radianceScale;
    if (settings.integrator == Integrator::depth) valuePerDevice_ = worldPerDevice_;
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

Tile PathRenderer::wholeImage() const { return {0, 0, settings_.width, settings_.height}; }

std::uint32_t PathRenderer::laneLimit() const {
    const std::uint32_t wanted =
        options_.maxLanes.value_or(device_.description().software ? kSoftwareLanes : kHardwareLanes);
    const std::size_t laneBytes =
        std::max({sizeof(shared::PathRecord), sizeof(shared::SampleRecord), std::size_t{8} * stackSize_});
    const auto storable = static_cast<std::uint32_t>(
        std::min<VkDeviceSize>(device_.limits().maxStorageBufferRange / laneBytes, kHardwareLanes));
    return std::max(std::min(wanted, storable), kWorkgroupSize);
}

void PathRenderer::createPathBuffers() {
    // Whole workgroups: their last lanes may have no pixel.
    const auto groups = static_cast<std::uint32_t>(std::min<std::uint64_t>(
        (wholeImage().pixelCount() + kWorkgroupSize - 1) / kWorkgroupSize, laneLimit() / kWorkgroupSize));
    maxLanes_ = groups * kWorkgroupSize;
    const VkDeviceSize lanes = maxLanes_;
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    paths_ = std::make_unique<Buffer>(device_, lanes * sizeof(shared::PathRecord), kStorage, BufferAccess::deviceOnly);
    stacks_ = std::make_unique<Buffer>(device_, lanes * stackSize_ * 8, kStorage, BufferAccess::deviceOnly);
    films_ = std::make_unique<Buffer>(device_, lanes * sizeof(shared::FilmRecord), kStorage, BufferAccess::hostReads);
    pixelList_ = std::make_unique<Buffer>(device_, lanes * sizeof(std::uint32_t), kStorage, BufferAccess::hostWrites);
    createOptionalBuffers(lanes);
    completion_ =
        std::make_unique<Buffer>(device_, sizeof(shared::CompletionRecord), kStorage, BufferAccess::hostReads);
    parameterBuffer_ = std::make_unique<Buffer>(device_, sizeof(parameters_), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                                BufferAccess::hostWrites);
}

/// A binding that nothing reads still needs something bound to it: a buffer of no size is a small one.
void PathRenderer::createOptionalBuffers(VkDeviceSize lanes) {
    constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const VkDeviceSize aovLanes = options_.aovs == Aovs::on ? lanes : 0;
    aovs_ = std::make_unique<Buffer>(device_, aovLanes * sizeof(shared::AovRecord), kStorage, BufferAccess::hostReads);
    const VkDeviceSize sampleLanes = keepsSamples() ? lanes : 0;
    sampleRadiance_ = std::make_unique<Buffer>(device_, sampleLanes * sizeof(shared::SampleRecord), kStorage,
                                               BufferAccess::hostReads);
}

void PathRenderer::writeParameters() {
    std::memcpy(parameterBuffer_->mapped().data(), &parameters_, sizeof(parameters_));
    parameterBuffer_->flush();
}

void PathRenderer::setSamples(const SampleRange& samples) {
    settings_.firstSample = samples.first;
    settings_.sampleCount = samples.count;
}

void PathRenderer::setMaxDepth(std::uint32_t maxDepth) {
    settings_.maxDepth = maxDepth;
    const BounceRange bounces = countedBounces(settings_);
    parameters_.depthLights.x = bounces.last;
    parameters_.sampling.x = bounces.first;
    writeParameters();
}

void PathRenderer::setSeed(std::uint64_t seed) {
    settings_.seed = seed;
    parameters_.imageSeed.z = static_cast<std::uint32_t>(seed);
    parameters_.imageSeed.w = static_cast<std::uint32_t>(seed >> 32);
    writeParameters();
}

void PathRenderer::createKernel() {
    KernelSource source;
    source.spirv = kernels::path;
    source.pushConstantSize = sizeof(shared::DispatchParameters);
    source.specialization = {{shared::kSpecWorkgroupSize, kWorkgroupSize},
                             {shared::kSpecTexelBuffers, scene_->usesTexelBuffers() ? 1u : 0u},
                             {shared::kSpecStackSize, stackSize_},
                             {shared::kSpecAovs, options_.aovs == Aovs::on ? 1u : 0u},
                             {shared::kSpecPathSignatures, options_.signatures == PathSignatures::on ? 1u : 0u},
                             {shared::kSpecTraversalCounts, options_.counts == TraversalCounts::on ? 1u : 0u}};
    source.specialization.merge(specializeFeatures(statistics_.features));
    source.specialization.merge(specializeMethods(settings_, parameters_));
    statistics_.specialization = source.specialization;
    kernel_ = std::make_unique<Kernel>(device_, source);
    scene_->bindTo(*kernel_);
    kernel_->bind(shared::kBindRender, *parameterBuffer_);
    kernel_->bind(shared::kBindPaths, *paths_);
    kernel_->bind(shared::kBindFilm, *films_);
    kernel_->bind(shared::kBindStack, *stacks_);
    kernel_->bind(shared::kBindCompletion, *completion_);
    kernel_->bind(shared::kBindAovs, *aovs_);
    kernel_->bind(shared::kBindPixels, *pixelList_);
    kernel_->bind(shared::kBindSamples, *sampleRadiance_);
    // No pixels: every lane returns at once, and drivers that compile at the first dispatch have done so.
    dispatch({}, 1, Lanes::start);
    budget_ = std::min(kFirstBudget, maxStepBudget(device_.limits().subgroupSize));
}

double PathRenderer::dispatch(const Pass& chunk, std::uint32_t budget, Lanes lanes) {
    const auto count = static_cast<std::uint32_t>(chunk.pixels.size());
    const shared::DispatchParameters parameters{
        {chunk.firstSample, chunk.sampleCount, budget, lanes == Lanes::start ? 1u : 0u}, {count, 0, 0, 0}};
    const std::uint32_t groups = std::max((count + kWorkgroupSize - 1) / kWorkgroupSize, 1u);
    return runner_.run(
        [&](VkCommandBuffer commands) { kernel_->record(commands, std::as_bytes(std::span(&parameters, 1)), groups); });
}

void PathRenderer::render(Film& film, const Tile& region, const ProgressCallback& progress) {
    if (options_.aovs == Aovs::on) film.keepAovs();
    if (keepsSamples()) film.keepReplicates();
    SamplePlan plan(options_.stopping, {settings_.firstSample, settings_.sampleCount}, options_.firstPasses,
                    orderPixels(region, maxLanes_));
    while (const std::optional<Pass> pass = plan.next(film)) {
        const auto passProgress = [&](double part) { return progress(plan.fraction(part)); };
        if (renderPass(film, *pass, passProgress) == Continue::no) return;
        if (options_.pass && options_.pass(film) == Continue::no) return;
    }
}

Continue PathRenderer::renderPass(Film& film, const Pass& pass, const std::function<Continue(double)>& progress) {
    const auto pixelCount = static_cast<double>(pass.pixels.size());
    for (std::size_t first = 0; first < pass.pixels.size(); first += maxLanes_) {
        Pass chunk = pass;
        chunk.pixels = pass.pixels.subspan(first, std::min<std::size_t>(maxLanes_, pass.pixels.size() - first));
        const auto chunkProgress = [&](double part) {
            return progress((static_cast<double>(first) + part * static_cast<double>(chunk.pixels.size())) /
                            pixelCount);
        };
        if (renderChunk(chunk, chunkProgress) == Continue::no) return Continue::no;
        joinChunk(film, chunk);
    }
    return Continue::yes;
}

Continue PathRenderer::renderChunk(const Pass& chunk, const std::function<Continue(double)>& progress) {
    const std::uint32_t maximum = maxStepBudget(device_.limits().subgroupSize);
    std::memcpy(pixelList_->mapped().data(), chunk.pixels.data(), chunk.pixels.size_bytes());
    pixelList_->flush();
    std::memset(completion_->mapped().data(), 0, completion_->mapped().size());
    completion_->flush();
    std::size_t finishedLanes = 0;
    Lanes lanes = Lanes::start;
    while (finishedLanes < chunk.pixels.size()) {
        const double seconds = dispatch(chunk, budget_, lanes);
        lanes = Lanes::resume;
        ++statistics_.dispatchCount;
        statistics_.deviceSeconds += seconds;
        statistics_.longestDispatchSeconds = std::max(statistics_.longestDispatchSeconds, seconds);
        completion_->invalidate();
        finishedLanes = recordsIn<shared::CompletionRecord>(*completion_)[0].finishedLanes.x;
        // A dispatch in which most lanes had already finished says nothing about a full one.
        const bool full = finishedLanes < chunk.pixels.size() / 2;
        if (full || seconds > options_.dispatchSeconds)
            budget_ = nextStepBudget(budget_, seconds, options_.dispatchSeconds, maximum);
        const double part = static_cast<double>(finishedLanes) / static_cast<double>(chunk.pixels.size());
        if (progress(part) == Continue::no) return Continue::no;
    }
    return Continue::yes;
}

void PathRenderer::joinChunk(Film& film, const Pass& chunk) const {
    films_->invalidate();
    aovs_->invalidate();
    sampleRadiance_->invalidate();
    const auto records = recordsIn<shared::FilmRecord>(*films_);
    const auto aovRecords = recordsIn<shared::AovRecord>(*aovs_);
    for (std::size_t lane = 0; lane < chunk.pixels.size(); ++lane) {
        const std::uint32_t x = pixelX(chunk.pixels[lane]);
        const std::uint32_t y = pixelY(chunk.pixels[lane]);
        const shared::FilmRecord& record = records[lane];
        if (record.counts.x != chunk.sampleCount)
            throwFailure(device_.description().name,
                         fmt::format("it took {} of {} samples of pixel ({}, {}): the driver cut the work short",
                                     record.counts.x, chunk.sampleCount, x, y));
        film.at(x, y).merge(statisticsOf(record, valuePerDevice_));
        film.rays += record.counts.y;
        film.boxTests += joinWords(record.tests.x, record.tests.z);
        film.primitiveTests += joinWords(record.tests.y, record.tests.w);
        film.diagnostics.merge({record.counts.w, record.faults.x, record.faults.y, record.faults.z});
        if (options_.aovs == Aovs::on) joinAovs(film.aovsAt(x, y), aovRecords[lane]);
        if (keepsSamples()) {
            PixelReplicates& replicates = film.replicates[std::size_t{y} * film.width + x];
            joinReplicates(replicates, chunk, lane);
            replicates.refine(film.at(x, y));
        }
    }
}

void PathRenderer::joinReplicates(PixelReplicates& replicates, const Pass& chunk, std::size_t lane) const {
    const shared::SampleRecord& record = recordsIn<shared::SampleRecord>(*sampleRadiance_)[lane];
    for (std::uint32_t i = 0; i < chunk.sampleCount; ++i)
        replicates.add(chunk.firstSample + i, toDouble(record.radiance[i]) * valuePerDevice_);
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

// The structs of shaders/shared as C++ lays them out, against the offsets in the SPIR-V that ships.
#include "gpu/spirv_reflection.h"

#include "kernels/spirv.h"
#include "shared/lobe_records.h"
#include "shared/path_records.h"
#include "shared/ray_records.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace isolux {
namespace {

using Members = std::vector<std::pair<std::string, std::size_t>>;

void expectLayout(const SpirvModule& module, const std::string& name, const Members& members, std::size_t size) {
    const auto found = module.structs.find(name);
    ASSERT_NE(found, module.structs.end()) << name << " is not in the module";
    ASSERT_EQ(found->second.size(), members.size()) << name;
    for (std::size_t i = 0; i < members.size(); ++i) {
        EXPECT_EQ(found->second[i].name, members[i].first) << name;
        EXPECT_EQ(found->second[i].offset, members[i].second) << name << "." << members[i].first;
    }
    const auto stride = module.arrayStrides.find(name);
    if (stride != module.arrayStrides.end()) {
        EXPECT_EQ(stride->second, size) << name;
    }
}

#define MEMBER(type, member)                                                                                           \
    { #member, offsetof(shared::type, member) }

TEST(StructLayout, PathKernel) {
    const SpirvModule module = reflectSpirv(kernels::path);
    expectLayout(module, "PathRecord",
                 {MEMBER(PathRecord, originPdf), MEMBER(PathRecord, directionDistance), MEMBER(PathRecord, throughput),
                  MEMBER(PathRecord, radiance), MEMBER(PathRecord, shadowDirection), MEMBER(PathRecord, shadowRadiance),
                  MEMBER(PathRecord, pointFacing), MEMBER(PathRecord, pointShading), MEMBER(PathRecord, pointReflected),
                  MEMBER(PathRecord, pointOutgoing), MEMBER(PathRecord, pointThroughput), MEMBER(PathRecord, pointF0),
                  MEMBER(PathRecord, pointTint), MEMBER(PathRecord, pointBeyond), MEMBER(PathRecord, pointMedia),
                  MEMBER(PathRecord, progress), MEMBER(PathRecord, bounce), MEMBER(PathRecord, ignored)},
                 sizeof(shared::PathRecord));
    expectLayout(module, "FilmRecord",
                 {MEMBER(FilmRecord, mean), MEMBER(FilmRecord, squaredDeviation), MEMBER(FilmRecord, counts),
                  MEMBER(FilmRecord, faults), MEMBER(FilmRecord, tests)},
                 sizeof(shared::FilmRecord));
    expectLayout(module, "SampleRecord", {MEMBER(SampleRecord, radiance)}, sizeof(shared::SampleRecord));
    expectLayout(module, "AovRecord",
                 {MEMBER(AovRecord, albedoDepth), MEMBER(AovRecord, normal), MEMBER(AovRecord, primitiveId)},
                 sizeof(shared::AovRecord));
    expectLayout(module, "RenderParameters",
                 {MEMBER(RenderParameters, cameraPosition), MEMBER(RenderParameters, cameraRight),
                  MEMBER(RenderParameters, cameraUp), MEMBER(RenderParameters, cameraForward),
                  MEMBER(RenderParameters, lensRight), MEMBER(RenderParameters, lensUp),
                  MEMBER(RenderParameters, environment), MEMBER(RenderParameters, environmentLimits),
                  MEMBER(RenderParameters, environmentMap), MEMBER(RenderParameters, imageSeed),
                  MEMBER(RenderParameters, methods), MEMBER(RenderParameters, depthLights),
                  MEMBER(RenderParameters, lightSamples), MEMBER(RenderParameters, tableOffsets),
                  MEMBER(RenderParameters, textureOffsets), MEMBER(RenderParameters, attributeOffsets),
                  MEMBER(RenderParameters, sceneCounts), MEMBER(RenderParameters, sampling)},
                 sizeof(shared::RenderParameters));
    expectLayout(module, "DispatchParameters", {MEMBER(DispatchParameters, batch), MEMBER(DispatchParameters, lanes)},
                 sizeof(shared::DispatchParameters));
    expectLayout(module, "CompletionRecord", {MEMBER(CompletionRecord, finishedLanes)},
                 sizeof(shared::CompletionRecord));
}

TEST(StructLayout, IntersectKernel) {
    const SpirvModule module = reflectSpirv(kernels::intersect);
    expectLayout(module, "RayRecord", {MEMBER(RayRecord, originDistance), MEMBER(RayRecord, direction)},
                 sizeof(shared::RayRecord));
    expectLayout(module, "HitRecord", {MEMBER(HitRecord, distance), MEMBER(HitRecord, primitive)},
                 sizeof(shared::HitRecord));
    expectLayout(module, "IntersectParameters", {MEMBER(IntersectParameters, range)},
                 sizeof(shared::IntersectParameters));
}

TEST(StructLayout, LobeKernel) {
    const SpirvModule module = reflectSpirv(kernels::lobes);
    expectLayout(
        module, "LobeQueryRecord",
        {MEMBER(LobeQueryRecord, outgoing), MEMBER(LobeQueryRecord, incoming), MEMBER(LobeQueryRecord, random)},
        sizeof(shared::LobeQueryRecord));
    expectLayout(module, "LobeAnswerRecord",
                 {MEMBER(LobeAnswerRecord, directionPdf), MEMBER(LobeAnswerRecord, value),
                  MEMBER(LobeAnswerRecord, probabilities), MEMBER(LobeAnswerRecord, compensation),
                  MEMBER(LobeAnswerRecord, outcome)},
                 sizeof(shared::LobeAnswerRecord));
    expectLayout(module, "LobeParameters", {MEMBER(LobeParameters, tables)}, sizeof(shared::LobeParameters));
}

#undef MEMBER

/// Some drivers end loops after 65,535 iterations over all loops of an invocation, and Mesa makes a loop of every early
/// return. The step budget counts the path loop, the rays of a bounce, the traversal, a leaf's primitives, and the
/// stack's copies; and the four texels of each of twelve lookups of textures, which it counts as steps.
TEST(Loops, AreThoseThatTheStepBudgetCounts) {
    EXPECT_EQ(reflectSpirv(kernels::path).loopCount, 6u + 12u);
    EXPECT_EQ(reflectSpirv(kernels::path).switchCount, 0u);
    EXPECT_EQ(reflectSpirv(kernels::intersect).loopCount, 3u);
    EXPECT_EQ(reflectSpirv(kernels::intersect).switchCount, 0u);
    EXPECT_EQ(reflectSpirv(kernels::lobes).loopCount, 6u); // lookups
    EXPECT_EQ(reflectSpirv(kernels::lobes).switchCount, 0u);
}

TEST(SpirvReflection, RefusesWhatIsNotAModule) {
    EXPECT_THROW((void)reflectSpirv({}), std::exception);
    const std::array<std::uint32_t, 6> wrongMagic{1, 0, 0, 0, 0, 0};
    EXPECT_THROW((void)reflectSpirv(wrongMagic), std::exception);
    const std::array<std::uint32_t, 6> truncated{0x07230203u, 0, 0, 0, 0, 9u << 16};
    EXPECT_THROW((void)reflectSpirv(truncated), std::exception);
}

} // namespace
} // namespace isolux

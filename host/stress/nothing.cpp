// Scenes with hardly anything in them, which must be rendered without a fault, and numbers that are none, which must be
// refused with the place where they stand.
#include "core/error.h"
#include "load/gltf.h"
#include "stress/families.h"
#include "stress/sweep_parts.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace isolux {
namespace {

/// Under a sky of 1, or in the dark.
enum class Sky { white, none };

SceneBuilder nothingUnder(Sky sky) {
    SceneBuilder builder;
    if (sky == Sky::white) builder.scene.environment.radiance = Vec3d(1.0);
    builder.camera({0.0, 0.0, 3.0}, Vec3d(0.0), 0.7);
    return builder;
}

/// Of which every sample is black: any light is a fault.
RenderTrial black(Scene scene) {
    RenderTrial trial;
    trial.scene = std::move(scene);
    trial.settings = stressSettings(16, 4);
    trial.probe = Probe{0.0, 1e-6, Symptom::leak};
    return trial;
}

/// Of which every sample is 1: what is not met, or met and white, shows the sky.
RenderTrial white(Scene scene) {
    RenderTrial trial = expecting(1.0, std::move(scene), scatteringAlone(1));
    trial.probe = Probe{1.0, 1.0, Symptom::selfHit};
    return trial;
}

RenderTrial nothing() { return black(nothingUnder(Sky::none).scene); }
RenderTrial skyAlone() { return white(nothingUnder(Sky::white).scene); }

/// A mesh without triangles.
RenderTrial emptyMesh() {
    SceneBuilder builder = nothingUnder(Sky::white);
    builder.mesh({"", {{-1, -1, 0}, {1, 1, 0}}, {}, {}, 0});
    return white(builder.scene);
}

/// All of the scene in one point, and a line.
RenderTrial noArea() {
    SceneBuilder builder = nothingUnder(Sky::white);
    builder.mesh(triangleMesh({0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
    builder.mesh(triangleMesh({-1, 0, 0}, {0, 0, 0}, {1, 0, 0}));
    return white(builder.scene);
}

RenderTrial oneTriangle() {
    SceneBuilder builder = nothingUnder(Sky::white);
    builder.mesh(triangleMesh({-1, -1, 0}, {1, -0.9f, 0.1f}, {0, 1, -0.2f}));
    return white(builder.scene);
}

/// The scene of a file, which has one made for it.
RenderTrial noCamera() {
    constexpr std::string_view kText =
        R"({"asset":{"version":"2.0"},"materials":[{"emissiveFactor":[1,1,1]}],)"
        R"("nodes":[{"extras":{"sphere":{"radius":1,"material":0}}}],"scenes":[{"nodes":[0]}]})";
    const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(kText.data()), kText.size());
    RenderTrial trial;
    trial.scene = loadSceneFromBytes(bytes, "nothing.gltf");
    trial.settings = stressSettings(16, 4);
    return trial;
}

/// A lamp that is a line has no power, and nothing meets it.
RenderTrial lampWithoutArea() {
    SceneBuilder builder = nothingUnder(Sky::none);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(1e6), Faces::both);
    builder.mesh(squareMesh(0));
    builder.mesh(triangleMesh({-1, 0, 1}, {0, 0, 1}, {1, 0, 1}, lamp));
    return black(builder.scene);
}

RenderTrial noLights() {
    Scene scene = cornellBox();
    for (Material& material : scene.materials) material.emission = Vec3d(0.0);
    return black(std::move(scene));
}

/// Surfaces that reflect nothing, under lamps of every kind; the one that can be seen looks away.
RenderTrial allBlack() {
    SceneBuilder builder = nothingUnder(Sky::none);
    builder.scene.materials[0].baseColor = Vec3d(0.0);
    const std::uint32_t lamp = builder.material(Vec3d(0.0), Vec3d(1.0), Faces::front);
    builder.mesh(squareMesh(0), scaling(Vec3d(3.0)));
    builder.mesh(squareMesh(lamp), translation({0.0, 0.0, 1.0}) * scaling({0.1, -0.1, -1.0}));
    builder.scene.punctualLights.resize(2);
    builder.scene.punctualLights[0].position = {0.5, 0.5, 1.0};
    builder.scene.punctualLights[1].kind = PunctualKind::directional;
    return black(builder.scene);
}

PlannedSweep sceneSweep(Extent extent) {
    const StressSweep about{.name = "scenes",
                            .title = "Scenes in which there is hardly anything",
                            .axisTitle = "scene",
                            .axis = StressAxis::linear,
                            .limit = "None: what has no extent has a scale of 1, and what has no area is not met."};
    const std::array<std::pair<const char*, RenderTrial (*)()>, 9> scenes{{{"nothing", nothing},
                                                                           {"sky alone", skyAlone},
                                                                           {"a mesh without triangles", emptyMesh},
                                                                           {"triangles without area", noArea},
                                                                           {"one triangle", oneTriangle},
                                                                           {"no camera", noCamera},
                                                                           {"a lamp without area", lampWithoutArea},
                                                                           {"no lights", noLights},
                                                                           {"all black", allBlack}}};
    std::vector<PlannedStep> steps;
    steps.reserve(scenes.size());
    for (const auto& scene : scenes)
        steps.push_back({static_cast<double>(steps.size() + 1), scene.first, trialOf(scene.second)});
    return {about, thinned(std::move(steps), extent)};
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// POSITION, NORMAL and COLOR_0 of three vertices: nine numbers each.
std::array<float, 27> triangleNumbers() {
    return {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
}

/// What a file says where it may be wrong, as JSON.
struct Spelled {
    std::string emission = "1";
    std::string translation = "0";
    std::string scale = "1"; ///< of a node and of its parent
    std::string yfov = "0.7";
};

std::string documentWith(const Spelled& spelled) {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":108}}],"bufferViews":[)"
        R"({{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":36}},)"
        R"({{"buffer":0,"byteOffset":72,"byteLength":36}}],"accessors":[)"
        R"({{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},)"
        R"({{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}},)"
        R"({{"bufferView":2,"componentType":5126,"count":3,"type":"VEC3"}}],)"
        R"("materials":[{{"emissiveFactor":[0,{},0]}}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"COLOR_0":2}},"material":0}}]}}],)"
        R"("cameras":[{{"type":"perspective","perspective":{{"yfov":{},"znear":1}}}}],)"
        R"("nodes":[{{"mesh":0,"matrix":[{},0,0,0,0,1,0,0,0,0,1,0,{},0,0,1]}},)"
        R"({{"children":[0],"scale":[{},1,1]}},{{"camera":0}}],"scenes":[{{"nodes":[1,2]}}]}})",
        spelled.emission, spelled.yfov, spelled.scale, spelled.translation, spelled.scale);
}

void append(Bytes& bytes, const void* data, std::size_t size) {
    const std::size_t end = bytes.size();
    bytes.resize(end + size);
    std::memcpy(bytes.data() + end, data, size);
}

void appendWords(Bytes& bytes, std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) append(bytes, &word, sizeof(word));
}

/// A .glb file of a document and its numbers.
Bytes glbOf(std::string document, const std::array<float, 27>& numbers) {
    document.resize((document.size() + 3) / 4 * 4, ' ');
    const auto jsonBytes = static_cast<std::uint32_t>(document.size());
    constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
    Bytes bytes;
    appendWords(bytes, {kMagic, 2, 28 + jsonBytes + std::uint32_t{sizeof(numbers)}, jsonBytes, kJson});
    append(bytes, document.data(), document.size());
    appendWords(bytes, {sizeof(numbers), kBinary});
    append(bytes, numbers.data(), sizeof(numbers));
    return bytes;
}

/// A number that must be refused, and what the message must say about where it stands.
struct Wrong {
    const char* label;
    const char* place;
    Spelled spelled{};
    std::size_t number = 0; ///< of triangleNumbers
    float value = 0.0f;
};

StressFigures refused(const Wrong& wrong) {
    StressFigures figures;
    figures.renderer = kStressDevice; // which is never asked
    figures.faults.tried = 1;
    std::array<float, 27> numbers = triangleNumbers();
    numbers[wrong.number] = wrong.value;
    try {
        (void)loadSceneFromBytes(glbOf(documentWith(wrong.spelled), numbers), "nothing.glb");
        figures.failure = "it was not refused";
    } catch (const Error& error) {
        const std::string message = error.what();
        const bool named = message.find(wrong.place) != std::string::npos;
        if (!named || error.code() != ExitCode::badInput)
            figures.failure = fmt::format("it was refused without saying where ('{}'): {}", wrong.place, message);
    }
    return figures;
}

PlannedSweep refusedSweep() {
    const StressSweep about{.name = "numbers",
                            .title = "Files with numbers that are infinite or none: refused, and where they stand",
                            .axisTitle = "file",
                            .axis = StressAxis::linear,
                            .limit = "None: every number that is read is looked at. JSON has no word for infinity, so "
                                     "a number beyond double's range, such as 1e999, is an error of its text."};
    const std::vector<Wrong> all{
        {"NaN in POSITION", "/accessors/0: element 1 ", {}, 3, kNan},
        {"infinity in POSITION", "/accessors/0: element 2 ", {}, 8, kInfinity},
        {"-infinity in POSITION", "/accessors/0: element 0 ", {}, 1, -kInfinity},
        {"NaN in NORMAL", "/accessors/1: element 2 ", {}, 17, kNan},
        {"infinity in NORMAL", "/accessors/1: element 0 ", {}, 9, kInfinity},
        {"NaN in COLOR_0", "/accessors/2: element 1 ", {}, 21, kNan},
        {"matrices whose product is infinite", "/nodes/0: ", {.scale = "1e300"}},
        {"NaN in a matrix", "line 1, column ", {.translation = "NaN"}},
        {"1e999 in a matrix", "line 1, column ", {.translation = "1e999"}},
        {"NaN in an emission", "line 1, column ", {.emission = "NaN"}},
        {"1e999 in an emission", "line 1, column ", {.emission = "1e999"}},
        {"1e300 in an emission", "/materials/0/emissiveFactor/1: ", {.emission = "1e300"}},
        {"1e300 in a field of view", "/cameras/0/perspective/yfov: ", {.yfov = "1e300"}},
    };
    std::vector<PlannedStep> steps;
    steps.reserve(all.size());
    for (const Wrong& wrong : all)
        steps.push_back({static_cast<double>(steps.size() + 1), wrong.label,
                         trialBy([wrong](const StressBench&) { return std::vector<StressFigures>{refused(wrong)}; })});
    return {about, std::move(steps)};
}

} // namespace

std::vector<PlannedSweep> nothingSweeps(Extent extent) { return {sceneSweep(extent), refusedSweep()}; }

} // namespace isolux

// The glTF loader on what nodes place beside surfaces: cameras and punctual lights; and on the scene's sky.
#include "unit/load_fixture.h"

#include <limits>
#include <numbers>

namespace isolux::load_test {
namespace {

constexpr double kTolerance = 1e-12;

/// The triangle, and these nodes beside it.
json documentWithNodes(const json& nodes) {
    json document = triangleDocument();
    for (const json& node : nodes) {
        document["scenes"][0]["nodes"].push_back(document["nodes"].size());
        document["nodes"].push_back(node);
    }
    return document;
}

json orthographic(double xmag, double ymag) {
    return {{"type", "orthographic"}, {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0}, {"zfar", 10}}}};
}

json perspective() { return {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}}; }

TEST_F(LoadTest, OrthographicCamerasKeepTheirSizeUnderScale) {
    json document = documentWithNodes(
        {{{"camera", 0}, {"scale", {7, 7, 7}}, {"translation", {1, 2, 3}}, {"rotation", {1, 0, 0, 0}}}});
    document["cameras"] = {orthographic(3.0, 1.5)};
    const Scene scene = load(document);
    const Camera& camera = scene.cameras.at(0);
    EXPECT_EQ(camera.projection, Projection::orthographic);
    EXPECT_EQ(camera.ymag, 1.5);
    EXPECT_EQ(camera.aspectRatio, 2.0);
    EXPECT_EQ(camera.position, Vec3d(1, 2, 3));
    const Mat3d halfTurn(1, 0, 0, 0, -1, 0, 0, 0, -1);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(glm::distance(camera.worldFromCamera[axis], halfTurn[axis]), 0.0, kTolerance);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

TEST_F(LoadTest, CamerasAreNamedByThemselvesTheirNodeOrTheirOrder) {
    json document = documentWithNodes({{{"camera", 1}}, {{"camera", 0}, {"name", "tripod"}}, {{"camera", 1}}});
    document["nodes"].push_back({{"camera", 2}, {"name", "ignored"}});
    document["nodes"][0]["children"] = {4};
    document["cameras"] = {perspective(), orthographic(1, 1), perspective()};
    document["cameras"][2]["name"] = "front";
    const Scene scene = load(document);
    ASSERT_EQ(scene.cameras.size(), 4u);
    const std::vector<std::pair<std::string, Projection>> expected = {{"front", Projection::perspective},
                                                                      {"camera 1", Projection::orthographic},
                                                                      {"tripod", Projection::perspective},
                                                                      {"camera 3", Projection::orthographic}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(scene.cameras[i].name, expected[i].first);
        EXPECT_EQ(scene.cameras[i].projection, expected[i].second);
    }
}

TEST_F(LoadTest, UnusualOrthographicCameras) {
    json document = documentWithNodes({{{"camera", 0}}});
    document["cameras"] = {orthographic(-3.0, -1.5)};
    const Scene mirrored = load(document);
    EXPECT_EQ(mirrored.cameras.at(0).ymag, 1.5);
    EXPECT_EQ(mirrored.cameras[0].aspectRatio, 2.0);
    EXPECT_TRUE(mentions(mirrored.warnings, "/cameras/0/orthographic/xmag: is negative, which would mirror the image; "
                                            "rendered unmirrored (and 1 more)"));
    document["cameras"] = {orthographic(1.0, 1.0)};
    document["cameras"][0]["orthographic"]["zfar"] = 0;
    EXPECT_TRUE(mentions(load(document).warnings, "/cameras/0/orthographic: znear or zfar"));
}

TEST_F(LoadTest, MalformedCamerasAreRefusedByPointer) {
    const auto damaged = [](json camera, const std::string& pointer, const json& value) {
        camera[json::json_pointer(pointer)] = value;
        return camera;
    };
    const std::vector<std::pair<const char*, json>> cases = {
        {"/cameras/0/orthographic: is missing", {{"type", "orthographic"}}},
        {"/cameras/0/orthographic/ymag: is 0 but must", orthographic(1, 0)},
        {"/cameras/0/orthographic/xmag: is 0 but must", orthographic(0, 1)},
        {"/cameras/0/orthographic/ymag: is 1e+300 but must", orthographic(1, 1e300)},
        {"/cameras/0/orthographic/xmag: must be a number", damaged(orthographic(1, 1), "/orthographic/xmag", "1")},
        {"/cameras/0/orthographic/xmag: is missing",
         {{"type", "orthographic"}, {"orthographic", {{"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}},
        {"/cameras/0/perspective/yfov: is 3.2 but must", damaged(perspective(), "/perspective/yfov", 3.2)},
        {"/cameras/0/perspective/yfov: is -1 but must", damaged(perspective(), "/perspective/yfov", -1)},
    };
    for (const auto& [expected, camera] : cases) {
        json document = triangleDocument();
        document["cameras"] = {camera};
        EXPECT_MENTIONS(failure(document), expected);
    }
}

/// A scene with this light, at these nodes.
json documentWithLight(json light, json nodes = {json::object()}) {
    for (json& node : nodes) node["extensions"]["KHR_lights_punctual"]["light"] = 0;
    json document = documentWithNodes(nodes);
    document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_lights_punctual"};
    document["extensions"]["KHR_lights_punctual"]["lights"] = {std::move(light)};
    return document;
}

TEST_F(LoadTest, PointLights) {
    const json light = {{"type", "point"}, {"name", "bulb"}, {"color", {1, 0.5, 0.25}}, {"intensity", 40}};
    const json node = {{"translation", {1, 2, 3}}, {"scale", {0, 0, 0}}, {"name", "lamp"}};
    const Scene scene = load(documentWithLight(light, {node}));
    ASSERT_EQ(scene.punctualLights.size(), 1u);
    EXPECT_EQ(scene.punctualLights[0].kind, PunctualKind::point);
    EXPECT_EQ(scene.punctualLights[0].name, "bulb");
    EXPECT_EQ(scene.punctualLights[0].position, Vec3d(1, 2, 3));
    EXPECT_EQ(scene.punctualLights[0].intensity, Vec3d(40, 20, 10));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
}

TEST_F(LoadTest, DirectionalLightsFollowTheRotationOfTheirNodes) {
    const double h = std::sqrt(0.5); // a quarter turn about x takes -z to +y, one about y then +y to itself, -z to -x
    json document = documentWithLight({{"type", "directional"}}, {{{"rotation", {h, 0, 0, h}}, {"scale", {3, 5, 7}}},
                                                                  {{"rotation", {0, h, 0, h}}, {"name", "sun"}},
                                                                  {{"translation", {9, 9, 9}}}});
    document["nodes"][0]["children"] = {1};
    document["nodes"][0]["rotation"] = {0, 0, h, h};
    document["scenes"][0]["nodes"] = {0, 2, 3};
    const Scene scene = load(document);
    ASSERT_EQ(scene.punctualLights.size(), 3u);
    const std::vector<Vec3d> directions = {{-1, 0, 0}, {-1, 0, 0}, {0, 0, -1}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(scene.punctualLights[i].kind, PunctualKind::directional);
        EXPECT_NEAR(glm::distance(scene.punctualLights[i].direction, directions[i]), 0.0, kTolerance);
        EXPECT_EQ(scene.punctualLights[i].intensity, Vec3d(1.0));
    }
    EXPECT_EQ(scene.punctualLights[0].name, "node 1");
    EXPECT_EQ(scene.punctualLights[1].name, "sun");
}

TEST_F(LoadTest, SpotLightsAndTheirCones) {
    const Scene plain = load(documentWithLight({{"type", "spot"}, {"spot", json::object()}}));
    ASSERT_EQ(plain.punctualLights.size(), 1u);
    EXPECT_EQ(plain.punctualLights[0].kind, PunctualKind::spot);
    EXPECT_EQ(plain.punctualLights[0].direction, Vec3d(0, 0, -1));
    EXPECT_EQ(plain.punctualLights[0].cosInner, 1.0);
    EXPECT_EQ(plain.punctualLights[0].cosOuter, std::cos(std::numbers::pi / 4.0));
    const json spot = {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}};
    const json node = {{"rotation", {1, 0, 0, 0}}, {"scale", {-2, 2, 1e-300}}, {"translation", {0, 4, 0}}};
    const Scene turned = load(documentWithLight({{"type", "spot"}, {"spot", spot}}, {node}));
    EXPECT_EQ(turned.punctualLights.at(0).cosInner, std::cos(0.25));
    EXPECT_EQ(turned.punctualLights[0].cosOuter, std::cos(0.5));
    EXPECT_NEAR(glm::distance(turned.punctualLights[0].direction, Vec3d(0, 0, 1)), 0.0, kTolerance);
    EXPECT_EQ(turned.punctualLights[0].position, Vec3d(0, 4, 0));
}

TEST_F(LoadTest, ConesAtTheEdgeOfWhatIsAllowed) {
    const auto cones = [&](double inner, double outer) {
        const json spot = {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
        return load(documentWithLight({{"type", "spot"}, {"spot", spot}})).punctualLights.at(0);
    };
    // pi/2 in single precision lies beyond pi/2, yet its light must not shine backwards.
    EXPECT_EQ(cones(0.0, static_cast<double>(std::numbers::pi_v<float>) / 2.0).cosOuter,
              std::cos(std::numbers::pi / 2.0));
    // Cones whose cosines round to the same number stay apart.
    for (const auto& [inner, outer] : {std::pair(0.5, 0.5 + 1e-15), std::pair(0.0, 1e-10)}) {
        const PunctualLight light = cones(inner, outer);
        EXPECT_LT(light.cosOuter, light.cosInner);
        EXPECT_EQ(light.cosInner, std::cos(inner));
        EXPECT_GE(light.cosOuter, std::cos(outer) - 0x1p-51);
    }
}

TEST_F(LoadTest, ALightMayShareItsNodeAndBeSharedByNodes) {
    json document =
        documentWithLight({{"type", "point"}}, {{{"translation", {1, 0, 0}}}, {{"mesh", 0}, {"camera", 0}}});
    document["cameras"] = {perspective()};
    const Scene scene = load(document);
    EXPECT_EQ(scene.punctualLights.size(), 2u);
    EXPECT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST_F(LoadTest, LightsThatCannotBePlacedOrBounded) {
    const json collapsed = {{"scale", {1, 1, 0}}};
    const Scene scene = load(documentWithLight({{"type", "directional"}}, {collapsed, collapsed}));
    EXPECT_TRUE(scene.punctualLights.empty());
    EXPECT_TRUE(
        mentions(scene.warnings, "/nodes/1: its light has no direction, for a scale is zero; left out (and 1 more)"));
    json ranged = documentWithLight({{"type", "point"}, {"range", 3}});
    json& lights = ranged["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(json(lights[0]));
    EXPECT_EQ(load(ranged).warnings, (std::vector<std::string>{"/extensions/KHR_lights_punctual/lights/0/range: the "
                                                               "range of lights, a hint to rasterisers, is ignored "
                                                               "(and 1 more)"}));
    const json far = {{"translation", {1e30, 0, 0}}};
    EXPECT_MENTIONS(failure(documentWithLight({{"type", "point"}}, {far})), "units from the origin");
}

TEST_F(LoadTest, MalformedLightsAreRefusedByPointer) {
    const double inRange = std::numeric_limits<float>::max();
    const auto cones = [](const json& spot) { return json{{"type", "spot"}, {"spot", spot}}; };
    const std::vector<std::pair<const char*, json>> cases = {
        {"/type: is missing", json::object()},
        {"/type: must be point, spot or directional", {{"type", "area"}}},
        {"/type: must be a string", {{"type", 1}}},
        {"/intensity: is -5 but must", {{"type", "point"}, {"intensity", -5}}},
        {"/intensity: is 6.8", {{"type", "point"}, {"intensity", 2.0 * inRange}}},
        {"/intensity: must be a number", {{"type", "point"}, {"intensity", "bright"}}},
        {"/color: must have 3 numbers", {{"type", "point"}, {"color", {1, 1, 1, 1}}}},
        {"/color/1: is -1 but must", {{"type", "point"}, {"color", {1, -1, 1}}}},
        {"/color/0: is 2 but must", {{"type", "point"}, {"color", {2, 1, 1}}}},
        {"/range: is 0 but must be positive", {{"type", "point"}, {"range", 0}}},
        {"/name: must be a string", {{"type", "point"}, {"name", 3}}},
        {"/spot: is missing", {{"type", "spot"}}},
        {"/spot: must be an object", cones(1)},
        {"/spot/innerConeAngle: is 0.2 but must lie in [0, 0.1)",
         cones({{"innerConeAngle", 0.2}, {"outerConeAngle", 0.1}})},
        {"/spot/innerConeAngle: is 0.1 but must", cones({{"innerConeAngle", 0.1}, {"outerConeAngle", 0.1}})},
        {"/spot/innerConeAngle: is 0.8 but must", cones({{"innerConeAngle", 0.8}})},
        {"/spot/innerConeAngle: is -0.1 but must", cones({{"innerConeAngle", -0.1}})},
        {"/spot/outerConeAngle: is 0 but must", cones({{"outerConeAngle", 0}})},
        {"/spot/outerConeAngle: is 1.5708 but must", cones({{"outerConeAngle", 1.5708}})},
        {": must be an object", 3},
    };
    for (const auto& [expected, light] : cases)
        EXPECT_MENTIONS(failure(documentWithLight(light)),
                        std::string("/extensions/KHR_lights_punctual/lights/0") + expected);
}

TEST_F(LoadTest, MalformedReferencesToLightsAreRefused) {
    json document = documentWithLight({{"type", "point"}});
    json& reference = document["nodes"][1]["extensions"]["KHR_lights_punctual"];
    reference["light"] = 1;
    EXPECT_MENTIONS(failure(document), "/nodes/1/extensions/KHR_lights_punctual/light: refers to KHR_lights_punctual "
                                       "lights 1, but there are only 1");
    reference = json::object();
    EXPECT_MENTIONS(failure(document), "/nodes/1/extensions/KHR_lights_punctual/light: is missing");
    document.erase("extensions");
    reference["light"] = 0;
    EXPECT_MENTIONS(failure(document), "/nodes/1/extensions/KHR_lights_punctual/light: refers to");
    document["extensions"]["KHR_lights_punctual"] = json::object();
    EXPECT_MENTIONS(failure(document), "/extensions/KHR_lights_punctual/lights: is missing");
    document["extensions"]["KHR_lights_punctual"]["lights"] = 1;
    EXPECT_MENTIONS(failure(document), "/extensions/KHR_lights_punctual/lights: must be an array");
}

TEST_F(LoadTest, HemisphereLightOfTheChosenScene) {
    json document = triangleDocument();
    EXPECT_FALSE(load(document).environment.emits());
    document["scenes"][0]["extras"]["cgl_hemisphere_light"] = {{"radiance", {1, 0.5, 2}}, {"up", {0, 1, 0}}};
    document["scenes"].push_back({{"nodes", {0}}, {"extras", "of any type"}});
    const Scene scene = load(document);
    EXPECT_EQ(scene.environment.radiance, Vec3d(1, 0.5, 2));
    EXPECT_EQ(scene.environment.extent, EnvironmentExtent::upperHalf);
    EXPECT_TRUE(scene.warnings.empty());
    document["scene"] = 1;
    EXPECT_FALSE(load(document).environment.emits());
    document["scenes"] = {{{"extras", document["scenes"][0]["extras"]}}};
    document.erase("scene");
    EXPECT_TRUE(load(document).warnings.empty()); // a sky alone can be rendered
}

TEST_F(LoadTest, MalformedHemisphereLightsAreRefused) {
    const std::vector<std::pair<const char*, json>> cases = {
        {": must be an object", 1},
        {"/radiance: is missing", json::object()},
        {"/radiance: must have 3 numbers", {{"radiance", {1, 1}}}},
        {"/radiance/2: is -1 but must", {{"radiance", {1, 1, -1}}}},
        {"/up: is not (0, 1, 0)", {{"radiance", {1, 1, 1}}, {"up", {0, 0, 1}}}},
    };
    for (const auto& [expected, light] : cases) {
        json document = triangleDocument();
        document["scenes"][0]["extras"]["cgl_hemisphere_light"] = light;
        EXPECT_MENTIONS(failure(document), std::string("/scenes/0/extras/cgl_hemisphere_light") + expected);
    }
}

} // namespace
} // namespace isolux::load_test

// Triangles as one geometry without shared vertices, spheres as another.
#include "embree_scene.h"

#include "core/error.h"

#include <string>

namespace isolux::bench {
namespace {

constexpr unsigned kTriangles = 0; // ids of the two geometries
constexpr unsigned kSpheres = 1;

void check(RTCDevice device, std::string_view doing) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE) throwFailure("Embree", std::string(doing) + ": error " + std::to_string(error));
}

void attach(RTCScene scene, RTCGeometry geometry, unsigned id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry); // the scene holds it
}

void attachTriangles(RTCDevice device, RTCScene scene, const EmbreeGeometry& source) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto& triangles = source.triangles();
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, source.vertices().data(), 0,
                               3 * sizeof(float), 3 * triangles.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               3 * sizeof(std::uint32_t), triangles.size());
    attach(scene, geometry, kTriangles);
}

void attachSpheres(RTCDevice device, RTCScene scene, const std::vector<glm::vec4>& spheres) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, spheres.data(), 0,
                               sizeof(glm::vec4), spheres.size());
    attach(scene, geometry, kSpheres);
}

RTCRayHit rayOf(const Ray<float>& ray) {
    RTCRayHit found{};
    found.ray.org_x = ray.origin.x;
    found.ray.org_y = ray.origin.y;
    found.ray.org_z = ray.origin.z;
    found.ray.dir_x = ray.direction.x;
    found.ray.dir_y = ray.direction.y;
    found.ray.dir_z = ray.direction.z;
    found.ray.tfar = ray.tMax;
    found.ray.mask = ~0u;
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return found;
}

} // namespace

EmbreeGeometry::EmbreeGeometry(const World<float>& world) {
    for (const WorldTriangle<float>& triangle : world.triangles) {
        const auto first = static_cast<std::uint32_t>(vertices_.size() / 3);
        for (const Vec3f& position : triangle.positions)
            vertices_.insert(vertices_.end(), {position.x, position.y, position.z});
        triangles_.push_back({first, first + 1, first + 2});
    }
    vertices_.push_back(0.0f);
    for (const WorldSphere<float>& sphere : world.spheres) spheres_.emplace_back(sphere.center, sphere.radius);
}

EmbreeDevice openEmbree() {
    EmbreeDevice device(rtcNewDevice(nullptr), rtcReleaseDevice);
    check(device.get(), "opening");
    return device;
}

EmbreeScene::EmbreeScene(const EmbreeDevice& device, const EmbreeGeometry& geometry, EmbreeEdges edges)
    : scene_(rtcNewScene(device.get()), rtcReleaseScene),
      triangleCount_(static_cast<std::uint32_t>(geometry.triangles().size())) {
    rtcSetSceneFlags(scene_.get(), edges == EmbreeEdges::robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    if (!geometry.triangles().empty()) attachTriangles(device.get(), scene_.get(), geometry);
    if (!geometry.spheres().empty()) attachSpheres(device.get(), scene_.get(), geometry.spheres());
    rtcCommitScene(scene_.get());
    check(device.get(), "building");
}

std::uint32_t EmbreeScene::nearest(const Ray<float>& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found = rayOf(ray);
    rtcIntersect1(scene_.get(), &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return kNoPrimitive;
    return found.hit.geomID == kTriangles ? found.hit.primID : triangleCount_ + found.hit.primID;
}

} // namespace isolux::bench

// A scene as plain data, in object space and double transforms. Both renderers read this and nothing else.
#pragma once

#include "core/math.h"

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isolux {

/// What the file stores for a texel, up to four channels; grey is repeated in red, green and blue, missing alpha is
/// full.
using Texel8 = glm::vec<4, std::uint8_t>;
using Texel16 = glm::vec<4, std::uint16_t>;

/// Pixels as stored, row 0 at the top: unsigned integers that stand for [0, 1]. One of the two lists is empty.
struct TextureImage {
    std::string name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<Texel8> texels8;
    std::vector<Texel16> texels16;
};

enum class TextureWrap : std::uint32_t { repeat, mirroredRepeat, clampToEdge };
enum class TextureFilter : std::uint32_t { nearest, linear };

/// Which image, and how it is read between and beyond its texels. There are no smaller levels: many samples a pixel
/// average what a rasteriser must filter in advance.
struct Texture {
    std::uint32_t image = 0;
    TextureWrap wrapU = TextureWrap::repeat;
    TextureWrap wrapV = TextureWrap::repeat;
    TextureFilter filter = TextureFilter::linear;
};

inline constexpr std::uint32_t kNoTexture = 0xFFFFFFFFu;

/// A use of a texture by a material: which coordinates of the mesh, and how they are transformed
/// (KHR_texture_transform).
struct TextureMap {
    std::uint32_t texture = kNoTexture;
    std::uint32_t uvSet = 0;
    glm::dmat2 uvFromMesh{1.0}; ///< texture coordinates = uvFromMesh * (u, v) + offset
    Vec2d offset{0.0};

    [[nodiscard]] bool present() const { return texture != kNoTexture; }
};

/// What a map multiplies or replaces, and the channels it is read from.
enum class MapSlot : std::uint32_t {
    baseColor,         ///< RGB sRGB, times baseColor; A linear, times alpha
    metallicRoughness, ///< G times roughness, B times metallic
    normal,            ///< RGB = (n + 1)/2 in the tangent frame; x and y times normalScale
    emission,          ///< RGB sRGB, times emission
    transmission,      ///< R times transmission
    thickness,         ///< G times thickness
    specular,          ///< A times specular
    specularColor,     ///< RGB sRGB, times specularColor
};
inline constexpr std::size_t kMapSlots = 8;

/// Whether a slot's RGB is stored by the sRGB transfer function. Alpha never is.
[[nodiscard]] constexpr bool isSrgb(MapSlot slot) {
    return slot == MapSlot::baseColor || slot == MapSlot::emission || slot == MapSlot::specularColor;
}

enum class AlphaMode : std::uint32_t { opaque, mask, blend };

/// glTF's metallic-roughness surface with the extensions named beside the fields. Colours are linear Rec. 709. As it
/// stands it is a white Lambertian surface; README.md, "Surfaces", says what every number does.
/// Lobes of less roughness than the square root of this are delta lobes (as bsdf.glsl's, which shares it).
inline constexpr double kSmallestAlpha = 1e-5;
/// Of a normal map; single precision holds its square.
inline constexpr double kLargestNormalScale = 1e15;

struct Material {
    std::string name;
    Vec3d baseColor{
        1.0};            ///< albedo of the diffuse base, reflectance of a metal, tint of what is transmitted; in [0, 1]
    Vec3d emission{0.0}; ///< emitted radiance, W/(sr m^2), from the front face (and the back face if doubleSided)
    bool doubleSided = false;  ///< the back face emits too, and BackFaces::culled leaves it there
    double metallic = 0.0;     ///< in [0, 1]
    double roughness = 1.0;    ///< in [0, 1]; alpha of GGX is its square
    double ior = 1.5;          ///< index of refraction, at least 1 (KHR_materials_ior)
    double specular = 0.0;     ///< in [0, 1]: how much of the dielectric's reflection there is (KHR_materials_specular)
    Vec3d specularColor{1.0};  ///< at least 0: of the dielectric's reflection at normal incidence
    double transmission = 0.0; ///< in [0, 1]: how much of the base transmits (KHR_materials_transmission)
    double thickness = 0.0;    ///< above 0 the surface bounds a solid; 0: a thin wall (KHR_materials_volume)
    Vec3d attenuationColor{1.0}; ///< in [0, 1]: what is left of white after attenuationDistance inside the solid
    double attenuationDistance = std::numeric_limits<double>::infinity(); ///< world units, above 0
    AlphaMode alphaMode = AlphaMode::opaque;
    double alpha = 1.0; ///< coverage, in [0, 1]
    double alphaCutoff = 0.5;
    double normalScale = 1.0;
    bool unlit = false; ///< shows baseColor whatever light there is (KHR_materials_unlit)
    std::array<TextureMap, kMapSlots> maps{};

    [[nodiscard]] const TextureMap& map(MapSlot slot) const { return maps[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] bool emits() const { return maxComponent(emission) > 0.0 && !unlit; }
    /// Whether BackFaces::culled takes its back away: never of what transmits, for rays leave it through there.
    [[nodiscard]] bool isSingleSided() const { return !doubleSided && transmission == 0.0; }
};

/// Triangles in object space, counter-clockwise seen from the front. Attributes have one entry a position, or none.
struct Mesh {
    std::string name;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals; ///< empty: the mesh is shaded flat
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::uint32_t material = 0;
    std::vector<std::vector<Vec2<float>>> uvs{}; ///< sets of texture coordinates, as many as materials may refer to
    std::vector<glm::vec4> colors{};             ///< linear RGB and alpha, times the base colour; in [0, 1]
    std::vector<glm::vec4> tangents{};           ///< unit; w: 1 or -1, the sign of the bitangent
};

/// One placement of a mesh in the world.
struct Instance {
    std::string name;
    std::uint32_t mesh = 0;
    Mat4d worldFromObject{1.0};
};

/// An exact sphere in world space.
struct Sphere {
    std::string name;
    Vec3d center{0.0};
    double radius = 1.0;
    std::uint32_t material = 0;
};

enum class Projection { perspective, orthographic };

/// A camera looking along -z of its own frame, +y up, as glTF has it. Near and far planes do not clip.
struct Camera {
    std::string name;
    Projection projection = Projection::perspective;
    Vec3d position{0.0};
    Mat3d worldFromCamera{1.0};        ///< columns right, up, backward: orthonormal
    double yfov = 0.7;                 ///< perspective: full vertical field of view in radians
    double ymag = 1.0;                 ///< orthographic: half the height of what is seen, a length in the world
    std::optional<double> aspectRatio; ///< width / height the file asks for; the image's own decides
};

enum class PunctualKind { point, spot, directional };

/// A light without extent (KHR_lights_punctual). Its range, a hint to rasterisers, is not part of it.
struct PunctualLight {
    std::string name;
    PunctualKind kind = PunctualKind::point;
    Vec3d position{0.0};                ///< point and spot
    Vec3d direction{0.0, 0.0, -1.0};    ///< unit: where the light travels to; spot and directional
    Vec3d intensity{1.0};               ///< point and spot: W/sr; directional: W/m^2 on a surface that faces it
    double cosInner = 1.0;              ///< spot: of the angle up to which it shines in full
    double cosOuter = 0.70710678118655; ///< spot: of the angle from which on it is dark; less than cosInner
};

/// The share of a spot's intensity at the cosine of an angle to its axis: t^2 with t from 0 at the outer cone to 1 at
/// the inner one, linear in the cosine (KHR_lights_punctual, "Inner and outer cone angles").
template <typename Real> [[nodiscard]] Real spotAttenuation(const PunctualLight& light, Real cosine) {
    const Real outer = static_cast<Real>(light.cosOuter);
    const Real t = (cosine - outer) / (static_cast<Real>(light.cosInner) - outer);
    const Real clamped = std::clamp(t, Real(0), Real(1));
    return clamped * clamped;
}

enum class EnvironmentExtent { sphere, upperHalf };

/// An equirectangular image of what comes from infinitely far: row 0 is +y, the middle of a row is -z, and columns to
/// the right lie towards +x.
struct EnvironmentMap {
    std::string name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<Vec3f> texels; ///< linear Rec. 709, finite, not negative
};

/// Radiance from infinitely far away; the camera sees it. Constant, or that of a map times `radiance`.
struct Environment {
    Vec3d radiance{0.0};                                  ///< W/(sr m^2); zero: there is none
    EnvironmentExtent extent = EnvironmentExtent::sphere; ///< upperHalf: from directions with y > 0 alone; no map then
    std::shared_ptr<const EnvironmentMap> map{};          ///< may be empty; one that is all black is none
    double rotation = 0.0; ///< of the map about +y, in turns, counter-clockwise seen from above

    [[nodiscard]] bool emits() const { return maxComponent(radiance) > 0.0; }
    /// Of the directions from which a constant environment emits.
    [[nodiscard]] double solidAngle() const { return (extent == EnvironmentExtent::sphere ? 4.0 : 2.0) * kPi; }
};

/// A vertex in the world, in double: float could not hold it far from the origin.
[[nodiscard]] inline Vec3d transformPoint(const Mat4d& worldFromObject, const Vec3f& point) {
    return Vec3d(worldFromObject * glm::dvec4(Vec3d(point), 1.0));
}

struct Scene {
    std::string name;
    std::vector<TextureImage> images;
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Sphere> spheres;
    std::vector<Camera> cameras;
    std::vector<PunctualLight> punctualLights;
    Environment environment;
    std::vector<std::string> warnings; ///< what the file asks for and is not supported, by name
    std::string contentHash;           ///< hexadecimal hash of the file and everything it refers to
};

/// Number of primitives: the triangles of every instance in order, then the spheres. A primitive's index in this
/// order is its id everywhere (lights, hits, signatures).
[[nodiscard]] std::size_t primitiveCount(const Scene& scene);

/// Which of the scene's materials a placed mesh or a sphere has.
[[nodiscard]] std::vector<bool> materialsInUse(const Scene& scene);

/// World-space bounds of all vertices and spheres; empty if there are none.
[[nodiscard]] Box3d worldBounds(const Scene& scene);

/// The same scene elsewhere: whatever has a place in it is moved alike. The image stays the same but for rounding.
[[nodiscard]] Scene moved(Scene scene, const Vec3d& by);

/// Half the diagonal of the world bounds: how large a disc lights from afar illuminate. Zero if there is nothing.
[[nodiscard]] double worldRadius(const Scene& scene);

/// A camera that sees the whole scene from the front, slightly from above; for files that bring none.
[[nodiscard]] Camera frameScene(const Scene& scene);

/// Checks what both renderers rely on (indices in range, finite numbers, factors in the ranges above, a texture's image
/// of as many texels as it says, texture coordinates for every map of a mesh's material, tangents beside normal maps, a
/// size between 1e-30 and 1e30); throws Error naming the offender. A loader calls it last.
void validate(const Scene& scene);

} // namespace isolux

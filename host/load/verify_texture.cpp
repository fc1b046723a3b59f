// Textures, samplers and images: references, enumerations, and how a material's map finds its coordinates.
#include "load/verify.h"
#include "load/verify_parts.h"

#include <fmt/format.h>

#include <cmath>

namespace isolux {
namespace {

constexpr std::uint64_t kNearest = 9728;
constexpr std::uint64_t kLinear = 9729;
constexpr std::uint64_t kNearestMipmapNearest = 9984;
constexpr std::uint64_t kLinearMipmapLinear = 9987;

TextureWrap wrapOr(const JsonReader& sampler, std::string_view key, TextureWrap fallback) {
    const std::optional<JsonReader> wrap = sampler.find(key);
    if (!wrap) return fallback;
    switch (wrap->integer()) {
    case 10497: return TextureWrap::repeat;
    case 33648: return TextureWrap::mirroredRepeat;
    case 33071: return TextureWrap::clampToEdge;
    default: wrap->fail(fmt::format("is {} but must be 10497, 33648 or 33071", wrap->integer()));
    }
}

TextureFilter filterOr(const JsonReader& sampler, TextureFilter fallback) {
    const std::optional<JsonReader> filter = sampler.find("magFilter");
    if (!filter) return fallback;
    return filter->integerBetween(kNearest, kLinear) == kNearest ? TextureFilter::nearest : TextureFilter::linear;
}

/// Smaller levels of images are not made, so that this filter has no effect; a number that is none is an error still.
void verifyMinFilter(const JsonReader& sampler) {
    const std::optional<JsonReader> filter = sampler.find("minFilter");
    if (!filter) return;
    const std::uint64_t value = filter->integer();
    if (value != kNearest && value != kLinear && !(value >= kNearestMipmapNearest && value <= kLinearMipmapLinear))
        filter->fail(fmt::format("is {} but must be 9728, 9729 or 9984 to 9987", value));
}

Texture verifySampler(const JsonReader& sampler) {
    Texture texture;
    texture.wrapU = wrapOr(sampler, "wrapS", texture.wrapU);
    texture.wrapV = wrapOr(sampler, "wrapT", texture.wrapV);
    texture.filter = filterOr(sampler, texture.filter);
    verifyMinFilter(sampler);
    return texture;
}

/// The image of a texture; that of EXT_texture_webp comes before the one for readers that do not know it.
std::optional<std::uint32_t> verifySource(const JsonReader& texture, const JsonReader& root) {
    const auto sourceOf = [&](const JsonReader& owner) -> std::optional<std::uint32_t> {
        const std::optional<JsonReader> source = owner.find("source");
        if (!source) return std::nullopt;
        return static_cast<std::uint32_t>(source->index(root.sizeOf("images"), "images"));
    };
    const std::optional<std::uint32_t> fallback = sourceOf(texture);
    const std::optional<JsonReader> webp = findExtension(texture, "EXT_texture_webp");
    const std::optional<std::uint32_t> image = webp ? sourceOf(*webp) : std::nullopt;
    return image ? image : fallback;
}

FileTexture verifyTexture(const JsonReader& texture, const JsonReader& root) {
    FileTexture result{verifySource(texture, root)};
    if (const std::optional<JsonReader> sampler = texture.find("sampler"))
        result.sampling = verifySampler(sampler->elementOf(root, "samplers"));
    return result;
}

/// texture coordinates = translation * rotation * scale * coordinates of the mesh (KHR_texture_transform). Coordinates
/// turn counter-clockwise as an image is seen, its v growing downwards: (1, 0) towards (cos, -sin).
void readTransform(const JsonReader& transform, TextureMap& map) {
    const auto pairOr = [&](std::string_view key, const Vec2d& fallback) {
        if (!transform.find(key)) return fallback;
        const nlohmann::json values = transform.at(key).numbersBetween(2, -kLargestRadiance, kLargestRadiance);
        return Vec2d(values[0].get<double>(), values[1].get<double>());
    };
    const std::optional<JsonReader> rotation = transform.find("rotation");
    const double angle = rotation ? rotation->numberBetween(-kLargestRadiance, kLargestRadiance) : 0.0;
    const Vec2d scale = pairOr("scale", Vec2d(1.0));
    const Vec2d uAxis = scale.x * Vec2d(std::cos(angle), -std::sin(angle));
    const Vec2d vAxis = scale.y * Vec2d(std::sin(angle), std::cos(angle));
    map.uvFromMesh = glm::dmat2(uAxis, vAxis);
    map.offset = pairOr("offset", Vec2d(0.0));
}

std::uint32_t setOr(const JsonReader& owner, std::uint32_t fallback) {
    const std::optional<JsonReader> set = owner.find("texCoord");
    return set ? static_cast<std::uint32_t>(set->integerBetween(0, 0xFFFFFFFFu)) : fallback;
}

} // namespace

std::uint32_t uvSetOf(const JsonReader& info) {
    const std::uint32_t set = setOr(info, 0);
    const std::optional<JsonReader> transform = findExtension(info, "KHR_texture_transform");
    return transform ? setOr(*transform, set) : set;
}

TextureMap verifyTextureMap(const JsonReader& info, const JsonReader& root) {
    TextureMap map;
    const std::size_t texture = info.at("index").index(root.sizeOf("textures"), "textures");
    map.uvSet = uvSetOf(info);
    if (const std::optional<JsonReader> transform = findExtension(info, "KHR_texture_transform"))
        readTransform(*transform, map);
    const JsonReader source = root.at("textures").element(texture);
    if (verifyTexture(source, root).image)
        map.texture = static_cast<std::uint32_t>(texture);
    else
        source.warn("has no image of a format that is supported; maps that use it are left out");
    return map;
}

std::vector<FileTexture> verifyTextures(const JsonReader& root) {
    std::vector<FileTexture> textures;
    for (std::size_t i = 0; i < root.sizeOf("samplers"); ++i) (void)verifySampler(root.at("samplers").element(i));
    for (std::size_t i = 0; i < root.sizeOf("textures"); ++i)
        textures.push_back(verifyTexture(root.at("textures").element(i), root));
    return textures;
}

/// An image comes from a file or from a bufferView (glTF 2.0, 5.11).
void verifyImages(const JsonReader& root) {
    for (std::size_t i = 0; i < root.sizeOf("images"); ++i) {
        const JsonReader image = root.at("images").element(i);
        const std::optional<JsonReader> uri = image.find("uri");
        const std::optional<JsonReader> view = image.find("bufferView");
        if (uri.has_value() == view.has_value()) image.fail("must have either a uri or a bufferView");
        if (uri) (void)uri->string();
        if (view) (void)view->index(root.sizeOf("bufferViews"), "bufferViews");
        if (const std::optional<JsonReader> type = image.find("mimeType")) (void)type->string();
        if (const std::optional<JsonReader> name = image.find("name")) (void)name->string();
    }
}

} // namespace isolux

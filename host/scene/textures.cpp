#include "scene/textures.h"

#include "core/srgb.h"

#include <algorithm>

namespace isolux {
namespace {

/// Linear values of all codes of an integer type; there are few enough to decode each once.
template <typename Code> const std::vector<double>& linearOfCodes() {
    static const std::vector<double> values = [] {
        constexpr std::uint32_t kLargest = std::numeric_limits<Code>::max();
        std::vector<double> table(kLargest + 1);
        for (std::uint32_t code = 0; code <= kLargest; ++code)
            table[code] = linearFromSrgb(code / static_cast<double>(kLargest));
        return table;
    }();
    return values;
}

template <typename Code> glm::dvec4 decode(const glm::vec<4, Code>& texel, MapSlot slot) {
    const glm::dvec4 stored = glm::dvec4(texel) / static_cast<double>(std::numeric_limits<Code>::max());
    if (!isSrgb(slot)) return stored;
    const std::vector<double>& linear = linearOfCodes<Code>();
    return {linear[texel.x], linear[texel.y], linear[texel.z], stored.w};
}

/// Which channels a slot reads: 0 red, 1 green, 2 blue, 3 alpha.
struct Channels {
    int first;
    int last;
};
Channels channelsOf(MapSlot slot) {
    switch (slot) {
    case MapSlot::baseColor: return {0, 3};
    case MapSlot::metallicRoughness: return {1, 2};
    case MapSlot::normal:
    case MapSlot::emission:
    case MapSlot::specularColor: return {0, 2};
    case MapSlot::transmission: return {0, 0};
    case MapSlot::thickness: return {1, 1};
    case MapSlot::specular: return {3, 3};
    }
    return {0, 3};
}

template <typename Texel> bool allAgree(const std::vector<Texel>& texels, Channels channels) {
    return std::all_of(texels.begin(), texels.end(), [&](const Texel& texel) {
        for (int channel = channels.first; channel <= channels.last; ++channel)
            if (texel[channel] != texels.front()[channel]) return false;
        return true;
    });
}

} // namespace

glm::dvec4 decodedTexel(const TextureImage& image, std::size_t index, MapSlot slot) {
    return image.texels16.empty() ? decode(image.texels8[index], slot) : decode(image.texels16[index], slot);
}

std::uint32_t texelIndex(double s, std::uint32_t size, TextureWrap wrap) {
    const double n = size;
    double i = std::isfinite(s) ? std::floor(s) : 0.0;
    // In double throughout: a coordinate may be far beyond every integer.
    if (wrap == TextureWrap::repeat) i -= n * std::floor(i / n);
    if (wrap == TextureWrap::mirroredRepeat) {
        i -= 2.0 * n * std::floor(i / (2.0 * n));
        if (i >= n) i = 2.0 * n - 1.0 - i;
    }
    return static_cast<std::uint32_t>(std::clamp(i, 0.0, n - 1.0));
}

glm::dvec4 nearestValue(const Scene& scene, const TextureMap& map, MapSlot slot, const Vec2d& meshUv) {
    const Texture& texture = scene.textures[map.texture];
    const TextureImage& image = scene.images[texture.image];
    const Vec2d uv = map.uvFromMesh * meshUv + map.offset;
    const std::size_t column = texelIndex(uv.x * image.width, image.width, texture.wrapU);
    const std::size_t row = texelIndex(uv.y * image.height, image.height, texture.wrapV);
    return decodedTexel(image, row * image.width + column, slot);
}

std::optional<glm::dvec4> constantValue(const Scene& scene, const TextureMap& map, MapSlot slot) {
    const TextureImage& image = scene.images[scene.textures[map.texture].image];
    const Channels channels = channelsOf(slot);
    if (!allAgree(image.texels8, channels) || !allAgree(image.texels16, channels)) return std::nullopt;
    return decodedTexel(image, 0, slot);
}

} // namespace isolux

#include "load/environment_file.h"

#include "load/bytes.h"
#include "load/context.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace isolux {
namespace {

constexpr int kMostChannels = 1024;
constexpr double kMostTexels = 0x1p28;

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& file, const LoadContext& context) {
    requireRegularFile(file, {context, ""});
    OIIO::attribute("limits:channels", kMostChannels);
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(kMostTexels * sizeof(double) * 4 / 0x1p20));
    auto input = OIIO::ImageInput::open(file.string());
    if (!input) context.fail("", "not an image that can be read: " + printable(OIIO::geterror()));
    return input;
}

/// What a header may say before any memory is taken for it.
void requireReasonable(const OIIO::ImageSpec& spec, const LoadContext& context) {
    const auto require = [&](bool holds, std::string_view message) {
        if (!holds) context.fail("", message);
    };
    require(spec.width >= 1 && spec.height >= 1 && spec.depth <= 1 && !spec.deep, "not a two-dimensional image");
    require(static_cast<double>(spec.width) * spec.height <= kMostTexels, "larger than the limit of 2^28 texels");
    require(spec.nchannels >= 1 && spec.nchannels <= kMostChannels, "more channels than the limit of 1024");
    require(spec.format.is_floating_point(),
            "its texels are integers, which cannot hold a sky; an environment map is Radiance .hdr or OpenEXR");
    require(spec.x == spec.full_x && spec.y == spec.full_y && spec.width == spec.full_width &&
                spec.height == spec.full_height,
            "its data window differs from its display window: crop or pad it first");
    require(spec.get_int_attribute("Orientation", 1) == 1, "its rows do not run from the top left: save it upright");
}

/// OpenImageIO puts red, green and blue first, in whatever order a file has them.
std::vector<Vec3f> readTexels(OIIO::ImageInput& input, const LoadContext& context) {
    const OIIO::ImageSpec spec = input.spec();
    const int channels = spec.nchannels < 3 ? 1 : 3;
    std::vector<Vec3f> texels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    if (!input.read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, texels.data(), sizeof(Vec3f)))
        context.fail("", "cannot be decoded: " + printable(input.geterror()));
    if (channels == 1)
        for (Vec3f& texel : texels) texel = Vec3f(texel.x);
    return texels;
}

void requireRadiance(const EnvironmentMap& map, const LoadContext& context) {
    for (std::size_t i = 0; i < map.texels.size(); ++i) {
        const Vec3f& t = map.texels[i];
        if (isFinite(t) && std::min({t.x, t.y, t.z}) >= 0.0f) continue;
        context.fail("", fmt::format("texel ({}, {}) is ({}, {}, {}); radiance is finite and not negative",
                                     i % map.width, i / map.width, t.x, t.y, t.z));
    }
}

} // namespace

std::shared_ptr<const EnvironmentMap> loadEnvironmentMap(const std::filesystem::path& file) {
    const LoadContext context(file.string());
    const auto input = open(file, context);
    requireReasonable(input->spec(), context);
    auto map = std::make_shared<EnvironmentMap>();
    map->name = file.filename().string();
    map->width = static_cast<std::uint32_t>(input->spec().width);
    map->height = static_cast<std::uint32_t>(input->spec().height);
    map->texels = readTexels(*input, context);
    requireRadiance(*map, context);
    return map;
}

} // namespace isolux

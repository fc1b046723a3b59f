#include "load/environment_file.h"

#include "load/bytes.h"
#include "load/context.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>

namespace isolux {
namespace {

using namespace std::string_view_literals;

constexpr int kMostChannels = 1024;

/// A format: OpenImageIO's name of it, how its files begin, and how many texels a byte can hold at most.
struct Format {
    const char* name;
    std::string_view start;
    double texelsPerByte;
};

/// Radiance: runs of up to 127 equal bytes take two bytes, and a texel has four of them in separate runs. OpenEXR: the
/// densest of its compressions, DWA, deflates (1032 bytes of one at most) one value for 8 x 8 texels.
constexpr std::array<Format, 2> kFormats = {{
    {"hdr", "#?"sv, 127.0 / 8.0},
    {"openexr", "\x76\x2F\x31\x01"sv, 64.0 * 1032.0},
}};

/// Told by the first bytes: OpenImageIO left to itself would offer the file to every reader it has.
const Format& formatOf(const std::filesystem::path& file, const LoadContext& context) {
    std::array<char, 4> start{};
    std::ifstream(file, std::ios::binary).read(start.data(), start.size());
    const std::string_view text(start.data(), start.size());
    for (const Format& format : kFormats)
        if (text.starts_with(format.start)) return format;
    context.fail("", "neither Radiance .hdr nor OpenEXR by its first bytes; an environment map is one of these");
}

std::unique_ptr<OIIO::ImageInput> open(const std::filesystem::path& file, const Format& format,
                                       const LoadContext& context) {
    OIIO::attribute("limits:channels", kMostChannels);
    const double mostBytes = context.limits().environmentTexels * sizeof(double) * 4;
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(std::ceil(mostBytes / 0x1p20)));
    auto input = OIIO::ImageInput::create(format.name);
    OIIO::ImageSpec spec;
    if (!input || !input->open(file.string(), spec))
        context.fail("", "not an image that can be read: " + printable(input ? input->geterror() : OIIO::geterror()));
    return input;
}

/// What a header may say before any memory is taken for it.
void requireReasonable(const OIIO::ImageSpec& spec, double fileTexels, const LoadContext& context) {
    const auto require = [&](bool holds, std::string_view message) {
        if (!holds) context.fail("", message);
    };
    require(spec.width >= 1 && spec.height >= 1 && spec.depth <= 1 && !spec.deep, "not a two-dimensional image");
    const double texels = static_cast<double>(spec.width) * spec.height;
    require(texels <= context.limits().environmentTexels, "larger than the limit of 2^28 texels");
    require(texels <= fileTexels, "it claims more texels than its bytes can hold");
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

std::shared_ptr<const EnvironmentMap> loadEnvironmentMap(const std::filesystem::path& file, const LoadLimits& limits) {
    const LoadContext context(file.string(), limits);
    requireRegularFile(file, {context, ""});
    const Format& format = formatOf(file, context);
    const auto input = open(file, format, context);
    const auto fileBytes = static_cast<double>(std::filesystem::file_size(file));
    requireReasonable(input->spec(), format.texelsPerByte * fileBytes, context);
    auto map = std::make_shared<EnvironmentMap>();
    map->name = file.filename().string();
    map->width = static_cast<std::uint32_t>(input->spec().width);
    map->height = static_cast<std::uint32_t>(input->spec().height);
    map->texels = readTexels(*input, context);
    requireRadiance(*map, context);
    return map;
}

} // namespace isolux

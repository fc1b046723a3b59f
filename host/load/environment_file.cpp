#include "load/environment_file.h"

#include "load/bytes.h"
#include "load/context.h"
#include "load/exr_header.h"
#include "load/memory_reader.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace isolux {
namespace {

using namespace std::string_view_literals;

constexpr int kMostChannels = 1024;
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 34;
constexpr std::string_view kExr = "openexr";

/// A format: OpenImageIO's name of it, how its files begin, and how many texels a byte can hold at most.
struct Format {
    std::string_view name;
    std::string_view start;
    double texelsPerByte;
};

/// Radiance: runs of up to 127 equal bytes take two bytes, and a texel has four of them in separate runs. OpenEXR: the
/// densest of its compressions, DWA, deflates (1032 bytes of one at most) one value for 8 x 8 texels.
constexpr std::array<Format, 2> kFormats = {{
    {"hdr", "#?"sv, 127.0 / 8.0},
    {kExr, "\x76\x2F\x31\x01"sv, 64.0 * 1032.0},
}};

/// Told by the first bytes: OpenImageIO left to itself would offer the file to every reader it has.
const Format& formatOf(ByteSpan bytes, const LoadContext& context) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const Format& format : kFormats)
        if (text.starts_with(format.start)) return format;
    context.fail("", "neither Radiance .hdr nor OpenEXR by its first bytes; an environment map is one of these");
}

void setLimits(const LoadLimits& limits) {
    OIIO::attribute("limits:channels", kMostChannels);
    const double mostBytes = limits.environmentTexels * sizeof(double) * 4;
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(std::ceil(mostBytes / 0x1p20)));
}

/// OpenImageIO's decoder of a file, whose bytes are in memory.
class Decoder {
public:
    Decoder(Bytes bytes, const Format& format, const LoadContext& context)
        : bytes_(std::move(bytes)), reader_(bytes_), input_(OIIO::ImageInput::create(std::string(format.name))) {
        setLimits(context.limits());
        OIIO::ImageSpec spec;
        if (!input_ || !input_->set_ioproxy(&reader_))
            context.fail("", fmt::format("OpenImageIO of this build reads no {} from memory", format.name));
        if (!input_->open(fmt::format("image.{}", format.name), spec))
            context.fail("", "not an image that can be read: " + printableLines(input_->geterror()));
    }

    [[nodiscard]] OIIO::ImageInput& input() { return *input_; }

private:
    Bytes bytes_;
    MemoryReader reader_;
    std::unique_ptr<OIIO::ImageInput> input_;
};

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
        context.fail("", "cannot be decoded: " + printableLines(input.geterror()));
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
    Bytes bytes = readRegularFile(file, {context, "", kLargestFile});
    const Format& format = formatOf(bytes, context);
    const double fileTexels = format.texelsPerByte * static_cast<double>(bytes.size());
    if (format.name == kExr) tameExrHeader(bytes, std::min(limits.environmentTexels, fileTexels), context);
    Decoder decoder(std::move(bytes), format, context);
    OIIO::ImageInput& input = decoder.input();
    requireReasonable(input.spec(), fileTexels, context);
    auto map = std::make_shared<EnvironmentMap>();
    map->name = file.filename().string();
    map->width = static_cast<std::uint32_t>(input.spec().width);
    map->height = static_cast<std::uint32_t>(input.spec().height);
    map->texels = readTexels(input, context);
    requireRadiance(*map, context);
    return map;
}

} // namespace isolux

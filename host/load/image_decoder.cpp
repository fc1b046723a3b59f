#include "load/image_decoder.h"

#include "load/context.h"
#include "load/image_metadata.h"
#include "load/memory_reader.h"
#include "load/uri.h"
#include "load/webp.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isolux {
namespace {

using namespace std::string_view_literals;

constexpr int kMostChannels = 4;

/// An image format: its name and that of its MIME type, and how it begins.
struct Format {
    const char* name;
    std::string_view mimeType;
    std::string_view start;
    double bitsPerByte;   ///< of texels that a byte of the file can hold at most
    double anyFileTexels; ///< what a file of any size may hold
};

/// Deflate makes 1032 bytes of one at most (its longest match, 258 bytes, takes two bits). JPEG: 8 x 8 texels take a
/// bit at least (one Huffman code each). Lossless WebP writes one colour with no bits at all, so that its size says
/// nothing; a small file is taken at its word for 64 MiB, a larger one is held to the densest PNG.
constexpr std::array<Format, 3> kFormats = {{
    {"png", "image/png", "\x89PNG\r\n\x1A\n"sv, 8.0 * 1032.0, 0.0},
    {"jpeg", "image/jpeg", "\xFF\xD8\xFF"sv, 8.0 * 64.0, 0.0},
    {"webp", "image/webp", "RIFF"sv, 8.0 * 1032.0, 0x1p24},
}};

std::string_view asText(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Null for a format that is not supported.
const Format* findFormat(const EncodedImage& image) {
    const std::string_view text = asText(image.bytes);
    const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                     [&](const Format& candidate) { return text.starts_with(candidate.start); });
    return format == kFormats.end() ? nullptr : &*format;
}

/// The mimeType, or that of a data URI, is for those who choose by it; the bytes decide.
void warnOfMimeType(const EncodedImage& image, const Format& format) {
    const std::optional<JsonReader> type = image.where.find("mimeType");
    if (type && type->string() != format.mimeType)
        type->warn(fmt::format("is not {}, which the image is; read all the same", format.mimeType));
    const std::optional<JsonReader> uri = image.where.find("uri");
    if (!uri || !isDataUri(uri->string())) return;
    if (const std::string data = mediaTypeOf(uri->string()); data.starts_with("image/") && data != format.mimeType)
        uri->warn(fmt::format("its media type {} is not {}, which the image is; read all the same", printable(data),
                              format.mimeType));
}

/// A whole JPEG has an end marker after its last scan; its decoder fills what is missing with grey. (Markers do not
/// occur within scans; a preview among the metadata has both before the first scan.)
bool isWholeJpeg(std::string_view text) {
    const std::size_t scan = text.rfind("\xFF\xDA"sv);
    const std::size_t end = text.rfind("\xFF\xD9"sv);
    return scan != text.npos && end != text.npos && end > scan;
}

/// Whether chunks (PNG, 5.3: length, name, data, checksum) follow each other up to the last, IEND. OpenImageIO's reader
/// loses memory where the data ends before.
bool isWholePng(ByteSpan png) {
    constexpr std::size_t kAroundData = 12;
    ByteSpan rest = png.subspan(8);
    while (rest.size() >= kAroundData) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | rest[i];
        if (length > rest.size() - kAroundData) return false;
        if (asText(rest.subspan(4, 4)) == "IEND") return true;
        rest = rest.subspan(length + kAroundData);
    }
    return false;
}

void requireWhole(const EncodedImage& image, const Format& format) {
    const bool isWhole = format.mimeType == "image/png"    ? isWholePng(image.bytes)
                         : format.mimeType == "image/jpeg" ? isWholeJpeg(asText(image.bytes))
                                                           : webpSize(image.bytes).has_value();
    if (!isWhole) image.where.fail("its data is cut short or damaged");
}

/// Bits that a texel takes before compression, by depth and colour type of the header (PNG, 11.2.2); 1 for other
/// formats.
double bitsPerTexel(const EncodedImage& image, const Format& format) {
    constexpr std::size_t kDepth = 24, kColorType = 25;
    constexpr std::array<int, 7> kChannels = {1, 1, 3, 1, 2, 1, 4}; // 3: indices; 1 and 5 are none
    if (format.mimeType != "image/png" || image.bytes.size() <= kColorType) return 1.0;
    const std::size_t type = std::min<std::size_t>(image.bytes[kColorType], kChannels.size() - 1);
    return std::max<int>(image.bytes[kDepth], 1) * kChannels[type];
}

/// OpenImageIO's own words, in one line.
std::string reasonOf(const OIIO::ImageInput& input) { return printableLines(input.geterror()); }

void requireReasonableSize(const EncodedImage& image, const Format& format, std::int64_t width, std::int64_t height) {
    const auto fail = [&](const std::string& reason) {
        image.where.fail(fmt::format("it claims {} x {} texels: {}", width, height, reason));
    };
    if (width < 1 || height < 1) fail("no picture");
    const int largest = image.where.context().limits().imageSide;
    if (width > largest || height > largest) fail(fmt::format("at most {} a side are supported", largest));
    const double texels = static_cast<double>(width) * static_cast<double>(height);
    const double bits = format.bitsPerByte * static_cast<double>(image.bytes.size());
    if (texels > std::max(bits / bitsPerTexel(image, format), format.anyFileTexels))
        fail(fmt::format("{} bytes cannot hold them", image.bytes.size()));
}

void requireReasonable(const EncodedImage& image, const Format& format, const OIIO::ImageSpec& spec) {
    requireReasonableSize(image, format, spec.width, spec.height);
    if (spec.depth > 1) image.where.fail("it has layers of depth");
    if (spec.nchannels < 1 || spec.nchannels > kMostChannels)
        image.where.fail(fmt::format("it has {} channels; 1 to 4 are supported", spec.nchannels));
}

/// What was read into the first `channels` places of a texel, as red, green, blue and alpha.
template <typename Texel> void spread(std::vector<Texel>& texels, int channels) {
    constexpr auto kFull = std::numeric_limits<typename Texel::value_type>::max();
    for (Texel& t : texels) switch (channels) {
        case 1: t = Texel(t.r, t.r, t.r, kFull); break;
        case 2: t = Texel(t.r, t.r, t.r, t.g); break;
        case 3: t.a = kFull; break;
        default: return;
        }
}

template <typename Texel>
std::vector<Texel> readTexels(const EncodedImage& image, OIIO::ImageInput& input, OIIO::TypeDesc type) {
    const OIIO::ImageSpec spec = input.spec();
    std::vector<Texel> texels(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height));
    if (!input.read_image(0, 0, 0, spec.nchannels, type, texels.data(), sizeof(Texel)))
        image.where.fail("cannot be decoded: " + reasonOf(input));
    spread(texels, spec.nchannels);
    return texels;
}

/// Of one image as it is decoded; rounded up.
int mostMegabytes(const LoadLimits& limits) {
    const double bytes = static_cast<double>(limits.imageSide) * limits.imageSide * sizeof(Texel16);
    return static_cast<int>(std::ceil(bytes / 0x1p20));
}

/// OpenImageIO's decoder of one image in memory.
class Decoder {
public:
    Decoder(const EncodedImage& image, const Format& format) : kept_(withoutMetadata(image.bytes)), bytes_(kept_) {
        requireWhole(image, format);
        if (format.mimeType == "image/webp") {
            const WebpSize size = *webpSize(image.bytes);
            requireReasonableSize(image, format, size.width, size.height);
        }
        OIIO::attribute("limits:channels", kMostChannels);
        OIIO::attribute("limits:imagesize_MB", mostMegabytes(image.where.context().limits()));
        input_ = OIIO::ImageInput::create(format.name);
        if (!input_ || !input_->set_ioproxy(&bytes_))
            image.where.fail(fmt::format("OpenImageIO of this build reads no {} from memory", format.mimeType));
        OIIO::ImageSpec spec;
        OIIO::ImageSpec request;
        request.attribute("oiio:UnassociatedAlpha", 1); // colour as stored, whatever its alpha
        if (!input_->open(std::string("image.") + format.name, spec, request))
            image.where.fail("cannot be decoded: " + reasonOf(*input_));
        requireReasonable(image, format, input_->spec());
    }

    [[nodiscard]] OIIO::ImageInput& input() { return *input_; }

private:
    Bytes kept_;
    MemoryReader bytes_;
    std::unique_ptr<OIIO::ImageInput> input_;
};

std::vector<Texel8> readTexels8(const EncodedImage& image, const Format& format, OIIO::ImageInput& input) {
    std::vector<Texel8> texels = readTexels<Texel8>(image, input, OIIO::TypeDesc::UINT8);
    if (format.mimeType != "image/webp" || input.spec().nchannels != 4) return texels;
    const Bytes opaque = withoutAlpha(image.bytes);
    const EncodedImage colors{opaque, image.where};
    Decoder decoder(colors, format);
    const std::vector<Texel8> straight = readTexels<Texel8>(colors, decoder.input(), OIIO::TypeDesc::UINT8);
    if (straight.size() != texels.size()) image.where.fail("cannot be decoded: its parts differ in size");
    for (std::size_t i = 0; i < texels.size(); ++i)
        texels[i] = Texel8(straight[i].r, straight[i].g, straight[i].b, texels[i].a);
    return texels;
}

} // namespace

void requireReasonableHeader(const EncodedImage& image) {
    const Format* format = findFormat(image);
    if (format == nullptr) return;
    warnOfMimeType(image, *format);
    (void)Decoder(image, *format);
}

TextureImage decodeImage(const EncodedImage& image, std::uint64_t mostBytes) {
    const Format* format = findFormat(image);
    if (format == nullptr) image.where.fail("is neither PNG, JPEG nor WebP by its first bytes");
    Decoder decoder(image, *format);
    const OIIO::ImageSpec spec = decoder.input().spec();
    TextureImage result;
    result.width = static_cast<std::uint32_t>(spec.width);
    result.height = static_cast<std::uint32_t>(spec.height);
    const bool isDeep = spec.format == OIIO::TypeDesc::UINT16;
    const std::uint64_t bytes =
        std::uint64_t{result.width} * result.height * (isDeep ? sizeof(Texel16) : sizeof(Texel8));
    if (bytes > mostBytes)
        image.where.fail(fmt::format("its {} x {} texels exceed what is left of the {} MiB for all images", spec.width,
                                     spec.height, image.where.context().limits().texelBytes >> 20));
    if (isDeep)
        result.texels16 = readTexels<Texel16>(image, decoder.input(), OIIO::TypeDesc::UINT16);
    else
        result.texels8 = readTexels8(image, *format, decoder.input());
    return result;
}

} // namespace isolux

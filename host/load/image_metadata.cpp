#include "load/image_metadata.h"

#include "load/webp.h"

#include <algorithm>
#include <string_view>

namespace isolux {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPngStart = "\x89PNG\r\n\x1A\n"sv;

std::string_view asText(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Big-endian.
std::size_t readNumber(ByteSpan bytes, std::size_t count) {
    std::size_t number = 0;
    for (std::size_t i = 0; i < count; ++i) number = number << 8 | bytes[i];
    return number;
}

/// Chunks (PNG, 5.3: length, name, data, checksum) whose names begin with a small letter are ancillary.
Bytes pngWithoutMetadata(ByteSpan png) {
    constexpr std::size_t kAroundData = 12;
    Bytes result(png.begin(), png.begin() + kPngStart.size());
    ByteSpan rest = png.subspan(kPngStart.size());
    while (rest.size() >= kAroundData && readNumber(rest, 4) <= rest.size() - kAroundData) {
        const ByteSpan chunk = rest.first(readNumber(rest, 4) + kAroundData);
        const std::string_view name = asText(chunk.subspan(4, 4));
        const bool ancillary = name[0] >= 'a' && name[0] <= 'z';
        if (!ancillary || name == "tRNS") result.insert(result.end(), chunk.begin(), chunk.end());
        rest = rest.subspan(chunk.size());
    }
    result.insert(result.end(), rest.begin(), rest.end());
    return result;
}

/// Where the next marker's code is at or after `at`: a byte that follows 0xFF and is neither that nor 0, as decoders
/// look for it (ITU-T T.81, B.1.1.2); the end if there is none.
std::size_t nextMarker(ByteSpan jpeg, std::size_t at) {
    for (std::size_t i = std::max<std::size_t>(at + 1, 1); i < jpeg.size(); ++i)
        if (jpeg[i - 1] == 0xFF && jpeg[i] != 0xFF && jpeg[i] != 0) return i;
    return jpeg.size();
}

/// Up to the first scan, which decoders read metadata before.
void blankJpegMetadata(std::span<std::uint8_t> jpeg) {
    constexpr std::uint8_t kScan = 0xDA, kComment = 0xFE, kFirstApplication = 0xE0, kAdobe = 0xEE,
                           kLastApplication = 0xEF;
    const auto standsAlone = [](std::uint8_t marker) { return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9); };
    std::size_t code = nextMarker(jpeg, 2);
    while (code + 2 < jpeg.size() && jpeg[code] != kScan) {
        const std::uint8_t marker = jpeg[code];
        if (standsAlone(marker)) {
            code = nextMarker(jpeg, code + 1);
            continue;
        }
        const std::size_t length =
            std::max<std::size_t>(readNumber(jpeg.subspan(code + 1), 2), 2); // itself and the data
        const std::span<std::uint8_t> segment = jpeg.subspan(code + 1, std::min(length, jpeg.size() - code - 1));
        const bool application = marker > kFirstApplication && marker <= kLastApplication && marker != kAdobe;
        if (application || marker == kComment) std::fill(segment.begin() + 2, segment.end(), std::uint8_t{0});
        code = nextMarker(jpeg, code + 1 + segment.size());
    }
}

} // namespace

Bytes withoutMetadata(ByteSpan image) {
    const std::string_view text = asText(image);
    if (text.starts_with(kPngStart)) return pngWithoutMetadata(image);
    Bytes result(image.begin(), image.end());
    if (text.starts_with("\xFF\xD8\xFF"sv)) blankJpegMetadata(result);
    if (text.starts_with("RIFF"sv)) blankWebpMetadata(result);
    return result;
}

} // namespace isolux

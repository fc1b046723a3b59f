#include "load/webp.h"

#include <algorithm>
#include <string_view>

namespace isolux {
namespace {

constexpr std::size_t kHeaderBytes = 12; // "RIFF", length, "WEBP"
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint8_t kAlphaFlag = 0x10;

std::uint32_t readNumber(ByteSpan bytes, std::size_t count) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < count; ++i) number |= std::uint32_t{bytes[i]} << (8 * i);
    return number;
}

std::string_view asText(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

using Chunk = std::span<std::uint8_t>;

/// Makes a chunk one that decoders skip.
void rename(Chunk name) { std::fill(name.begin(), name.end(), std::uint8_t{'_'}); }

/// Removes what one chunk says of alpha: a flag of VP8X and of VP8L (its 29th bit after a byte of signature), and the
/// whole of ALPH.
void removeAlpha(Chunk name, Chunk data) {
    const std::string_view text = asText(name);
    if (text == "VP8X" && !data.empty())
        data[0] &= static_cast<std::uint8_t>(~kAlphaFlag);
    else if (text == "VP8L" && data.size() > 4)
        data[4] &= static_cast<std::uint8_t>(~kAlphaFlag);
    else if (text == "ALPH")
        rename(name);
}

/// Calls `change(name, data)` for every chunk.
template <typename Change> void forChunks(Chunk webp, const Change& change) {
    Chunk rest = webp.subspan(std::min(kHeaderBytes, webp.size()));
    while (rest.size() >= kChunkHeaderBytes) {
        const Chunk data = rest.subspan(kChunkHeaderBytes);
        const std::size_t length = std::min(std::size_t{readNumber(rest.subspan(4), 4)}, data.size());
        change(rest.first(4), data.first(length));
        rest = data.subspan(std::min(length + length % 2, data.size())); // chunks start at even bytes
    }
}

} // namespace

std::optional<WebpSize> webpSize(ByteSpan webp) {
    constexpr std::size_t kLongest = 10; // of what is read here of a chunk
    if (webp.size() < kHeaderBytes + kChunkHeaderBytes + kLongest) return std::nullopt;
    const std::string_view name = asText(webp.subspan(kHeaderBytes, 4));
    const ByteSpan data = webp.subspan(kHeaderBytes + kChunkHeaderBytes);
    // VP8X: one less than the canvas, 24 bits each, after flags. VP8: 14 bits each after the tag and start code of its
    // key frame (RFC 6386, 9.1). VP8L: one less, 14 bits each, after a byte of signature.
    if (name == "VP8X") return WebpSize{readNumber(data.subspan(4), 3) + 1, readNumber(data.subspan(7), 3) + 1};
    if (name == "VP8 ")
        return WebpSize{readNumber(data.subspan(6), 2) & 0x3FFFu, readNumber(data.subspan(8), 2) & 0x3FFFu};
    const std::uint32_t bits = readNumber(data.subspan(1), 4);
    if (name == "VP8L") return WebpSize{(bits & 0x3FFFu) + 1, ((bits >> 14) & 0x3FFFu) + 1};
    return std::nullopt;
}

Bytes withoutAlpha(ByteSpan webp) {
    Bytes result(webp.begin(), webp.end());
    forChunks(result, removeAlpha);
    return result;
}

void blankWebpMetadata(std::span<std::uint8_t> webp) {
    forChunks(webp, [](Chunk name, Chunk) {
        const std::string_view text = asText(name);
        if (text == "EXIF" || text == "XMP " || text == "ICCP") rename(name);
    });
}

} // namespace isolux

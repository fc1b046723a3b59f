#include "load/webp.h"

#include <algorithm>
#include <string_view>

namespace isolux {
namespace {

constexpr std::size_t kHeaderBytes = 12; // "RIFF", length, "WEBP"
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint8_t kAlphaFlag = 0x10;

std::size_t readLength(ByteSpan bytes) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length |= std::size_t{bytes[i]} << (8 * i);
    return length;
}

/// Removes what one chunk says of alpha: a flag of VP8X and of VP8L (its 29th bit after a byte of signature), and the
/// whole of ALPH, which is renamed to one that decoders skip.
void removeAlpha(std::span<std::uint8_t> name, std::span<std::uint8_t> data) {
    const std::string_view text(reinterpret_cast<const char*>(name.data()), name.size());
    if (text == "VP8X" && !data.empty())
        data[0] &= static_cast<std::uint8_t>(~kAlphaFlag);
    else if (text == "VP8L" && data.size() > 4)
        data[4] &= static_cast<std::uint8_t>(~kAlphaFlag);
    else if (text == "ALPH")
        std::fill(name.begin(), name.end(), std::uint8_t{'_'});
}

} // namespace

Bytes withoutAlpha(ByteSpan webp) {
    Bytes result(webp.begin(), webp.end());
    std::span<std::uint8_t> rest(result);
    rest = rest.subspan(std::min(kHeaderBytes, rest.size()));
    while (rest.size() >= kChunkHeaderBytes) {
        const std::span<std::uint8_t> data = rest.subspan(kChunkHeaderBytes);
        const std::size_t length = std::min(readLength(rest.subspan(4)), data.size());
        removeAlpha(rest.first(4), data.first(length));
        rest = data.subspan(std::min(length + length % 2, data.size())); // chunks start at even bytes
    }
    return result;
}

} // namespace isolux

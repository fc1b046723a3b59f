#include "load/exr_header.h"

#include "load/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

namespace isolux {
namespace {

constexpr std::size_t kStart = 8; // magic number; version and flags
constexpr std::uint8_t kTiles = 0x02;
constexpr std::uint8_t kDeepOrMultiPart = 0x18;
constexpr std::uint64_t kOffsetBytes = 8;

/// Rows in one chunk by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<std::uint64_t, 10> kRowsOfChunk = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

/// An attribute that a decoder needs; it takes the size for granted.
struct Needed {
    std::string_view name;
    std::string_view type;
    std::size_t bytes; ///< 0 for the list of channels, which ends itself
};

constexpr std::array<Needed, 9> kNeeded = {{{"channels", "chlist", 0},
                                            {"compression", "compression", 1},
                                            {"dataWindow", "box2i", 16},
                                            {"displayWindow", "box2i", 16},
                                            {"lineOrder", "lineOrder", 1},
                                            {"pixelAspectRatio", "float", 4},
                                            {"screenWindowCenter", "v2f", 8},
                                            {"screenWindowWidth", "float", 4},
                                            {"tiles", "tiledesc", 9}}};

struct Attribute {
    std::string_view name;
    std::span<std::uint8_t> type;
    ByteSpan value;
};

std::int32_t readInteger(ByteSpan bytes) {
    static_assert(std::endian::native == std::endian::little);
    std::int32_t value = 0;
    std::memcpy(&value, bytes.data(), sizeof(value));
    return value;
}

std::string_view asText(ByteSpan bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Reads the attributes of a header in turn.
class HeaderReader {
public:
    HeaderReader(std::span<std::uint8_t> rest, const LoadContext& context) : rest_(rest), context_(context) {}

    std::optional<Attribute> next() {
        const std::span<std::uint8_t> name = text();
        if (name.empty()) return std::nullopt;
        const std::span<std::uint8_t> type = text();
        if (rest_.size() < sizeof(std::int32_t)) fail();
        const std::int32_t size = readInteger(rest_);
        rest_ = rest_.subspan(sizeof(size));
        if (size < 0 || static_cast<std::size_t>(size) > rest_.size()) fail();
        const ByteSpan value = rest_.first(static_cast<std::size_t>(size));
        rest_ = rest_.subspan(value.size());
        return Attribute{asText(name), type, value};
    }

    [[noreturn]] void fail() const { context_.fail("", "its header is cut short or damaged"); }

private:
    /// Up to a zero byte, which is taken off as well.
    std::span<std::uint8_t> text() {
        const auto end = std::find(rest_.begin(), rest_.end(), std::uint8_t{0});
        if (end == rest_.end()) fail();
        const auto length = static_cast<std::size_t>(end - rest_.begin());
        const std::span<std::uint8_t> result = rest_.first(length);
        rest_ = rest_.subspan(length + 1);
        return result;
    }

    std::span<std::uint8_t> rest_;
    const LoadContext& context_;
};

/// What of a header decides how much memory its image takes.
struct Claims {
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t rowsOfChunk = 1;
    std::uint64_t tileWidth = 1;
    std::uint64_t tileHeight = 1;

    void read(const Attribute& attribute) {
        const ByteSpan value = attribute.value;
        if (attribute.name == "compression")
            rowsOfChunk = kRowsOfChunk[std::min<std::size_t>(value[0], kRowsOfChunk.size() - 1)];
        if (attribute.name == "dataWindow") {
            width = extent(readInteger(value), readInteger(value.subspan(8)));
            height = extent(readInteger(value.subspan(4)), readInteger(value.subspan(12)));
        }
        if (attribute.name == "tiles") {
            tileWidth = extent(1, readInteger(value));
            tileHeight = extent(1, readInteger(value.subspan(4)));
        }
    }

    /// Each chunk has an entry in a table of offsets, for which memory is taken before anything else is read.
    [[nodiscard]] std::uint64_t tableBytes(bool isTiled) const {
        const auto parts = [](std::uint64_t whole, std::uint64_t part) { return (whole + part - 1) / part; };
        if (isTiled) return parts(width, tileWidth) * parts(height, tileHeight) * kOffsetBytes;
        return parts(height, rowsOfChunk) * kOffsetBytes;
    }

private:
    /// From the first to the last; at least 1, for OpenEXR refuses others itself.
    static std::uint64_t extent(std::int64_t first, std::int64_t last) {
        return static_cast<std::uint64_t>(std::max<std::int64_t>(last - first + 1, 1));
    }
};

/// Channels follow each other up to an empty name: a name, a zero byte, 16 bytes.
bool isChannelList(ByteSpan value) {
    constexpr std::size_t kAfterName = 17;
    while (!value.empty() && value[0] != 0) {
        const auto name = static_cast<std::size_t>(std::find(value.begin(), value.end(), 0) - value.begin());
        if (value.size() - name < kAfterName) return false;
        value = value.subspan(name + kAfterName);
    }
    return value.size() == 1;
}

const Needed* findNeeded(std::string_view name) {
    const auto found =
        std::find_if(kNeeded.begin(), kNeeded.end(), [&](const Needed& needed) { return needed.name == name; });
    return found == kNeeded.end() ? nullptr : &*found;
}

bool isSound(const Attribute& attribute, const Needed& needed) {
    if (asText(attribute.type) != needed.type) return false;
    return needed.bytes == 0 ? isChannelList(attribute.value) : attribute.value.size() == needed.bytes;
}

} // namespace

void tameExrHeader(Bytes& exr, double mostTexels, const LoadContext& context) {
    HeaderReader reader(std::span<std::uint8_t>(exr).subspan(std::min(kStart, exr.size())), context);
    if (exr.size() < kStart) reader.fail();
    if ((exr[5] & kDeepOrMultiPart) != 0) context.fail("", "not a two-dimensional image");
    Claims claims;
    while (const std::optional<Attribute> attribute = reader.next()) {
        const Needed* needed = findNeeded(attribute->name);
        if (needed == nullptr) { // a type that OpenEXR does not know is so many bytes to it
            std::fill(attribute->type.begin(), attribute->type.end(), std::uint8_t{'_'});
            continue;
        }
        if (!isSound(*attribute, *needed)) reader.fail();
        claims.read(*attribute);
    }
    const double texels = static_cast<double>(claims.width) * static_cast<double>(claims.height);
    if (texels > mostTexels || claims.tableBytes((exr[5] & kTiles) != 0) > exr.size())
        context.fail("", fmt::format("it claims {} x {} texels, more than its bytes can hold or the limit of 2^28",
                                     claims.width, claims.height));
}

} // namespace isolux

#include "load/uri.h"

#include "load/context.h"
#include "load/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace isolux {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kNoDigit = 0xFF;

constexpr std::array<std::uint8_t, 256> base64Digits() {
    std::array<std::uint8_t, 256> digits{};
    digits.fill(kNoDigit);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kAlphabet.size(); ++i)
        digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
    return digits;
}

Bytes decodeBase64(std::string_view text, const JsonReader& where) {
    static constexpr std::array<std::uint8_t, 256> kDigits = base64Digits();
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    if (text.size() % 4 == 1) where.fail("its base64 data is cut short");
    Bytes bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t buffer = 0;
    int bits = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t digit = kDigits[static_cast<unsigned char>(text[i])];
        if (digit == kNoDigit) where.fail(fmt::format("character {} of its base64 data is not base64", i));
        buffer = (buffer << 6) | digit;
        bits += 6;
        if (bits >= 8) bytes.push_back(static_cast<std::uint8_t>(buffer >> (bits -= 8)));
    }
    return bytes;
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string decodePercent(std::string_view uri, const JsonReader& where) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            text += uri[i];
            continue;
        }
        const int high = uri.size() - i > 2 ? hexDigit(uri[i + 1]) : -1;
        const int low = uri.size() - i > 2 ? hexDigit(uri[i + 2]) : -1;
        if (high < 0 || low < 0) where.fail("has a '%' without two hexadecimal digits; write a percent sign as %25");
        text += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return text;
}

/// RFC 3986, 3.1: a letter, then letters, digits, '+', '-' or '.', up to a colon. "C:" on Windows looks the same.
bool hasScheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos && colon < uri.find_first_of("/?#");
}

bool contains(const fs::path& folder, const fs::path& path) {
    const auto [inFolder, inPath] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return inFolder == folder.end() && inPath != path.end();
}

} // namespace

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::string mediaTypeOf(std::string_view dataUri) {
    const std::size_t start = std::string_view("data:").size();
    std::string type(dataUri.substr(start, dataUri.find_first_of(";,", start) - start));
    for (char& c : type)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return type;
}

Bytes decodeDataUri(std::string_view uri, const JsonReader& where) {
    constexpr std::string_view kMarker = ";base64,";
    const std::size_t marker = uri.find(kMarker);
    if (marker == std::string_view::npos || uri.find(',') < marker)
        where.fail("is a data: URI that is not base64; write data:application/octet-stream;base64,...");
    return decodeBase64(uri.substr(marker + kMarker.size()), where);
}

fs::path resolveUri(const std::string& uri, const fs::path& folder, const JsonReader& where) {
    if (hasScheme(uri))
        where.fail(fmt::format("'{}' is not a relative path; copy the file beside the scene", printable(uri)));
    const std::string text = decodePercent(uri, where);
    if (text.empty()) where.fail("is empty");
    if (text.find('\0') != std::string::npos) where.fail("contains a NUL character");
    const fs::path relative(std::u8string(text.begin(), text.end()));
    if (relative.has_root_path() || text.starts_with('\\'))
        where.fail(fmt::format("'{}' is an absolute path; copy the file beside the scene", printable(text)));
    std::error_code error;
    const fs::path root = fs::canonical(folder, error);
    fs::path path = error ? fs::path() : fs::weakly_canonical(root / relative, error);
    if (error) where.fail(fmt::format("'{}' cannot be resolved: {}", printable(text), error.message()));
    if (!contains(root, path))
        where.fail(
            fmt::format("'{}' leads out of the scene's folder; copy the file beside the scene", printable(text)));
    return path;
}

} // namespace isolux

#include "load/images.h"

#include "load/uri.h"

#include <map>

namespace isolux {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30;

std::size_t integerOr(const JsonReader& object, std::string_view key, std::size_t fallback) {
    const std::optional<JsonReader> member = object.find(key);
    return member ? static_cast<std::size_t>(member->integer()) : fallback;
}

/// A bufferView was verified to lie within its buffer.
ByteSpan viewBytes(const JsonReader& view, const Buffers& buffers) {
    return buffers.spans[integerOr(view, "buffer", 0)].subspan(integerOr(view, "byteOffset", 0),
                                                               integerOr(view, "byteLength", 0));
}

class ImageReader {
public:
    ImageReader(const Buffers& buffers, const std::filesystem::path& folder, ContentHash& hash)
        : buffers_(buffers), folder_(folder), hash_(hash) {}

    void add(const JsonReader& image, const JsonReader& root) {
        const std::optional<JsonReader> view = image.find("bufferView");
        const ByteSpan bytes =
            view ? viewBytes(root.at("bufferViews").element(integerOr(image, "bufferView", 0)), buffers_)
                 : uriBytes(image.at("uri"));
        images_.images.push_back({bytes, image});
        requireReasonableHeader(images_.images.back());
    }

    [[nodiscard]] EncodedImages take() { return std::move(images_); }

private:
    /// A data URI is part of the document's own hash. A file is read once, however many images name it.
    ByteSpan uriBytes(const JsonReader& uri) {
        if (isDataUri(uri.string())) return keep(decodeDataUri(uri.string(), uri));
        const std::filesystem::path path = resolveUri(uri.string(), folder_, uri);
        if (const auto known = files_.find(path); known != files_.end()) return known->second;
        const ByteSpan bytes = keep(readRegularFile(path, {uri.context(), uri.pointer(), kLargestFile}));
        hash_.add(bytes);
        return files_.emplace(path, bytes).first->second;
    }

    ByteSpan keep(Bytes bytes) { return *images_.owners.emplace_back(std::make_shared<const Bytes>(std::move(bytes))); }

    const Buffers& buffers_;
    const std::filesystem::path& folder_;
    ContentHash& hash_;
    EncodedImages images_;
    std::map<std::filesystem::path, ByteSpan> files_;
};

} // namespace

EncodedImages readImages(const JsonReader& root, const Buffers& buffers, const std::filesystem::path& folder,
                         ContentHash& hash) {
    ImageReader reader(buffers, folder, hash);
    for (std::size_t i = 0; i < root.sizeOf("images"); ++i) reader.add(root.at("images").element(i), root);
    return reader.take();
}

} // namespace isolux

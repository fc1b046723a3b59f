// The bytes of the document's images, from data URIs, files beside the scene, or bufferViews.
#pragma once

#include "load/buffers.h"
#include "load/image_decoder.h"

namespace isolux {

/// Still encoded. Those with a file or a data URI are owned here, the others lie in buffers.
struct EncodedImages {
    std::vector<EncodedImage> images;
    std::vector<std::shared_ptr<const Bytes>> owners;
};

/// Reads every image of a verified document, whether or not a material needs it, and checks what their headers claim: a
/// broken reference is an error, and so is a claim on memory. Files are added to `hash`.
[[nodiscard]] EncodedImages readImages(const JsonReader& root, const Buffers& buffers,
                                       const std::filesystem::path& folder, ContentHash& hash);

} // namespace isolux

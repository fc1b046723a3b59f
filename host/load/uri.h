// Resolves the URI of a buffer: base64 data, or a file that must lie in the scene's own folder.
#pragma once

#include "load/bytes.h"

#include <string>

namespace isolux {

class JsonReader;

[[nodiscard]] bool isDataUri(std::string_view uri);

/// The media type of a data URI, in lower case; empty if it has none.
[[nodiscard]] std::string mediaTypeOf(std::string_view dataUri);

/// The bytes of "data:<type>;base64,<text>".
[[nodiscard]] Bytes decodeDataUri(std::string_view uri, const JsonReader& where);

/// The canonical path that a relative URI names. Refuses other schemes, absolute paths and whatever leads out of
/// `folder` after percent-decoding and following links: a scene from elsewhere must not reach the user's other files.
[[nodiscard]] std::filesystem::path resolveUri(const std::string& uri, const std::filesystem::path& folder,
                                               const JsonReader& where);

} // namespace isolux

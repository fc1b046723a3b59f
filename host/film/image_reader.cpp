// Reading image files: bounded before they are decoded, integer formats turned into linear light.
#include "film/image.h"

#include "core/error.h"
#include "core/srgb.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>

namespace isolux {
namespace {

namespace fs = std::filesystem;

/// The limits of what is read: a header that asks for more is refused before memory is taken.
constexpr int kMaxChannels = 4096;
constexpr int kMaxImageMegabytes = 8192;

void requireRegularFile(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) throwBadInput(path.string(), "no such file");
    if (error) throwBadInput(path.string(), error.message());
    if (fs::is_directory(status)) throwBadInput(path.string(), "is a folder, not an image");
    if (!fs::is_regular_file(status)) throwBadInput(path.string(), "is not a regular file");
}

/// Whether the description is one this program can hold; OpenImageIO's own limits are checked by some formats only.
void requireReasonable(const OIIO::ImageSpec& spec, const fs::path& path) {
    const double megabytes = 4e-6 * spec.width * spec.height * spec.nchannels;
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1)
        throwBadInput(path.string(), "not a two-dimensional image");
    if (spec.nchannels > kMaxChannels) throwBadInput(path.string(), "more channels than the limit of 4096");
    if (megabytes > kMaxImageMegabytes) throwBadInput(path.string(), "larger than the limit of 8 GB of pixels");
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height) {
        throwBadInput(path.string(), "its data window differs from its display window: crop or pad it first");
    }
}

/// Attributes of the file's own making: they would be wrong, or of the wrong type, in another one.
bool describesFile(const std::string& name) {
    return name.starts_with("oiio:") || name.starts_with("screenWindow") || name == "compression" ||
           name == "PixelAspectRatio";
}

/// OpenImageIO has names of its own for these attributes of EXR files.
std::string exrName(const std::string& name) {
    if (name == "worldtocamera") return "worldToCamera";
    if (name == "worldtoNDC") return "worldToNDC";
    return name == "worldtoscreen" ? "worldToScreen" : name;
}

MetadataMatrix readMatrix(const OIIO::ParamValue& attribute) {
    MetadataMatrix matrix;
    const float* const values = static_cast<const float*>(attribute.data());
    std::copy(values, values + matrix.size(), matrix.begin());
    return matrix;
}

/// The value of an attribute; nothing if it is of a type that metadata does not have.
std::optional<MetadataValue> readValue(const OIIO::ParamValue& attribute) {
    const OIIO::TypeDesc type = attribute.type();
    if (type == OIIO::TypeMatrix44) return readMatrix(attribute);
    if (type.arraylen != 0 || type.aggregate != OIIO::TypeDesc::SCALAR) return std::nullopt;
    if (type.basetype == OIIO::TypeDesc::STRING) return attribute.get_string();
    if (type.basetype == OIIO::TypeDesc::DOUBLE) return *static_cast<const double*>(attribute.data());
    if (type.is_floating_point()) return double{attribute.get_float()};
    return std::int64_t{attribute.get_int()};
}

Metadata readMetadata(const OIIO::ImageSpec& spec) {
    Metadata metadata;
    for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
        const std::string name = attribute.name().string();
        if (describesFile(name)) continue;
        if (const auto value = readValue(attribute)) metadata[exrName(name)] = *value;
    }
    return metadata;
}

bool isAuxiliary(const std::string& channelName) { return channelName == "A" || channelName == "Z"; }

/// Integer files: every colour channel from sRGB to linear, then multiplied by alpha if the file stores it apart.
void linearise(Image& image, const OIIO::ImageSpec& spec) {
    const auto alpha = image.channel("A");
    const bool associate = alpha && spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
    const std::size_t channelCount = image.channels.size();
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        float* const values = image.values.data() + pixel * channelCount;
        const double scale = associate ? double{values[*alpha]} : 1.0;
        for (std::size_t c = 0; c < channelCount; ++c) {
            if (!isAuxiliary(image.channels[c]))
                values[c] = static_cast<float>(scale * linearFromSrgb(double{values[c]}));
        }
    }
}

std::unique_ptr<OIIO::ImageInput> openImage(const fs::path& path) {
    requireRegularFile(path);
    OIIO::attribute("limits:channels", kMaxChannels);
    OIIO::attribute("limits:imagesize_MB", kMaxImageMegabytes);
    OIIO::ImageSpec request;
    request.attribute("oiio:UnassociatedAlpha", 1); // colour as stored: OpenImageIO would multiply the encoded bytes
    auto input = OIIO::ImageInput::open(path.string(), &request);
    if (!input) throwBadInput(path.string(), "not an image that can be read: " + OIIO::geterror());
    return input;
}

} // namespace

Image readImage(const fs::path& path) {
    const auto input = openImage(path);
    const OIIO::ImageSpec& spec = input->spec();
    requireReasonable(spec, path);
    Image image{static_cast<std::uint32_t>(spec.width),
                static_cast<std::uint32_t>(spec.height),
                spec.channelnames,
                {},
                readMetadata(spec)};
    image.values.resize(image.pixelCount() * image.channels.size());
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data())) {
        throwBadInput(path.string(), "damaged or truncated: " + input->geterror());
    }
    if (!spec.format.is_floating_point()) linearise(image, spec);
    return image;
}

} // namespace isolux

// Writing image files: encoded in memory, written beside the target, flushed and renamed over it.
#include "film/image.h"

#include "core/error.h"
#include "core/log.h"
#include "core/platform.h"
#include "core/srgb.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <utility>

namespace isolux {
namespace {

namespace fs = std::filesystem;

enum class Format { openExr, png, hdr };

std::optional<Format> formatOf(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".exr") return Format::openExr;
    if (extension == ".png") return Format::png;
    if (extension == ".hdr") return Format::hdr;
    return std::nullopt;
}

Format requireFormat(const fs::path& path) {
    const std::optional<Format> format = formatOf(path);
    if (!format) throwBadInput(path.string(), "not an image format that can be written: use .exr, .png or .hdr");
    return *format;
}

const char* pluginName(Format format) {
    switch (format) {
    case Format::openExr: return "openexr";
    case Format::png: return "png";
    case Format::hdr: return "hdr";
    }
    return "";
}

/// What OpenImageIO is asked to write: its own description, and the pixels as they go into the file.
struct FileContent {
    OIIO::ImageSpec spec;
    std::vector<float> floats;
    std::vector<std::uint8_t> bytes; ///< used instead of `floats` by 8-bit files
};

OIIO::ImageSpec makeSpec(const Image& image, const std::vector<std::string>& channels, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(static_cast<int>(image.width), static_cast<int>(image.height),
                         static_cast<int>(channels.size()), type);
    spec.channelnames = channels;
    const auto alpha = std::find(channels.begin(), channels.end(), "A");
    spec.alpha_channel = alpha == channels.end() ? -1 : static_cast<int>(alpha - channels.begin());
    return spec;
}

// --- OpenEXR ---

/// EXR has 32-bit integers only: OpenImageIO drops longer ones in silence, so they go in as decimal digits.
void setAttribute(OIIO::ImageSpec& spec, const std::string& name, std::int64_t value) {
    if (std::in_range<int>(value))
        spec.attribute(name, static_cast<int>(value));
    else
        spec.attribute(name, std::to_string(value));
}
void setAttribute(OIIO::ImageSpec& spec, const std::string& name, const std::string& value) {
    spec.attribute(name, value);
}
void setAttribute(OIIO::ImageSpec& spec, const std::string& name, double value) {
    spec.attribute(name, OIIO::TypeDesc(OIIO::TypeDesc::DOUBLE), &value);
}
void setAttribute(OIIO::ImageSpec& spec, const std::string& name, const MetadataMatrix& value) {
    spec.attribute(name, OIIO::TypeMatrix44, value.data());
}

FileContent exrContent(const Image& image) {
    FileContent content{makeSpec(image, image.channels, OIIO::TypeDesc::FLOAT), image.values, {}};
    for (const auto& entry : image.metadata) {
        std::visit([&](const auto& typed) { setAttribute(content.spec, entry.first, typed); }, entry.second);
    }
    content.spec.attribute("compression", "zip");
    content.spec.attribute("oiio:ColorSpace", "Linear");
    return content;
}

// --- PNG ---

std::array<std::size_t, 3> requireRgb(const Image& image, const fs::path& path) {
    const auto rgb = image.rgbChannels();
    if (!rgb) throwFailure(path.string(), "the image has no channels R, G and B to write");
    return *rgb;
}

Vec3f rgbValue(const Image& image, std::size_t pixel, const std::array<std::size_t, 3>& rgb) {
    return {image.value(pixel, rgb[0]), image.value(pixel, rgb[1]), image.value(pixel, rgb[2])};
}

/// The alpha channel if a viewer should see it: not where it is 1 all over, and not where light comes from behind
/// everything (radiance without coverage), which a transparent pixel would hide.
std::optional<std::size_t> visibleAlpha(const Image& image, const std::array<std::size_t, 3>& rgb) {
    const auto alpha = image.channel("A");
    if (!alpha) return std::nullopt;
    bool opaque = true;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const float coverage = image.value(pixel, *alpha);
        opaque = opaque && coverage == 1.0f;
        const bool lit =
            std::any_of(rgb.begin(), rgb.end(), [&](std::size_t c) { return image.value(pixel, c) != 0.0f; });
        if (coverage == 0.0f && lit) return std::nullopt;
    }
    return opaque ? std::nullopt : alpha;
}

/// Eight bits of a value; NaN becomes 0, as the negated comparison is true for it.
std::uint8_t quantise(double value) {
    if (!(value > 0.0)) return 0;
    return static_cast<std::uint8_t>(std::lround(255.0 * std::min(value, 1.0)));
}

/// Metadata as text, without what describes channels that a PNG does not have.
void setTexts(OIIO::ImageSpec& spec, const Metadata& metadata) {
    for (const auto& entry : metadata) {
        if (!entry.first.starts_with("cryptomatte/")) spec.attribute(entry.first, *metadataText(metadata, entry.first));
    }
}

/// PNG stores colour not multiplied by alpha: it is divided first, so that the tone map sees the colour of what is
/// there and not of what shines through, and rounded last.
FileContent pngContent(const Image& image, const fs::path& path, const DisplayTransform& display) {
    const std::array<std::size_t, 3> rgb = requireRgb(image, path);
    const std::optional<std::size_t> alpha = visibleAlpha(image, rgb);
    std::vector<std::string> channels{"R", "G", "B"};
    if (alpha) channels.emplace_back("A");
    FileContent content{makeSpec(image, channels, OIIO::TypeDesc::UINT8), {}, {}};
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const double coverage = alpha ? double{image.value(pixel, *alpha)} : 1.0;
        const double scale = coverage > 0.0 ? 1.0 / coverage : 1.0;
        const Vec3d shown = applyDisplay(display, scale * Vec3d(rgbValue(image, pixel, rgb)));
        for (int c = 0; c < 3; ++c) content.bytes.push_back(quantise(srgbFromLinear(shown[c])));
        if (alpha) content.bytes.push_back(quantise(coverage));
    }
    setTexts(content.spec, image.metadata);
    content.spec.attribute("oiio:ColorSpace", "sRGB");
    content.spec.attribute("oiio:UnassociatedAlpha", 1);
    return content;
}

// --- HDR ---

/// Half of RGBE's step for a colour whose largest channel is `largest`, or that of the next exponent if the sum needs
/// it.
float halfRgbeStep(float largest) {
    int exponent = 0;
    std::frexp(largest, &exponent);
    const float half = std::ldexp(0.5f, exponent - 8);
    return largest + half < std::ldexp(1.0f, exponent) ? half : 2.0f * half;
}

constexpr float kLargestRgbe = 1.6e38f; // below 2^127

bool fitsRgbe(const Vec3f& radiance) {
    return glm::all(glm::greaterThanEqual(radiance, Vec3f(0.0f))) &&
           glm::all(glm::lessThanEqual(radiance, Vec3f(kLargestRgbe)));
}

/// What RGBE can hold, with half a step added: OpenImageIO's encoder truncates, which would darken every image by 0.2
/// %.
Vec3f prepareForRgbe(const Vec3f& radiance) {
    Vec3f rgb(0.0f);
    for (int c = 0; c < 3; ++c) rgb[c] = radiance[c] > 0.0f ? std::min(radiance[c], kLargestRgbe) : 0.0f;
    const float largest = maxComponent(rgb);
    return largest > 0.0f ? rgb + Vec3f(halfRgbeStep(largest)) : rgb;
}

FileContent hdrContent(const Image& image, const fs::path& path) {
    const std::array<std::size_t, 3> rgb = requireRgb(image, path);
    FileContent content{makeSpec(image, {"R", "G", "B"}, OIIO::TypeDesc::FLOAT), {}, {}};
    std::size_t clamped = 0;
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const Vec3f radiance = rgbValue(image, pixel, rgb);
        clamped += fitsRgbe(radiance) ? 0 : 1;
        const Vec3f value = prepareForRgbe(radiance);
        content.floats.insert(content.floats.end(), {value.x, value.y, value.z});
    }
    if (clamped != 0)
        spdlog::warn("{}: {} pixels are negative, NaN or above {:.3g}, which this format cannot hold: clamped",
                     path.string(), clamped, kLargestRgbe);
    return content;
}

// --- Writing ---

FileContent makeContent(Format format, const Image& image, const fs::path& path, const DisplayTransform& display) {
    switch (format) {
    case Format::openExr: return exrContent(image);
    case Format::png: return pngContent(image, path, display);
    case Format::hdr: return hdrContent(image, path);
    }
    return {};
}

/// The bytes of the file. Encoding into memory leaves the writing, and so every failing write, to this file's own code.
std::vector<unsigned char> encode(Format format, const FileContent& content, const fs::path& path) {
    const auto fail = [&](const std::string& message) {
        throwFailure(path.string(), "cannot encode the image: " + message);
    };
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput memory(encoded);
    const auto output = OIIO::ImageOutput::create(pluginName(format));
    if (!output) fail(OIIO::geterror());
    if (!output->set_ioproxy(&memory) || !output->open(path.string(), content.spec)) fail(output->geterror());
    const bool written = content.bytes.empty() ? output->write_image(OIIO::TypeDesc::FLOAT, content.floats.data())
                                               : output->write_image(OIIO::TypeDesc::UINT8, content.bytes.data());
    if (!written) fail(output->geterror());
    if (!output->close()) fail(output->geterror());
    return encoded;
}

fs::path folderOf(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// A file beside `target` that is gone when this object is, unless it has been renamed by then.
class TemporaryFile {
public:
    explicit TemporaryFile(const fs::path& target)
        : path_(folderOf(target) / ("." + target.stem().string() + "." + std::to_string(processId()) + ".tmp" +
                                    target.extension().string())) {}
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// Writes the bytes to a new file. The stream is closed before it is asked: the last bytes may fail as late as that.
void writeBytes(const fs::path& file, std::span<const unsigned char> bytes, const fs::path& target) {
    errno = 0;
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) throwFailure(target.string(), std::string("cannot write the image: ") + std::strerror(errno));
}

} // namespace

void writeImage(const fs::path& path, const Image& image, const DisplayTransform& display) {
    assert(image.values.size() == image.pixelCount() * image.channels.size());
    const Format format = requireFormat(path);
    const std::vector<unsigned char> bytes = encode(format, makeContent(format, image, path, display), path);
    const TemporaryFile temporary(path);
    writeBytes(temporary.path(), bytes, path);
    replaceFile(temporary.path(), path);
}

bool holdsLayers(const fs::path& path) { return formatOf(path) == Format::openExr; }

void checkImagePath(const fs::path& path) {
    requireFormat(path);
    std::error_code error;
    const fs::path folder = folderOf(path);
    if (!fs::is_directory(folder, error)) throwBadInput(path.string(), "its folder does not exist");
    if (fs::is_directory(path, error)) throwBadInput(path.string(), "is a folder");
    const TemporaryFile probe(path); // permissions alone would not tell of a read-only file system
    if (!std::ofstream(probe.path())) throwBadInput(path.string(), "its folder cannot be written to");
}

} // namespace isolux

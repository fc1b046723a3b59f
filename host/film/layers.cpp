#include "film/layers.h"

#include "core/error.h"
#include "film/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace isolux {
namespace {

struct NamedLayer {
    std::string_view name;
    Layer layer;
};

constexpr std::array kLayers{NamedLayer{"variance", Layer::variance}, NamedLayer{"samples", Layer::samples},
                             NamedLayer{"albedo", Layer::albedo},     NamedLayer{"normal", Layer::normal},
                             NamedLayer{"depth", Layer::depth},       NamedLayer{"object", Layer::object},
                             NamedLayer{"material", Layer::material}};

Layer layerNamed(std::string_view word) {
    const auto found =
        std::find_if(kLayers.begin(), kLayers.end(), [&](const NamedLayer& l) { return l.name == word; });
    if (found != kLayers.end()) return found->layer;
    std::string known;
    for (const NamedLayer& layer : kLayers) known += fmt::format("{}, ", layer.name);
    throwBadInput(fmt::format("layer \"{}\"", word), fmt::format("unknown: use {}or all or none alone", known));
}

LayerSet allLayers() {
    LayerSet layers;
    for (const NamedLayer& layer : kLayers) layers.insert(layer.layer);
    return layers;
}

// --- Channels ---

/// Some channels, and the function that fills them in for a pixel.
struct ChannelGroup {
    std::vector<std::string> names;
    std::function<void(std::size_t pixel, std::span<float> values)> fill;
};

/// `sum` over `count`, or 0 where nothing was counted.
double ratio(double sum, std::uint64_t count) { return count == 0 ? 0.0 : sum / static_cast<double>(count); }

void store(const Vec3d& vector, std::span<float> values) {
    for (int c = 0; c < 3; ++c) values[static_cast<std::size_t>(c)] = static_cast<float>(vector[c]);
}

ChannelGroup radianceChannels(const Film& film) {
    return {{"R", "G", "B", "A"}, [&film](std::size_t pixel, std::span<float> values) {
                const PixelStatistics& statistics = film.pixels[pixel];
                store(statistics.mean, values);
                values[3] = static_cast<float>(ratio(static_cast<double>(statistics.hitCount), statistics.sampleCount));
            }};
}

ChannelGroup depthChannel(const Film& film) {
    return {{"Z"}, [&film](std::size_t pixel, std::span<float> values) {
                const std::uint64_t hits = film.aovs[pixel].hitCount();
                values[0] = hits == 0 ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(ratio(film.aovs[pixel].depth, hits));
            }};
}

ChannelGroup varianceChannels(const Film& film) {
    return {{"variance.R", "variance.G", "variance.B", "variance.Y"},
            [&film](std::size_t pixel, std::span<float> values) {
                store(film.pixels[pixel].variance(), values);
                values[3] = static_cast<float>(film.pixels[pixel].luminanceVariance());
            }};
}

ChannelGroup samplesChannel(const Film& film) {
    return {{"samples.Y"}, [&film](std::size_t pixel, std::span<float> values) {
                values[0] = static_cast<float>(film.pixels[pixel].sampleCount);
            }};
}

/// The sums are divided by all samples of the pixel and not by its hits, so that edges blend as the image does.
ChannelGroup sumChannels(const Film& film, std::vector<std::string> names, Vec3d PixelAovs::*sum) {
    return {std::move(names), [&film, sum](std::size_t pixel, std::span<float> values) {
                const std::uint64_t count = film.pixels[pixel].sampleCount;
                const Vec3d& total = film.aovs[pixel].*sum;
                store({ratio(total.x, count), ratio(total.y, count), ratio(total.z, count)}, values);
            }};
}

ChannelGroup cryptomatteChannels(const Film& film, const Cryptomatte& matte) {
    return {matte.channels(matte.layerCount(film)), [&film, matte](std::size_t pixel, std::span<float> values) {
                std::size_t next = 0;
                for (const Cryptomatte::Rank& rank : matte.ranks(film.aovs[pixel], film.pixels[pixel].sampleCount)) {
                    if (next == values.size()) break; // layerCount has said so
                    values[next++] = rank.id;
                    values[next++] = rank.coverage;
                }
            }};
}

/// One more than the last object that any pixel shows.
std::size_t objectCount(const Film& film) {
    std::size_t count = 0;
    for (const PixelAovs& pixel : film.aovs) {
        if (!pixel.objects.empty()) count = std::max(count, std::size_t{pixel.objects.back().object} + 1);
    }
    return count;
}

/// A name for each of at least `count` objects; those without one get a number after `unnamed`.
std::vector<std::string> completeNames(std::vector<std::string> names, std::size_t count, std::string_view unnamed) {
    names.resize(std::max(names.size(), count));
    for (std::size_t object = 0; object < names.size(); ++object) {
        if (names[object].empty()) names[object] = fmt::format("{} {}", unnamed, object);
    }
    return names;
}

/// The Cryptomattes of the layers asked for.
std::vector<Cryptomatte> makeCryptomattes(const Film& film, const LayerSet& layers, const ObjectNames& names) {
    const std::size_t count = objectCount(film);
    std::vector<Cryptomatte> mattes;
    if (layers.contains(Layer::object))
        mattes.emplace_back("CryptoObject", completeNames(names.objects, count, "object"));
    if (layers.contains(Layer::material))
        mattes.emplace_back("CryptoMaterial", completeNames(names.materials, count, "material of object"));
    return mattes;
}

std::vector<ChannelGroup> makeChannels(const Film& film, const LayerSet& layers,
                                       const std::vector<Cryptomatte>& mattes) {
    std::vector<ChannelGroup> groups{radianceChannels(film)};
    if (layers.contains(Layer::depth)) groups.push_back(depthChannel(film));
    if (layers.contains(Layer::variance)) groups.push_back(varianceChannels(film));
    if (layers.contains(Layer::samples)) groups.push_back(samplesChannel(film));
    if (layers.contains(Layer::albedo))
        groups.push_back(sumChannels(film, {"albedo.R", "albedo.G", "albedo.B"}, &PixelAovs::albedo));
    if (layers.contains(Layer::normal))
        groups.push_back(sumChannels(film, {"normal.X", "normal.Y", "normal.Z"}, &PixelAovs::normal));
    for (const Cryptomatte& matte : mattes) groups.push_back(cryptomatteChannels(film, matte));
    return groups;
}

/// An image of zeros with these channels.
Image blankImage(const Film& film, const std::vector<ChannelGroup>& groups) {
    Image image;
    image.width = film.width;
    image.height = film.height;
    for (const ChannelGroup& group : groups)
        image.channels.insert(image.channels.end(), group.names.begin(), group.names.end());
    image.values.resize(image.pixelCount() * image.channels.size());
    return image;
}

void fillPixel(Image& image, std::size_t pixel, const std::vector<ChannelGroup>& groups) {
    const std::size_t channelCount = image.channels.size();
    std::span<float> rest(image.values.data() + pixel * channelCount, channelCount);
    for (const ChannelGroup& group : groups) {
        group.fill(pixel, rest.first(group.names.size()));
        rest = rest.subspan(group.names.size());
    }
}

} // namespace

LayerSet parseLayers(std::string_view list) {
    if (list == "all") return allLayers();
    LayerSet layers;
    if (list == "none") return layers;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        layers.insert(layerNamed(list.substr(begin, end - begin)));
        begin = end + 1;
    }
    return layers;
}

std::vector<std::string> layerNames(const LayerSet& layers) {
    std::vector<std::string> names;
    for (const NamedLayer& named : kLayers)
        if (layers.contains(named.layer)) names.emplace_back(named.name);
    return names;
}

bool needsAovs(const LayerSet& layers) {
    return std::any_of(kLayers.begin(), kLayers.end(), [&](const NamedLayer& named) {
        return named.layer != Layer::variance && named.layer != Layer::samples && layers.contains(named.layer);
    });
}

Image imageFromFilm(const Film& film, const LayerSet& layers, const ObjectNames& names, Metadata metadata) {
    assert(!needsAovs(layers) || film.aovs.size() == film.pixels.size());
    const std::vector<Cryptomatte> mattes = makeCryptomattes(film, layers, names);
    const std::vector<ChannelGroup> groups = makeChannels(film, layers, mattes);
    Image image = blankImage(film, groups);
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) fillPixel(image, pixel, groups);
    image.metadata = std::move(metadata);
    for (const Cryptomatte& matte : mattes) image.metadata.merge(matte.metadata());
    image.metadata["isolux/sampleCount"] = unsignedMetadata(film.maxSampleCount());
    return image;
}

Image imageFromFilm(const Film& film, Metadata metadata) {
    return imageFromFilm(film, {Layer::variance, Layer::samples}, {}, std::move(metadata));
}

} // namespace isolux

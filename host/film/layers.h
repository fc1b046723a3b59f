// The layers of channels a user may ask for, and the image they make of a film.
#pragma once

#include "film/image.h"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace isolux {

/// What an image can hold beside R G B A; README.md lists the channels of each.
enum class Layer : std::uint8_t { variance, samples, albedo, normal, depth, object, material };

class LayerSet {
public:
    LayerSet() = default;
    LayerSet(std::initializer_list<Layer> layers) {
        for (const Layer layer : layers) insert(layer);
    }

    void insert(Layer layer) { bits_ |= bit(layer); }
    [[nodiscard]] bool contains(Layer layer) const { return (bits_ & bit(layer)) != 0; }

    friend bool operator==(const LayerSet&, const LayerSet&) = default;

private:
    static unsigned bit(Layer layer) { return 1u << static_cast<unsigned>(layer); }

    unsigned bits_ = 0;
};

/// Reads layers separated by commas, or `all` or `none`. Throws Error (bad input) that names an unknown word.
[[nodiscard]] LayerSet parseLayers(std::string_view list);

/// The words that `parseLayers` reads.
[[nodiscard]] std::vector<std::string> layerNames(const LayerSet& layers);

/// Whether one of the layers comes from Film::aovs.
[[nodiscard]] bool needsAovs(const LayerSet& layers);

/// What the Cryptomatte layers call things; both indexed by FirstHit::object. Objects that share a name become one. One
/// without a name is called "object 3", its material "material of object 3".
struct ObjectNames {
    std::vector<std::string> objects;
    std::vector<std::string> materials; ///< the name of each object's material
};

/// R G B A and the channels of `layers`. Metadata isolux/sampleCount is set to the most samples any pixel holds. Layers
/// for which needsAovs() holds require Film::aovs.
[[nodiscard]] Image imageFromFilm(const Film& film, const LayerSet& layers, const ObjectNames& names,
                                  Metadata metadata);

} // namespace isolux

// Writes an EXR with every layer, for Blender to open: 4 x 2 pixels whose values layers.py knows.
#include "film/layers.h"

#include <cstdlib>

namespace isolux {
namespace {

/// Every pixel has four samples; pixel i of a row meets the cube with i of them and the sphere with the others.
Film makeFilm() {
    Film film(4, 2);
    film.keepAovs();
    for (std::size_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const std::size_t cubes = pixel % film.width;
        for (std::size_t sample = 0; sample < 4; ++sample) {
            film.pixels[pixel].add(Vec3d(0.25, 0.5, static_cast<double>(sample)));
            film.aovs[pixel].add({{0.75, 0.5, 0.25}, {0.0, 0.0, 1.0}, 5.0, sample < cubes ? 0u : 1u});
        }
        film.pixels[pixel].hitCount = 4;
    }
    return film;
}

} // namespace
} // namespace isolux

int main(int count, char** arguments) {
    if (count != 2) return EXIT_FAILURE;
    using namespace isolux;
    const Metadata metadata{{"worldToCamera", matrixMetadata(Mat4d(1.0))}};
    const ObjectNames names{{"cube", "sphere"}, {"red paint", "red paint"}};
    writeImage(arguments[1], imageFromFilm(makeFilm(), parseLayers("all"), names, metadata));
    return EXIT_SUCCESS;
}

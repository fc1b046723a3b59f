#include "stress/families.h"

namespace isolux {

const std::vector<PlannedFamily>& stressFamilies() {
    static const std::vector<PlannedFamily> families{
        {"scale", "Uniform scale", scaleSweeps},
        {"distance", "Distance from the origin and from the camera", distanceSweeps},
        {"mixed-scales", "Small detail in large scenes", mixedScaleSweeps},
        {"triangles", "Slivers, twins and other bad triangles", triangleSweeps},
        {"watertight", "Rays aimed at edges and vertices", watertightSweeps},
        {"rays", "Rays of every kind", raySweeps},
        {"grazing", "Grazing angles and bent normals", grazingSweeps},
        {"lights", "Lights of any size, brightness, distance and number", lightSweeps},
        {"surfaces", "Roughness and index of refraction", surfaceSweeps},
        {"transport", "Long paths, pinholes and absorption", transportSweeps},
        {"accumulation", "Many samples a pixel", accumulationSweeps},
        {"camera", "Fields of view and shapes of images", cameraSweeps},
        {"nothing", "Nothing, and input that is no number", nothingSweeps},
    };
    return families;
}

} // namespace isolux

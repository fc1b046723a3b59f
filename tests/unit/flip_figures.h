// FLIP of the images in flip_test.cpp by its authors' program; printed by tests/support/flip_figures.py.
#pragma once

#include <array>
#include <cstddef>

namespace isolux::test {

/// By flip-evaluator 1.7, which computes in single precision. Exposures are 0 in low range; the pixels
/// are those at 0, 1/5, 2/5, ... of the image's.
struct FlipFigures {
    const char* name;
    bool highRange;
    double mean;
    double start;
    double stop;
    std::size_t exposures;
    std::array<double, 5> pixels;
};

inline constexpr std::array kFlipFigures{
    FlipFigures{"noise", false, 0.395735678, 0, 0, 0, {0.96776247, 0.65600097, 0.54436034, 0.43343553, 0.63955444}},
    FlipFigures{"gradient", false, 0.143331116, 0, 0, 0, {0.40874326, 0.14594039, 0.1262469, 0.10942081, 0.11098237}},
    FlipFigures{
        "gradientFromAfar", false, 0.143784503, 0, 0, 0, {0.40564108, 0.15446493, 0.17815487, 0.14259592, 0.10533662}},
    FlipFigures{
        "gradientFromNear", false, 0.177123189, 0, 0, 0, {0.29213253, 0.1108087, 0.08377634, 0.14917542, 0.14660156}},
    FlipFigures{
        "singlePixel", false, 0.984111905, 0, 0, 0, {0.98411191, 0.98411191, 0.98411191, 0.98411191, 0.98411191}},
    FlipFigures{"noise",
                true,
                0.342986428,
                1.10645878,
                2.12243032,
                2,
                {0.89969939, 0.55563849, 0.38610724, 0.3216486, 0.40021411}},
    FlipFigures{
        "radiance", true, 0.140267801, -3.03399467, 4.99583435, 9, {0, 0.19148181, 0.18418241, 0.11069177, 0.10988718}},
    FlipFigures{"spotlight",
                true,
                0.948954676,
                -2.04728174,
                24.0832977,
                27,
                {0.96738833, 0.96738833, 0.96738833, 0.96738833, 0.96738833}},
    FlipFigures{"singlePixel",
                true,
                0.66834563,
                4.64437532,
                4.64437532,
                2,
                {0.66834563, 0.66834563, 0.66834563, 0.66834563, 0.66834563}},
};

} // namespace isolux::test

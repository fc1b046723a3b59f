#!/usr/bin/env python3
"""Prints the figures of tests/unit/flip_figures.h: FLIP by its authors' own program on images made by a formula.

    python3 -m venv venv && venv/bin/pip install flip-evaluator==1.7 numpy
    venv/bin/python tests/support/flip_figures.py | clang-format > tests/unit/flip_figures.h

tests/unit/flip_test.cpp makes the same images, bit for bit: integers, and floats that are exact.
"""

import importlib.metadata

import flip_evaluator
import numpy as np


def hashed(x, y, channel, seed):
    """An integer of 32 bits for a pixel's channel: multiplications and shifts, modulo 2^32."""
    value = np.uint64(seed) * np.uint64(0x9E3779B9) + np.uint64(channel) * np.uint64(0x85EBCA6B)
    value = (value + x * np.uint64(0xC2B2AE35) + y * np.uint64(0x27D4EB2F)) & np.uint64(0xFFFFFFFF)
    for shift, factor in ((16, 0x7FEB352D), (15, 0x846CA68B)):
        value = ((value ^ (value >> np.uint64(shift))) * np.uint64(factor)) & np.uint64(0xFFFFFFFF)
    return value ^ (value >> np.uint64(16))


def make(width, height, function):
    """An image from function(x, y, channel) over arrays of integers."""
    y, x = np.mgrid[0:height, 0:width].astype(np.uint64)
    return np.stack([function(x, y, channel) for channel in range(3)], axis=-1).astype(np.float32)


def noise(seed):
    """Uniform in [0, 1), 24 bits."""
    return lambda x, y, channel: (hashed(x, y, channel, seed) >> np.uint64(8)) / 2.0**24


def gradient(x, y, channel):
    """Ramps of another direction in every channel, with squares of 16 pixels."""
    ramp = (x, y, x + y)[channel] % np.uint64(128) / 128.0
    return np.where((x // np.uint64(16) + y // np.uint64(16)) % np.uint64(2) == 0, ramp, 0.25)


def disturbed(x, y, channel):
    """The gradient with a little noise, a patch that is too red and one white pixel."""
    value = gradient(x, y, channel) * (15.0 / 16.0) + noise(3)(x, y, channel) / 16.0
    if channel == 0:
        value = np.where((x >= 40) & (x < 60) & (y >= 30) & (y < 36), 1.0, value)
    return np.where((x == 20) & (y == 40), 1.0, value)


def radiance(x, y, channel):
    """Blocks of 16 pixels from 2^-6 to 2^5 times the gradient, black on the left."""
    stops = hashed(x // np.uint64(16), y // np.uint64(16), 0, 5) % np.uint64(12)
    return np.where(x < 24, 0.0, (gradient(x, y, channel) + 1.0 / 64.0) * np.exp2(stops.astype(float) - 6.0))


def noisy_radiance(x, y, channel):
    """The radiance times noise from 1/2 to 3/2, and a firefly."""
    value = radiance(x, y, channel) * (0.5 + noise(7)(x, y, channel))
    return np.where((x == 70) & (y == 33), 1000.0, value)


def spotlight(x, y, channel):
    """Nearly all black, so that the median is: a bright square."""
    inside = (x >= 100) & (x < 140) & (y >= 60) & (y < 90)
    return np.where(inside, 8.0 + gradient(x, y, channel), 0.0)


def leaking_spotlight(x, y, channel):
    """The spotlight with a thousandth of its light leaking into the dark."""
    return spotlight(x, y, channel) + 1.0 / 1024.0


CASES = [
    ("noise", "LDR", noise(1), noise(2), 64, 48, 0.0),
    ("gradient", "LDR", disturbed, gradient, 96, 64, 0.0),
    ("gradientFromAfar", "LDR", disturbed, gradient, 96, 64, 120.0),
    ("gradientFromNear", "LDR", disturbed, gradient, 96, 64, 20.0),
    ("singlePixel", "LDR", noise(1), noise(2), 1, 1, 0.0),
    ("noise", "HDR", noise(1), noise(2), 64, 48, 0.0),
    ("radiance", "HDR", noisy_radiance, radiance, 128, 96, 0.0),
    ("spotlight", "HDR", leaking_spotlight, spotlight, 256, 192, 0.0),
    ("singlePixel", "HDR", noise(1), noise(2), 1, 1, 0.0),
]


def main():
    version = importlib.metadata.version("flip-evaluator")
    print("// FLIP of the images in flip_test.cpp by its authors' program; printed by tests/support/flip_figures.py.")
    print("#pragma once\n")
    print("#include <array>\n#include <cstddef>\n")
    print("namespace isolux::test {\n")
    print(f"/// By flip-evaluator {version}, which computes in single precision. Exposures are 0 in low range; the pixels")
    print("/// are those at 0, 1/5, 2/5, ... of the image's.")
    print("struct FlipFigures {\n    const char* name;\n    bool highRange;\n    double mean;\n    double start;\n"
          "    double stop;\n    std::size_t exposures;\n    std::array<double, 5> pixels;\n};\n")
    print("inline constexpr std::array kFlipFigures{")
    for name, dynamic_range, image, reference, width, height, ppd in CASES:
        parameters = {"ppd": ppd} if ppd else {}
        errors, _, used = flip_evaluator.evaluate(
            make(width, height, reference), make(width, height, image), dynamic_range, inputsRGB=False,
            applyMagma=False, parameters=parameters)
        errors = errors[..., 0].astype(np.float64).ravel()
        high = dynamic_range == "HDR"
        exposures = (used["startExposure"], used["stopExposure"], used["numExposures"]) if high else (0.0, 0.0, 0)
        pixels = ", ".join(f"{errors[i * errors.size // 5]:.8g}" for i in range(5))
        print(f'    FlipFigures{{"{name}", {str(high).lower()}, {errors.mean():.9g}, {exposures[0]:.9g}, '
              f"{exposures[1]:.9g}, {exposures[2]}, {{{pixels}}}}},")
    print("};\n\n} // namespace isolux::test")


if __name__ == "__main__":
    main()

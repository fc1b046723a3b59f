"""Errors over the pixels in which no light is seen. The edge of a bright lamp, hit or missed by camera rays alone, else
drowns what distinguishes ways to light a surface."""

import functools
import statistics

from study_exr import read_channels

COLORS = ["R", "G", "B"]
VARIANCES = ["variance.R", "variance.G", "variance.B"]


@functools.cache
def surfaces(emission):
    """Indices of the pixels that are black in an image of emitted light alone."""
    _, _, image = read_channels(emission, COLORS)
    return [index for index, values in enumerate(zip(*(image[color] for color in COLORS))) if not any(values)]


@functools.cache
def reference_pixels(path):
    return read_channels(path, [*COLORS, *VARIANCES, "samples.Y"])[2]


def surface_error(image, reference, emission):
    """Mean squared difference, the reference's own variance and its mean, as `isolux compare` has them over all pixels;
    None where every pixel sees a light."""
    chosen = surfaces(emission)
    if not chosen:
        return None
    _, _, pixels = read_channels(image, COLORS)
    truth = reference_pixels(reference)
    squares = [(pixels[color][i] - truth[color][i]) ** 2 for color in COLORS for i in chosen]
    variances = [truth[name][i] / truth["samples.Y"][i] for name in VARIANCES for i in chosen]
    means = [truth[color][i] for color in COLORS for i in chosen]
    return {"mse": statistics.fmean(squares), "referenceVariance": statistics.fmean(variances),
            "referenceMean": statistics.fmean(means)}

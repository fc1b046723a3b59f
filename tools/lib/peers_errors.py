"""Arithmetic of `tools/bench/peers`: errors against two independent references, and whether two renderers' images converge to
the same. Images are arrays of red, green and blue of each pixel, row by row."""

import array
import math
import statistics

from study_statistics import signed_root, t_quantile

LUMINANCE = (0.2126, 0.7152, 0.0722)  # linear Rec. 709 (ITU-R BT.709)
TRIMMED = 0.001  # share of the worst pixels left out of rel_mse_trimmed
BLOCKS = 8  # to a side of the image


def mean_luminance(image):
    return 3 * sum(weight * math.fsum(image[channel::3]) for channel, weight in enumerate(LUMINANCE)) / len(image)


def mean_image(images):
    return array.array("d", [math.fsum(values) / len(values) for values in zip(*images)])


def errors(image, first, second):
    """Columns of convergence.csv by name. A product of differences from two references is free of their noise, and may be
    negative."""
    products = [(x - a) * (x - b) for x, a, b in zip(image, first, second)]
    middle = [0.5 * (a + b) for a, b in zip(first, second)]
    relative = [product / (r * r + 0.01) for product, r in zip(products, middle)]
    pixels = sorted(math.fsum(relative[at:at + 3]) / 3 for at in range(0, len(relative), 3))
    kept = pixels[:len(pixels) - math.floor(TRIMMED * len(pixels))]
    mean, level = statistics.fmean(middle), mean_luminance(middle)
    mse = statistics.fmean(products)
    return {"mse": mse, "rel_mse": statistics.fmean(pixels), "rel_mse_trimmed": statistics.fmean(kept),
            "mae": statistics.fmean(abs(x - r) for x, r in zip(image, middle)),
            "bias": (mean_luminance(image) - level) / level, "relative_rmse": signed_root(mse) / mean}


def reference_noise(first, second):
    """Relative root mean squared error of the mean of both, from their difference."""
    mean = 0.5 * (statistics.fmean(first) + statistics.fmean(second))
    return math.sqrt(statistics.fmean((a - b) ** 2 for a, b in zip(first, second))) / (2 * mean)


def halves(images):
    """Two references of independent images."""
    return mean_image(images[0::2]), mean_image(images[1::2])


def welch(own, others):
    """Difference of means, its standard error and degrees of freedom (Welch 1947)."""
    parts = [statistics.variance(values) / len(values) for values in (own, others)]
    total = sum(parts)
    freedom = total**2 / sum(part**2 / (len(values) - 1) for part, values in zip(parts, (own, others))) if total else 1.0
    return statistics.fmean(own) - statistics.fmean(others), math.sqrt(total), freedom


def block_luminances(image, size):
    """Of BLOCKS by BLOCKS parts of a square image."""
    side = size // BLOCKS
    def rows(x, y):
        return (image[3 * ((y * side + row) * size + x * side):][:3 * side] for row in range(side))
    return [sum(mean_luminance(row) for row in rows(x, y)) / side for y in range(BLOCKS) for x in range(BLOCKS)]


def compare(own, others, size):
    """Replicates of one renderer against those of another: relative difference of mean luminance [low, estimate, high] at
    95 %; the block that differs by most standard errors, and what the largest of so many may be by chance (95 %, by
    Bonferroni's inequality)."""
    means = [[mean_luminance(image) for image in images] for images in (own, others)]
    difference, error, freedom = welch(*means)
    level, half = statistics.fmean(means[1]), t_quantile(max(1, math.floor(freedom))) * error
    blocks = [list(zip(*(block_luminances(image, size) for image in images))) for images in (own, others)]
    tests = [welch(*pair) for pair in zip(*blocks)]
    scores = [difference / error if error else 0.0 for difference, error, _ in tests]
    worst = max(range(len(scores)), key=lambda index: abs(scores[index]))
    limit = t_quantile(max(1, math.floor(tests[worst][2])), 1 - 0.025 / len(scores))
    return {"bias": [(difference - half) / level, difference / level, (difference + half) / level],
            "block": {"score": scores[worst], "limit": limit, "relative": tests[worst][0] / statistics.fmean(blocks[1][worst])}}


def differs(bias, limit):
    """Whether the interval lies outside of what counts as equal."""
    return bias[0] > limit or bias[2] < -limit

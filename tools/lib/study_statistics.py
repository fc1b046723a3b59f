"""The study's statistics: intervals over seeds, ratios and slopes with bootstrap intervals. Intervals are
[low, estimate, high] at 95 %."""

import math
import random
import statistics

CONFIDENCE = 0.95
RESAMPLES = 2000


def t_quantile(freedom, probability=0.5 + CONFIDENCE / 2):
    """Student's: closed forms for 1 and 2 degrees of freedom, else Abramowitz and Stegun (1964), 26.7.5."""
    if freedom == 1:
        return math.tan(math.pi * (probability - 0.5))
    if freedom == 2:
        return (2 * probability - 1) / math.sqrt(2 * probability * (1 - probability))
    x = statistics.NormalDist().inv_cdf(probability)
    terms = [(x**3 + x) / 4, (5 * x**5 + 16 * x**3 + 3 * x) / 96, (3 * x**7 + 19 * x**5 + 17 * x**3 - 15 * x) / 384,
             (79 * x**9 + 776 * x**7 + 1482 * x**5 - 1920 * x**3 - 945 * x) / 92160]
    return x + sum(term / freedom ** (order + 1) for order, term in enumerate(terms))


def mean_interval(values, other_error=0.0):
    """Of the mean over replicates; `other_error`, the standard error of what they share, is added in quadrature. One
    replicate has no interval."""
    mean = statistics.fmean(values)
    if len(values) < 2:
        return [None, mean, None]
    spread = t_quantile(len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))
    half = math.hypot(spread, statistics.NormalDist().inv_cdf(0.5 + CONFIDENCE / 2) * other_error)
    return [mean - half, mean, mean + half]


def signed_root(value):
    """Of a mean squared error from which noise was subtracted: one below zero stays below zero."""
    return math.copysign(math.sqrt(abs(value)), value)


def percentile_interval(estimate, resampled):
    ordered = sorted(resampled)
    edge = (1 - CONFIDENCE) / 2 * (len(ordered) - 1)
    return [ordered[round(edge)], estimate, ordered[round(len(ordered) - 1 - edge)]]


def bootstrap(estimator, samples):
    """Percentile interval (Efron 1979) of estimator(samples), a list of lists that are resampled each by itself."""
    generator = random.Random(1)
    estimate = estimator(samples)
    if any(len(values) < 2 for values in samples):
        return [None, estimate, None]
    draws = (estimator([generator.choices(values, k=len(values)) for values in samples]) for _ in range(RESAMPLES))
    return percentile_interval(estimate, draws)


def ratio_of_means(samples):
    above, below = map(statistics.fmean, samples)
    return above / below if below > 0 else math.inf


def inefficiency_ratio(errors, seconds, other_errors, other_seconds):
    """(MSE T) / (MSE T) of two methods: how many times longer the first needs for the second's error. Errors are mean
    squared errors by seed; the noise of timing is left out by taking the median."""
    if statistics.fmean(other_errors) <= 0:
        return [None, None, None]  # without an error there is no efficiency
    factor = statistics.median(seconds) / statistics.median(other_seconds)
    return [value if value is None else value * factor for value in bootstrap(ratio_of_means, [errors, other_errors])]


def fitted_line(points):
    """Least squares through (x, y): slope, intercept."""
    mean_x = statistics.fmean(x for x, _ in points)
    mean_y = statistics.fmean(y for _, y in points)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)
    return slope, mean_y - slope * mean_x


def log_log_slope(counts, squared_errors):
    """Slope of log RMSE against log count, with its interval by resampling the seeds of each count; and the line's value
    at each count. A resample whose mean is not above zero has no logarithm: it counts as the smallest that has."""
    def points(samples):
        means = [statistics.fmean(values) for values in samples]
        least = min((mean for mean in means if mean > 0), default=1.0)
        return [(math.log(count), 0.5 * math.log(max(mean, least))) for count, mean in zip(counts, means)]

    slope, intercept = fitted_line(points(squared_errors))
    interval = bootstrap(lambda samples: fitted_line(points(samples))[0], squared_errors)
    return interval, [math.exp(intercept + slope * math.log(count)) for count in counts]

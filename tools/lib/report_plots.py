"""Plots of a run by matplotlib: error against seconds and against samples, bias against seconds. Drawn once, in the light
colours; the page's script and style find the parts of a variant by their names (`group`)."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from report_text import plain_number, plain_percent

# Of variants: apart for colour-blind eyes (after Okabe and Ito 2008, darkened to a contrast of 3 on white), and no two alike in
# mark. report_style has the same for a dark page.
SERIES = ["#0072b2", "#c8500a", "#00805a", "#a8458f", "#8a6500", "#2089c4", "#5c5f66", "#7d1f40"]
MARKS = ["o", "s", "^", "D", "v", "P", "X", "p"]
INK, SOFT, GRID, SHADE, PAPER = "#1b1c1e", "#5d6168", "#dcdee2", "#e6e8eb", "#fffffe"
SIZE = (5.6, 4.0)  # inches: about as wide as a phone, so that letters stay legible there

STYLE = {"font.size": 10.5, "font.family": "DejaVu Sans", "axes.edgecolor": SOFT, "axes.labelcolor": INK, "xtick.color": SOFT,
         "ytick.color": SOFT, "text.color": SOFT, "axes.grid": True, "grid.color": GRID, "grid.linewidth": 0.8,
         "axes.spines.top": False, "axes.spines.right": False, "axes.facecolor": PAPER, "figure.facecolor": PAPER,
         "svg.fonttype": "none", "legend.frameon": False, "axes.axisbelow": True, "lines.markersize": 5}


def colour(place):
    return SERIES[place % len(SERIES)]


def marker(place):
    """Another one for every variant until both lists repeat."""
    return MARKS[(place + place // len(SERIES)) % len(MARKS)]


def group(place):
    """What names the parts of a variant."""
    return f"variant-{place}"


def above(value, least):
    return value is not None and value > least


def series(variant, abscissa, measure):
    """Arrays x, low, estimate, high of the checkpoints whose estimate has a logarithm; without an interval low and high are
    the estimate."""
    rows = []
    for point in variant["checkpoints"]:
        found = point[measure]
        if found and above(found[1], 0):
            low, estimate, high = found
            rows.append((point[abscissa], estimate if low is None else low, estimate, estimate if high is None else high))
    return numpy.array(rows, dtype=float).reshape(-1, 4).T


def decades(low, high):
    """Places of ticks: 1, 2 and 5 where there are few powers of ten, else powers, every n-th where there are many."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    digits = (1, 2, 5) if math.log10(high / low) <= 3.3 else (1,)
    step = 1 if len(digits) > 1 else max(1, (last - first) // 6)
    places = [digit * 10.0**power for power in range(first, last + 1, step) for digit in digits]
    return [place for place in places if low <= place <= high]


def set_axis(axis, low, high, write):
    axis.set_major_locator(FixedLocator(decades(low, high)))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: write(value)))


def limits(values, margin):
    """The ends of a logarithmic axis."""
    return min(values) / margin, max(values) * margin


def figure(xlabel, ylabel):
    drawn, axes = pyplot.subplots(figsize=SIZE, layout="constrained")
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return drawn, axes


def draw_errors(axes, run, abscissa):
    """Curves with their bands; the renderer's own estimate dashed."""
    for place, variant in enumerate(run.variants):
        x, low, estimate, high = series(variant, abscissa, "relativeRmse")
        axes.fill_between(x, numpy.maximum(low, 1e-9), high, color=colour(place), alpha=0.25, linewidth=0,
                          gid=f"{group(place)}-band")
        axes.plot(x, estimate, color=colour(place), marker=marker(place), linewidth=1.8, gid=f"{group(place)}-error",
                  label=variant["name"])
        x, _, estimate, _ = series(variant, abscissa, "estimate")
        axes.plot(x, estimate, color=colour(place), linewidth=1.3, dashes=(4, 2.5), gid=f"{group(place)}-estimate")


def values_of(run, abscissa):
    """All that must fit on the axes."""
    found = [series(variant, abscissa, measure) for variant in run.variants for measure in ("relativeRmse", "estimate")]
    x = [float(value) for rows in found for value in rows[0]]
    y = [float(value) for rows in found for value in rows[2]]
    return x, y


def noise_of(run):
    """Relative RMSE of the reference itself."""
    return (run.data["reference"] or {}).get("relativeRmse")


def draw_levels(axes, run, right):
    """The errors that times are asked for."""
    for error in run.data["errors"]:
        low, high = axes.get_ylim()
        if low < error < high:
            axes.axhline(error, color=INK, linewidth=0.9, dashes=(1, 2))
            axes.text(right, error, plain_percent(error), va="bottom", ha="right", color=INK, fontsize=9)


def draw_noise(axes, run, right):
    noise = noise_of(run)
    low, high = axes.get_ylim()
    if above(noise, low):
        axes.axhspan(low, min(noise, high), color=SHADE, linewidth=0)
        axes.text(right, noise, "noise of the reference ", va="top", ha="right", fontsize=9)


def set_limits(axes, run, abscissa):
    """Room for every estimate; nothing if there is none."""
    x, y = values_of(run, abscissa)
    if not x:
        return None
    levels = [level for level in run.data["errors"] if level > min(y) / 3]
    (left, right), (low, high) = limits(x, 1.3), limits(y + levels, 1.4)
    noise = noise_of(run)
    if above(noise, low / 5):
        low = min(low, noise / 1.5)
    axes.set(xscale="log", yscale="log", xlim=(left, right), ylim=(low, high))
    set_axis(axes.xaxis, left, right, plain_number)
    set_axis(axes.yaxis, low, high, plain_percent)
    return left, right, x, y


def nothing(axes, what):
    axes.set(xticks=[], yticks=[])
    axes.text(0.5, 0.5, what, ha="center", va="center", transform=axes.transAxes)


def error_time(run):
    drawn, axes = figure("seconds of rendering", "relative RMSE")
    room = set_limits(axes, run, "wallSeconds")
    if room:
        draw_noise(axes, run, room[1])
        draw_levels(axes, run, room[1])
        draw_errors(axes, run, "wallSeconds")
    else:
        nothing(axes, "no error above zero was measured")
    return drawn


def draw_guide(axes, x, y):
    """The slope of independent samples, below the curves."""
    left, right = min(x), max(x)
    start = min(value * math.sqrt(place / left) for place, value in zip(x, y)) / 1.5
    axes.plot([left, right], [start, start * math.sqrt(left / right)], color=INK, linewidth=1.1, dashes=(6, 2, 1, 2))
    low = axes.get_ylim()[0]
    middle = min(math.sqrt(left * right), left * (start / (1.3 * low))**2)
    if middle > left:
        axes.annotate("slope −½", (middle, start * math.sqrt(left / middle)), xytext=(-8, -3), textcoords="offset points",
                      va="top", ha="right", fontsize=9, color=INK)


def error_samples(run):
    drawn, axes = figure("samples a pixel", "relative RMSE")
    room = set_limits(axes, run, "samplesPerPixel")
    if room:
        draw_noise(axes, run, room[1])
        draw_guide(axes, *room[2:])
        draw_errors(axes, run, "samplesPerPixel")
    else:
        nothing(axes, "no error above zero was measured")
    return drawn


def biases(variant):
    """Arrays seconds, low, estimate, high."""
    rows = [(point["wallSeconds"], *point["bias"]) for point in variant["checkpoints"]
            if point["bias"] and None not in point["bias"]]
    return numpy.array(rows, dtype=float).reshape(-1, 4).T


def bias_ticks(small, large):
    """On both sides of 0, powers of ten from what is linear on."""
    first, last = math.ceil(math.log10(small)), math.floor(math.log10(large))
    step = max(1, (last - first + 1) // 3)
    values = [10.0**power for power in range(last, first - 1, -step)] or [small]
    if len(values) == 1:
        values += [digit * values[0] for digit in (0.2, 0.5, 2, 5) if small / 3 < digit * values[0] < large]
    return sorted([-value for value in values] + [0.0] + values)


def set_bias_axis(axes, extent, widths):
    """Linear up to the smallest interval, logarithmic beyond: the first checkpoints are a hundred times the last ones."""
    large = 1.5 * max(extent)
    small = min(max(min(widths), large / 1e4), large / 2)
    axes.set_yscale("symlog", linthresh=small, linscale=0.6)
    axes.set_ylim(-large, large)
    axes.yaxis.set_major_locator(FixedLocator(bias_ticks(small, large)))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain_percent(value)))


def draw_bias(axes, place, variant, rows):
    x, low, estimate, high = rows
    shifted = x * 1.045**(place % 5 - 2)  # so that intervals do not hide each other
    lengths = numpy.maximum(estimate - low, 0), numpy.maximum(high - estimate, 0)
    axes.errorbar(shifted, estimate, yerr=lengths, color=colour(place), fmt=marker(place), elinewidth=1.4,
                  capsize=2.5, label=variant["name"])
    for part in axes.containers[-1].get_children():
        part.set_gid(f"{group(place)}-bias")


def bias_time(run):
    drawn, axes = figure("seconds of rendering", "bias of mean luminance")
    found = [biases(variant) for variant in run.variants]
    x = [float(value) for rows in found for value in rows[0]]
    extent = [float(abs(value)) for rows in found for value in rows[1:].flat]
    widths = [float(width) for rows in found for width in (rows[3] - rows[1]) / 2 if width > 0]
    if not x or not widths:
        nothing(axes, "no bias was measured")
        return drawn
    set_bias_axis(axes, extent, widths)
    left, right = limits(x, 1.4)
    axes.set(xscale="log", xlim=(left, right))
    set_axis(axes.xaxis, left, right, plain_number)
    sure = (run.data["reference"] or {}).get("relativeBiasError")
    if above(sure, 0):
        axes.axhspan(-1.96 * sure, 1.96 * sure, color=SHADE, linewidth=0)
    axes.axhline(0, color=INK, linewidth=1)
    for place, (variant, rows) in enumerate(zip(run.variants, found)):
        draw_bias(axes, place, variant, rows)
    return drawn


def estimates(variant):
    """Arrays samples, low, estimate, high of the estimated over the true error."""
    found = [(point["samplesPerPixel"], (point["calibration"] or {}).get("estimateOverError"))
             for point in variant["checkpoints"]]
    rows = [(x, *ratio) for x, ratio in found if ratio and None not in ratio]
    return numpy.array(rows, dtype=float).reshape(-1, 4).T


def draw_estimate(axes, place, variant, rows):
    x, low, estimate, high = rows
    axes.fill_between(x, low, high, color=colour(place), alpha=0.22, linewidth=0, gid=f"{group(place)}-band")
    axes.plot(x, estimate, color=colour(place), marker=marker(place), linewidth=1.8, gid=f"{group(place)}-ratio",
              label=variant["name"])


def estimate_samples(run):
    """Nothing where no checkpoint has a calibration."""
    found = [estimates(variant) for variant in run.variants]
    x = [float(value) for rows in found for value in rows[0]]
    if not x:
        return None
    drawn, axes = figure("samples a pixel", "estimated over true error")
    left, right = limits(x, 1.3)
    values = [float(value) for rows in found for value in rows[2]]
    axes.set(xscale="log", xlim=(left, right), ylim=(min(0.6, 0.9 * min(values)), max(1.4, 1.1 * max(values))))
    set_axis(axes.xaxis, left, right, plain_number)
    axes.axhspan(0.9, 1.1, color=SHADE, linewidth=0)
    axes.axhline(1, color=INK, linewidth=1)
    for place, (variant, rows) in enumerate(zip(run.variants, found)):
        draw_estimate(axes, place, variant, rows)
    return drawn


PLOTS = {"error-time": error_time, "error-samples": error_samples, "bias-time": bias_time, "estimate-samples": estimate_samples}


def add_legend(drawn):
    axes = drawn.axes[0]
    handles, labels = axes.get_legend_handles_labels()
    if any(line.get_gid() and line.get_gid().endswith("-estimate") and len(line.get_xdata()) for line in axes.lines):
        handles.append(Line2D([], [], color=SOFT, linewidth=1.3, dashes=(4, 2.5)))
        labels.append("own estimate")
    if handles:
        columns = max(1, min(4, int(64 / (4 + max(map(len, labels))))))
        drawn.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=columns, fontsize=9)


def add_title(drawn, run):
    drawn.axes[0].set_title(run.title, fontsize=11, color=INK, loc="left")

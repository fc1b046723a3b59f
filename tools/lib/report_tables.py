"""The tables of a run: times to errors, rates, ratios, calibration, every checkpoint."""

from page_parts import text
from report_figures import (COVERAGE_LIMITS, ESTIMATE_LIMITS, best, calibrations, outside, ratios_at, time_to)
from report_parts import block, cell, empty_cell, interval_cell, table, variant_name
from report_text import clock, inverse, plain_percent, short, short_percent, short_seconds

MATRIX_LIMIT = 8    # variants; more are a list
CALIBRATED = 3      # checkpoints shown a variant, the last ones
EXTRAPOLATED = "extrapolated"


def named(run):
    return [(place, variant, variant_name(place, variant)) for place, variant in enumerate(run.variants)]


def reason_of(variant, error):
    return next((found["reason"] or "" for found in variant["timeTo"] if found["error"] == error), "")


def noted(ends, extrapolated):
    """The interval, and on a line of its own that it is extrapolated."""
    return "\n".join(filter(None, (ends, EXTRAPOLATED if extrapolated else "")))


def time_cell(variant, error, is_best):
    found = time_to(variant, error)
    if not found:
        return empty_cell(reason_of(variant, error))
    low, seconds, high = found["seconds"]
    ends = "" if None in (low, high) else f"{clock(low)} to {clock(high)}"
    kinds = " ".join(filter(None, ("best" if is_best else "", EXTRAPOLATED if found["extrapolated"] else "")))
    return cell(clock(seconds), noted(ends, found["extrapolated"]), kinds)


def times(run):
    errors = run.data["errors"]
    winners = [best(run, error) for error in errors]
    rows = [(name, [time_cell(variant, error, place == winner) for error, winner in zip(errors, winners)]
             + [cell(short_seconds(variant["setupSeconds"]))]) for place, variant, name in named(run)]
    heads = ["variant"] + [f"to {plain_percent(error)}" for error in errors] + ["set-up, apart"]
    return block(f"{run.slug}-times", "Time to an error",
                 "Seconds of rendering until the relative RMSE is reached, with 95 % intervals; the least in bold. Extrapolated times "
                 "follow the fitted slope beyond what was measured. Set-up is loading, building, uploading and compiling; no "
                 "other figure holds it.", table("Time to an error", heads, rows))


def holds_cell(variant):
    if variant["slopeHolds"] is None:
        return empty_cell()
    return cell("yes") if variant["slopeHolds"] else cell("no", "no extrapolation", "outside")


def floor_cell(found):
    kind = "outside" if found and found[0] is not None and found[0] > 0 else ""
    return interval_cell(found, lambda value: short(value, 2), kind)


def relative_cell(variant, most):
    found = variant["efficiency"]
    return cell(f"{short(100 * found[1] / most)}\u00a0%") if found and most else empty_cell()


def rates(run):
    most = max((variant["efficiency"][1] for variant in run.variants if variant["efficiency"]), default=0)
    rows = [(name, [interval_cell(variant["efficiency"], short), relative_cell(variant, most),
                    interval_cell(variant["slopeTime"], short), interval_cell(variant["slopeSamples"], short),
                    floor_cell(variant["floor"]), holds_cell(variant)]) for _, variant, name in named(run)]
    return block(f"{run.slug}-rates", "Efficiency and rate",
                 "Efficiency is 1/(MSE · seconds) at the last checkpoint. Slopes are of log MSE: −1 for independent samples (−½ for "
                 "RMSE), steeper for low-discrepancy points. A floor above 0 with its whole interval is bias, as relative MSE.",
                 table("Efficiency and rate", ["variant", "efficiency", "of the best", "slope over time", "slope over samples", "floor",
                                               "slope holds"], rows))


def directed(ratios, row, column):
    """How many times sooner `row` is than `column`, and whether that is extrapolated."""
    for ratio in ratios:
        if (ratio["faster"], ratio["slower"]) == (row, column):
            return ratio["ratio"], ratio["extrapolated"]
        if (ratio["faster"], ratio["slower"]) == (column, row):
            return inverse(ratio["ratio"]) or [None, 1 / ratio["ratio"][1], None], ratio["extrapolated"]
    return None, False


def ratio_cell(found, extrapolated):
    if not found:
        return empty_cell()
    low, estimate, high = found
    kind = "gain" if low is not None and low > 1 else "loss" if high is not None and high < 1 else ""
    ends = "" if None in (low, high) else f"{short(low)} to {short(high)}"
    kinds = " ".join(filter(None, (kind, EXTRAPOLATED if extrapolated else "")))
    return cell(f"×{short(estimate)}", noted(ends, extrapolated), kinds)


def matrix(run, error):
    ratios, names = ratios_at(run, error), [variant["name"] for variant in run.variants]
    rows = [(shown, [cell("", "", "self") if other == variant["name"] else ratio_cell(*directed(ratios, variant["name"], other))
                     for other in names]) for _, variant, shown in named(run)]
    return f"<h4>To {plain_percent(error)}</h4>" + table(f"Ratios at {plain_percent(error)}", ["row sooner than"] + names, rows)


def ratio_list(run, error):
    rows = [(text(ratio["faster"]), [cell(ratio["slower"]), ratio_cell(ratio["ratio"], ratio["extrapolated"])])
            for ratio in sorted(ratios_at(run, error), key=lambda ratio: -ratio["ratio"][1])]
    return f"<h4>To {plain_percent(error)}</h4>" + table(f"Ratios at {plain_percent(error)}", ["sooner", "later", "times"], rows)


def ratios(run):
    if len(run.variants) < 2:
        return ""
    show = matrix if len(run.variants) <= MATRIX_LIMIT else ratio_list
    shown = [show(run, error) for error in run.data["errors"] if ratios_at(run, error)]
    if not shown:
        return ""
    return block(f"{run.slug}-ratios", "Who is sooner",
                 "How many times sooner the variant of the row reaches the error than that of the column, with 95 % intervals over "
                 "seeds. Tinted where the interval leaves out 1.", f'<div class="matrices">{"".join(shown)}</div>')


def marked_cell(figure, below, side):
    sign = {"below": " ▼", "above": " ▲", "": ""}[side]
    return cell(figure + sign, below, "outside" if side else "")


def mean_cell(coverage):
    """With its counts: they are few."""
    if not coverage or not coverage["total"]:
        return empty_cell()
    return coverage_cell(coverage, f"{short(coverage['inside'])} of {short(coverage['total'])}")


def coverage_cell(coverage, counted=""):
    if not coverage or not coverage["total"]:
        return empty_cell()
    share = coverage["share"] or [None, coverage["inside"] / coverage["total"], None]
    ends = "" if None in share else f"{short_percent(share[0])} to {short_percent(share[2])}"
    below = "\n".join(filter(None, (ends, counted)))
    return marked_cell(short_percent(share[1]), below, outside(coverage["share"], COVERAGE_LIMITS))


def estimate_cell(found):
    if not found:
        return empty_cell()
    low, estimate, high = found
    ends = "" if None in (low, high) else f"{short(low)} to {short(high)}"
    return marked_cell(short(estimate), ends, outside(found, ESTIMATE_LIMITS))


def pixel_heads(points):
    longest = max((point["calibration"]["pixels"] or [] for point in points), key=len, default=[])
    return [f"pixels ≤ {short(part['below'], 2)}" if part and part["below"] is not None else f"pixels, part {place}"
            for place, part in enumerate(longest, 1)]


def calibration_row(point, fifths):
    found = point["calibration"]
    pixels = (found["pixels"] or []) + [None] * fifths
    return ([cell(short(point["samplesPerPixel"]))] + [mean_cell(found["meanLuminance"])]
            + [coverage_cell(part) for part in pixels[:fifths]] + [estimate_cell(found["estimateOverError"])])


def calibration(run):
    points = [point for variant in run.variants for point in calibrations(variant)]
    if not points:
        return ""
    heads = pixel_heads(points)
    rows = [(name, calibration_row(point, len(heads))) for _, variant, name in named(run)
            for point in calibrations(variant)[-CALIBRATED:]]
    return block(f"{run.slug}-calibration", "Calibration",
                 "How often the renderer's 95 % intervals hold the truth, over seeds: of the image's mean luminance, and of pixels by "
                 "the reference's luminance, in fifths of the lit ones; and its estimate of the error over the true one. Marked ▼ ▲ "
                 "where the whole interval of the figure lies outside 93 to 97 %, or 0.9 to 1.1.",
                 table("Calibration", ["variant", "samples a pixel", "image mean", *heads, "estimate over error"], rows))


def checkpoint_row(point):
    def small(value):
        return short(value, 3)
    return [cell(short(point["samplesPerPixel"])), cell(short(point["raysPerPixel"])), cell(short(point["wallSeconds"])),
            cell(short(point["deviceSeconds"])), interval_cell(point["relativeRmse"], short_percent),
            interval_cell(point["estimate"], short_percent), interval_cell(point["bias"], lambda value: short_percent(value, 2)),
            interval_cell(point["mse"], small), interval_cell(point["relMse"], small),
            interval_cell(point["relMseTrimmed"], small),
            interval_cell(point["biasSquared"], lambda value: short(value, 2)), interval_cell(point["mae"], small),
            interval_cell(point["flip"], small)]


def checkpoints(run):
    rows = [(name, checkpoint_row(point)) for _, variant, name in named(run) for point in variant["checkpoints"]]
    heads = ["variant", "samples a pixel", "rays a pixel", "seconds", "device seconds", "relative RMSE", "own estimate", "bias",
             "MSE", "relMSE", "relMSE, trimmed", "bias²", "MAE", "FLIP"]
    return (f'<details class="block" id="{run.slug}-checkpoints"><summary>Every checkpoint</summary><p>Means over seeds with '
            "95 % intervals. relMSE divides by r² + 0.01; trimmed, it leaves out the worst 0.1 % of pixels.</p>"
            + table("Every checkpoint", heads, rows) + "</details>")

"""The tables of `tools/bench/peers`, in Markdown."""

from peers_renderers import VARIANTS

TARGET = 0.05
EQUALITY = ["scene", "renderer", "difference of the mean", "worst block", "by chance", "its own noise", "errors against"]
TIMES = ["scene", "renderer", "time to 5 %", "times Isolux's", "slope", "set-up", "largest samples a pixel"]


def markdown(headings, rows):
    lines = [headings, ["---"] * len(headings), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def percent(interval):
    low, middle, high = interval
    return f"{100 * middle:+.2f} % [{100 * low:+.2f}, {100 * high:+.2f}]"


def equality_rows(scene, equality):
    for renderer, found in equality.items():
        noise = f"{100 * found['relativeRmse']:.2f} % ({found['samplesPerPixel']} samples)"
        if renderer == "isolux":
            yield [scene, renderer, "", "", "", noise, "its own"]
            continue
        block = found["block"]
        yield [scene, renderer, percent(found["bias"]), f"{100 * block['relative']:+.1f} %, {abs(block['score']):.1f} σ",
               f"{block['limit']:.1f} σ", noise, "its own: differs" if found["differs"] else "Isolux's"]


def equality_table(results):
    return markdown(EQUALITY, [row for result in results for row in equality_rows(result["scene"], result["equality"])])


def seconds_text(entry):
    low, middle, high = entry["seconds"]
    if middle is None:
        return entry["reason"] or "not reached"
    spread = "" if low is None or high is None else f" [{low:.3g}, {high:.3g}]"
    return f"{middle:.3g} s{spread}{' (extrapolated)' if entry['extrapolated'] else ''}"


def ratio(fit, variant, base):
    """How many times Isolux's time a variant takes, of the ratio that the fit has in one of both directions."""
    for found in fit["ratios"]:
        if abs(found["error"] - TARGET) > 1e-9 or {found["faster"], found["slower"]} != {variant, base}:
            continue
        values = found["ratio"]
        if found["faster"] == variant:
            values = [None if value is None else 1 / value for value in reversed(values)]
        return values
    return None


def ratio_text(fit, variant):
    if variant.comparable == variant.name:
        return "1"
    values = ratio(fit, variant.name, variant.comparable)
    if values is None or values[1] is None:
        return ""
    low, middle, high = values
    spread = "" if low is None or high is None else f" [{low:.2g}, {high:.2g}]"
    return f"{middle:.2g}{spread} of {variant.comparable}"


def time_rows(scene, fit):
    summaries = {summary["name"]: summary for summary in fit["variants"]}
    for variant in VARIANTS:
        summary = summaries.get(variant.name)
        if summary is None:
            continue
        reached = next(entry for entry in summary["timeTo"] if abs(entry["error"] - TARGET) < 1e-9)
        slope = summary["slopeTime"][1]
        yield [scene, variant.name, seconds_text(reached), ratio_text(fit, variant), "" if slope is None else f"{slope:.2f}",
               f"{summary['setupSeconds']:.2g} s", f"{summary['checkpoints'][-1]['samplesPerPixel']:.0f}"]


def times_table(results):
    return markdown(TIMES, [row for result in results if result["fit"] for row in time_rows(result["scene"], result["fit"])])

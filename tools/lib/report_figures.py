"""What a report says of a run beside its plots and tables: the best variant, sentences, warnings."""

import math
import re

from report_text import NO_BREAK, plain_percent, short, short_percent

# Nominal 95 % intervals are held to 93 to 97 %, the estimated error to 10 % of the true one; a figure is outside if its whole
# interval is.
COVERAGE_LIMITS = (0.93, 0.97)
ESTIMATE_LIMITS = (0.9, 1.1)
SENTENCES = 4  # as headlines of a run

WORDS = {"nonFiniteSamples": "samples NaN or infinite", "negativeSamples": "samples negative",
         "stackOverflows": "traversal stack overflows", "invalidIndices": "invalid indices",
         "clampedSamples": "samples clamped"}


def time_to(variant, error):
    """The entry of that error whose time is known."""
    return next((found for found in variant["timeTo"] if math.isclose(found["error"], error) and found["seconds"]), None)


def best(run, error):
    """The variant that reaches an error first."""
    reached = [(found["seconds"][1], place) for place, variant in enumerate(run.variants) if (found := time_to(variant, error))]
    return min(reached)[1] if reached else None


def ratios_at(run, error):
    return [ratio for ratio in run.data["ratios"] if math.isclose(ratio["error"], error) and ratio["ratio"]]


def settled(ratio):
    low = ratio["ratio"][0]
    return low is not None and low > 1


def sentence(ratio):
    low, estimate, high = ratio["ratio"]
    ends = "" if None in (low, high) else f" ({short(low)}–{short(high)})"
    said = ratio["text"] or (f"{ratio['faster']} reaches {plain_percent(ratio['error'])} relative RMSE {short(estimate)}{ends} "
                             f"times sooner than {ratio['slower']}")
    notes = ["extrapolated"] if ratio["extrapolated"] and "extrapolated" not in said else []
    notes += [] if settled(ratio) else ["not settled: the interval holds 1"]
    return said + (f" ({', '.join(notes)})" if notes else "")


def ahead(run, error, count):
    """Sentences of the best variant at an error against the others, the closest first."""
    winner = best(run, error)
    if winner is None:
        return []
    name = run.variants[winner]["name"]
    found = sorted((ratio for ratio in ratios_at(run, error) if ratio["faster"] == name),
                   key=lambda ratio: ratio["ratio"][1])
    if found:
        return [sentence(ratio) for ratio in found[:count]]
    return [f"{name} is the only variant that can be said to reach {plain_percent(error)} relative RMSE"]


def headlines(run):
    """At the first error that is reached against several variants, at the others against the next one."""
    found = []
    for error in run.data["errors"]:
        found += ahead(run, error, 1 if found else SENTENCES)
    return found or ["No variant can be said to reach the errors asked for"]


def outside(found, limits):
    """"below" or "above", if the whole interval lies there."""
    if not found or None in found:
        return ""
    low, _, high = found
    return "below" if high < limits[0] else "above" if low > limits[1] else ""


def calibrations(variant):
    """Checkpoints that have one."""
    return [point for point in variant["checkpoints"] if point["calibration"]]


def miscalibrated(variant):
    """What is outside at the last checkpoint; pixels aside, which the table marks: where they are dark, most intervals fail."""
    if not calibrations(variant):
        return []
    found = calibrations(variant)[-1]["calibration"]
    mean = found["meanLuminance"]
    names = ["the interval of the image's mean"] if mean and outside(mean["share"], COVERAGE_LIMITS) else []
    return names + (["the estimate of the error"] if outside(found["estimateOverError"], ESTIMATE_LIMITS) else [])


def spaced(name):
    return WORDS.get(name) or re.sub(r"([A-Z])", r" \1", name).lower()


def counted(run):
    """What the renderer counts of what should not be, zeros too. The depth limit, a setting, is among the facts."""
    found = (run.data["diagnostics"] or {}) | (run.data["truncated"] or {})
    return [(count, f"{short(count)} {spaced(name)}") for name, count in found.items()
            if count is not None and name != "maxDepth"]


def variant_warnings(variant):
    floor = variant["floor"]
    if floor and floor[0] is not None and floor[0] > 0:
        yield f"{variant['name']}: the error ends at a floor of {short_percent(math.sqrt(floor[1]), 2)}, which is bias"
    elif variant["slopeHolds"] is False:
        yield f"{variant['name']}: the error does not fall as it should, so nothing is extrapolated"
    names = miscalibrated(variant)
    if names:
        verb = "are" if len(names) > 1 else "is"
        yield f"{variant['name']}: {' and '.join(names)} {verb} miscalibrated at the last checkpoint"


def warnings(run):
    noisy = [name for name in (run.data["reference"] or {}).get("tooNoisy") or [] if name]
    if noisy:
        yield f"The reference is too noisy for the errors of {', '.join(noisy)}"
    yield from (words for count, words in counted(run) if count)
    for variant in run.variants:
        yield from variant_warnings(variant)
    for name in missing_images(run):
        yield f"The image {name} is missing"


def image_names(run):
    images = run.data["images"] or {}
    found = [images.get("reference")]
    for entry in images.get("variants") or []:
        found += [entry["image"], entry["flip"]] if entry else []
    return [name for name in found if name]


def missing_images(run):
    return [name for name in image_names(run) if not (run.folder / name).is_file()]


def seed_text(seeds):
    """[0, 1, 2] as "3 (0 to 2)"."""
    if seeds == list(range(int(seeds[0]), int(seeds[0]) + len(seeds))):
        return f"{len(seeds)} ({seeds[0]} to {seeds[-1]})"
    return f"{len(seeds)} ({', '.join(map(str, seeds))})"


def reference_text(reference):
    sizes = f"{short(reference['samplesPerPixel'])} samples a pixel" if reference["samplesPerPixel"] else ""
    rmse, error = reference["relativeRmse"], reference["relativeBiasError"]
    own = f"its own relative RMSE {short_percent(rmse, 2)}" if rmse is not None else ""
    sure = f"its mean to {short_percent(error, 2)} (standard error)" if error is not None else ""
    return ", ".join(filter(None, (sizes, reference["method"], own, sure)))


def facts(run):
    """Names and texts of what a reader must know; unknown: None."""
    data = run.data
    sides = [data["width"], data["height"]]
    size = f"{NO_BREAK}×{NO_BREAK}".join(map(short, sides)) + " pixels" if all(sides) else None
    depth = None if data["scene"] is None else "none" if data["maxDepth"] is None else short(data["maxDepth"])
    driver = " ".join(filter(None, (data["driver"], data["driverVersion"]))) or None
    flip = (data["flip"] or {}).get("pixelsPerDegree")
    seeds = [seed for seed in data["seeds"] or [] if seed is not None]
    version = " ".join(filter(None, (data["version"], data["revision"] and f"(git {data['revision']})"))) or None
    return {"Scene": data["scene"], "Scene hash": data["sceneHash"] and data["sceneHash"][:16], "Image": size,
            "Camera": data["camera"], "Depth limit": depth, "Device": data["device"] or None, "Driver": driver, "Isolux": version,
            "Seeds": seed_text(seeds) if seeds else None, "Reference": data["reference"] and reference_text(data["reference"]),
            "FLIP": f"{short(flip)} pixels a degree" if flip else None}

"""Adaptive sampling against uniform sampling, and the report's gallery."""

import statistics

from study_exr import luminance, read_channels
from study_plan import FULL_DEPTH, depth
from study_statistics import inefficiency_ratio, mean_interval, t_quantile
from study_text import (interval, number, percent, pictures_block, section, seconds, surface_error, table_block, text_block,
                        whole_error)

CHANNELS = ["R", "G", "B", "samples.Y"]
FULL = depth(FULL_DEPTH)

# Of a render whose samples depend on each other (host/scene/render_settings.h).
REPLICATES = 16

# Of the renders that tell what a uniform sample costs.
PILOT_SPP = 64

# Of an interval of 1.96 standard errors.
CONFIDENCE = 0.95


def coverage(run, reference, tolerance):
    """Of the pixels that are lit in the reference: the share within tolerance of it, the same of those that stopped before
    the maximum, and the share that did not."""
    _, _, image = read_channels(run.exr, CHANNELS)
    truth = luminance(read_channels(reference.exr, CHANNELS)[2])
    lit = [(abs(x - r) <= tolerance * r, count < run.request.spp)
           for x, r, count in zip(luminance(image), truth, image["samples.Y"]) if r > 0]
    stopped = [within for within, early in lit if early]
    return {"within": statistics.fmean(within for within, _ in lit),
            "withinOfStopped": statistics.fmean(stopped) if stopped else None,
            "atMaximum": 1 - len(stopped) / len(lit)}


def averaged(values):
    known = [value for value in values if value is not None]
    return statistics.fmean(known) if known else None


def mean_coverage(measured, reference, tolerance):
    found = [coverage(run, reference, tolerance) for run in measured.runs]
    return {name: averaged([one[name] for one in found]) for name in found[0]}


def mean_bias(measured, reference):
    """Of the image's mean luminance, relative: t interval over seeds, with the reference's own error, whose interval comes
    from its replicates."""
    low, mean, high = reference.report["meanLuminance"]
    own = (high - low) / (2 * t_quantile(REPLICATES - 1) * mean)
    return mean_interval([one.relative_bias for one in measured.compared], own)


def adaptive_requests(study, scene, tolerance):
    options = [*FULL, "--adaptive", str(tolerance)]
    return study.seeds(scene, options, study.effort.adaptive_max, study.effort.adaptive_seeds,
                       size=study.effort.adaptive_size, sample_map=True)


def measure(study, scene, tolerance):
    """Adaptive, and uniform with the samples that fit the same time."""
    size, seeds = study.effort.adaptive_size, study.effort.adaptive_seeds
    reference = study.reference(scene, FULL, study.effort.adaptive_reference_spp, size=size)
    groups = {"adaptive": adaptive_requests(study, scene, tolerance),
              "pilot": study.seeds(scene, FULL, PILOT_SPP, seeds, size=size)}
    found = study.runner.interleaved(groups, reference)
    adaptive = found["adaptive"]
    spp = max(2, round(adaptive.median_seconds / found["pilot"].seconds_per_spp))
    uniform = study.runner.measured(study.seeds(scene, FULL, spp, seeds, size=size), reference)
    return {"tolerance": tolerance, "adaptive": adaptive, "uniform": uniform,
            "adaptiveCoverage": mean_coverage(adaptive, reference, tolerance),
            "uniformCoverage": mean_coverage(uniform, reference, tolerance),
            "adaptiveBias": mean_bias(adaptive, reference), "uniformBias": mean_bias(uniform, reference)}


def method_row(scene, entry, method):
    measured, found = entry[method], entry[method + "Coverage"]
    return [scene.stem, percent(entry["tolerance"]), method, number(statistics.fmean(run.spp for run in measured.runs)),
            seconds(measured.median_seconds), percent(found["atMaximum"]) if method == "adaptive" else "–",
            percent(found["within"]), percent(found["withinOfStopped"]) if method == "adaptive" else "–",
            whole_error(measured), surface_error(measured),
            interval(against_uniform(entry)) if method == "adaptive" else "1", interval(entry[method + "Bias"], percent)]


HEAD = ["scene", "tolerance", "method", "mean spp", "time", "lit pixels at the maximum", "within tolerance",
        "of those that stopped", "error, whole image", "error on surfaces", "time for uniform's error", "bias of the mean"]


def against_uniform(entry):
    """How many times longer adaptive takes for uniform sampling's error on surfaces: below 1 it gains."""
    one, other = entry["adaptive"], entry["uniform"]
    return inefficiency_ratio(one.mses, one.seconds, other.mses, other.seconds)


def scene_pictures(study, entry):
    adaptive, uniform = entry["adaptive"], entry["uniform"]
    run = adaptive.runs[0]
    return [study.picture(run, "adaptive", adaptive.compared[0]),
            study.picture(uniform.runs[0], "uniform, equal time", uniform.compared[0]),
            study.picture(run, "samples a pixel", image=run.sample_map)]


def entry_figures(scene, entry, most):
    return {"scene": scene.stem, "tolerance": entry["tolerance"], "maximumSpp": most,
            "meanSpp": statistics.fmean(run.spp for run in entry["adaptive"].runs),
            "coverage": entry["adaptiveCoverage"], "uniformCoverage": entry["uniformCoverage"],
            "relativeRmse": entry["adaptive"].relative_rmse, "uniformRelativeRmse": entry["uniform"].relative_rmse,
            "bias": entry["adaptiveBias"], "uniformBias": entry["uniformBias"], "timeForErrorOfUniform": against_uniform(entry)}


def adaptive_words(figures):
    """What the rule kept, what it cost, and whether the mean shows it."""
    shares = [one["coverage"]["withinOfStopped"] for one in figures if one["coverage"]["withinOfStopped"] is not None]
    biased = sum(one["bias"][0] > 0 or one["bias"][2] < 0 for one in figures)
    sooner = sum(one["timeForErrorOfUniform"][2] < 1 for one in figures)
    later = sum(one["timeForErrorOfUniform"][0] > 1 for one in figures)
    largest = max(abs(one["bias"][1]) for one in figures)
    kept = (f"Of the pixels that stopped before the maximum, {percent(min(shares))} to {percent(max(shares))} are within the "
            "tolerance." if shares else "No pixel stopped before the maximum.")
    return (f"{kept} The mean lies off the reference's by more than its interval in {biased} of {len(figures)} cases, at "
            f"most by {percent(largest)}. Adaptive sampling reaches uniform sampling's error on surfaces sooner in {sooner} of "
            f"{len(figures)} cases and later in {later}.")


RULE = ("The rule makes the relative error of pixels alike; RMSE asks for the absolute error. So adaptive sampling spends its "
        "samples on dark pixels, and need not win by RMSE where it keeps its promise. A rule that looks at the samples it is "
        "about to average tends to stop too early on pixels whose light is rare, which makes the mean too dark (Kirk and Arvo "
        "1991); the least number of samples and the neighbours are there against that.")


def adaptive_table(study, rows):
    most, seeds = study.effort.adaptive_max, study.effort.adaptive_seeds
    width, height = study.effort.adaptive_size
    caption = (f"{width} × {height} pixels. A pixel stops when 1.96 standard errors of its luminance are at most the tolerance "
               f"times its mean, and those of its neighbours of theirs, tested every 32 samples from the 64th on; all stop at "
               f"{most}. Within tolerance: the share of the lit pixels whose luminance x has |x − r| ≤ tolerance · r against "
               f"the reference r; {percent(CONFIDENCE)} is what the rule promises of those that stopped, less what the "
               f"reference's own noise takes. Relative RMSE and the bias of the mean: over {seeds} seeds [95 %, t].")
    call = f"isolux render SCENE -o image.exr --size {width}x{height} --max-depth {FULL_DEPTH} --seed 0...{seeds - 1} "
    return table_block(caption, HEAD, rows, [f"{call}--sample-map samples.png --spp {most} --adaptive T", f"{call}--spp N"])


def adaptive_section(study):
    most = study.effort.adaptive_max
    pictures, rows, figures = [], [], []
    for scene in (study.scenes.spheres, study.scenes.dragon):
        for tolerance in study.effort.tolerances:
            entry = measure(study, scene, tolerance)
            rows += [method_row(scene, entry, method) for method in ("adaptive", "uniform")]
            figures.append(entry_figures(scene, entry, most))
            caption = f"{scene.stem}, tolerance {percent(tolerance)}, at most {most} samples a pixel"
            pictures.append(pictures_block(caption, scene_pictures(study, entry)))
    first = figures[0]
    headline = (f"Adaptive at {percent(first['tolerance'])}, {first['scene']}: pixels within it, of those that stopped",
                f"{percent(first['coverage']['withinOfStopped'])}; bias of the mean {interval(first['bias'], percent)}")
    blocks = [adaptive_table(study, rows), text_block(adaptive_words(figures)), text_block(RULE), *pictures]
    return section("adaptive", "Adaptive sampling", blocks, {"runs": figures}, [headline])


def gallery_section(study):
    items = []
    for scene in study.scenes.gallery:
        run = study.runner.render(study.request(scene, FULL, study.effort.gallery_spp))
        compared, = study.runner.compared([run], study.reference(scene, FULL, 2 * study.effort.reference_spp))
        items.append(study.picture(run, scene.stem, compared))
    block = pictures_block("The scenes of the report's part on global illumination", items)
    return section("gallery", "Global illumination: bunny, dragon, blob, bench", [block], {"scenes": len(items)}, [])

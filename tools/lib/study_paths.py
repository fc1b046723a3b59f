"""Global illumination: light by bounces, Russian roulette, the number of samples."""

import math

from study_exr import read_channels
from study_plan import FULL_DEPTH, FURNACE, FURNACE_ALBEDO, depth, largest_albedo
from study_runs import root_mean_square
from study_statistics import inefficiency_ratio, log_log_slope
from study_text import (chart_block, error_point, interval, number, percent, pictures_block, section, seconds, series,
                        surface_error, table_block, text_block, whole_error)

LAST_BOUNCE = 5
COLORS = ["R", "G", "B"]
NO_ROULETTE = ["--roulette", "off"]


def sum_bound(spp):
    """How far the sum of the bounces and the image of all may lie apart by rounding, relative to a pixel that holds no
    negative value: each side adds at most spp samples of two terms a bounce and takes as many means, in single precision
    with a rounding error of 2^-24 each (Higham 2002, 4.2), whatever the order."""
    roundings = 2 * (LAST_BOUNCE + 1) + 3 * spp + LAST_BOUNCE + 1
    return 2 * roundings * 2.0**-24


def sum_check(alone, accumulated):
    """The largest relative difference of a channel of a pixel, and how many lie beyond the bound."""
    parts = [read_channels(run.exr, COLORS)[2] for run in alone]
    whole = read_channels(accumulated.exr, COLORS)[2]
    differences = []
    for color in COLORS:
        sums = (math.fsum(values) for values in zip(*(part[color] for part in parts)))
        differences += [abs(a - b) / max(a, b) for a, b in zip(sums, whole[color]) if max(a, b) > 0]
    bound = sum_bound(accumulated.request.spp)
    return {"largestRelativeDifference": max(differences, default=0.0), "bound": bound,
            "beyond": sum(difference > bound for difference in differences), "values": len(differences)}


def bounce_run(study, scene, options, spp, reference):
    """A render and how far it is from its reference."""
    run = study.runner.render(study.request(scene, options, spp))
    compared, = study.runner.compared([run], reference)
    return run, compared


def bounce_pictures(study, mode):
    scene, found = study.scenes.bunny, []
    for bounce in range(LAST_BOUNCE + 1):
        options = [*depth(bounce), "--bounces", mode, *NO_ROULETTE]
        reference = study.reference(scene, options) if mode == "last" else study.depth_reference(scene, bounce)
        run, compared = bounce_run(study, scene, options, study.effort.bounce_spp, reference)
        words = f"bounce {bounce} alone" if mode == "last" else f"up to bounce {bounce}"
        found.append((run, study.picture(run, words, compared)))
    return [run for run, _ in found], [item for _, item in found]


def part_pictures(study):
    items = []
    for part in ("all", "direct", "indirect"):
        options = [*depth(FULL_DEPTH), "--light", part]
        reference = study.reference(study.scenes.spheres, options, 2 * study.effort.reference_spp)
        run, compared = bounce_run(study, study.scenes.spheres, options, study.effort.bounce_spp, reference)
        items.append(study.picture(run, {"all": "all light"}.get(part, f"{part} light alone"), compared))
    return items


def mean_of(run):
    return run.report["meanLuminance"][1]


def sum_words(check):
    inside = "no value lies" if check["beyond"] == 0 else f"{check['beyond']} of {check['values']} values lie"
    return (f"The images of single bounces add up to the accumulated one: over {check['values']} values the largest relative "
            f"difference is {number(check['largestRelativeDifference'])}, and {inside} beyond the "
            f"{number(check['bound'])} that rounding may cause.")


def bounces_section(study):
    scene = study.scenes.bunny
    accumulated_runs, accumulated = bounce_pictures(study, "accumulate")
    alone_runs, alone = bounce_pictures(study, "last")
    check = sum_check(alone_runs, accumulated_runs[-1])
    total = mean_of(accumulated_runs[-1])
    rows = [[bounce, number(mean_of(run)), percent(mean_of(run) / total), percent(mean_of(whole) / total)]
            for bounce, (run, whole) in enumerate(zip(alone_runs, accumulated_runs))]
    table = table_block(f"{scene.stem}: mean luminance of each bounce, and its share of bounces 0 to {LAST_BOUNCE}",
                        ["bounce", "mean luminance", "share", "share so far"], rows,
                        [f"isolux render {scene.name} -o image.exr --max-depth B --bounces last|accumulate --roulette off"])
    blocks = [pictures_block(f"{scene.stem}, bounces accumulated", accumulated),
              pictures_block(f"{scene.stem}, each bounce alone", alone), text_block(sum_words(check)), table,
              pictures_block(f"{study.scenes.spheres.stem}: direct and indirect light", part_pictures(study))]
    figures = {"sum": check, "shares": [mean_of(run) / total for run in alone_runs]}
    headline = ("Bounces 0 to 5 alone against accumulated, largest relative difference of a pixel",
                f"{number(check['largestRelativeDifference'])} (rounding may cause {number(check['bound'])})")
    return section("bounces", "Global illumination, bounce by bounce", blocks, figures, [headline])


# The report's: a path ends with probability 0.3, but at the first bounce never.
TERMINATION = 0.3
ROULETTES = {
    "off": NO_ROULETTE,
    "constant": ["--roulette", f"constant:{TERMINATION}", "--roulette-start", "2"],
    "throughput": ["--roulette", "throughput"],
}


def roulette_measured(study, bounces):
    scene = study.scenes.bunny
    groups = {name: study.seeds(scene, [*depth(bounces), *options], study.effort.roulette_spp)
              for name, options in ROULETTES.items()}
    return study.runner.interleaved(groups, study.depth_reference(scene, bounces))


def against_off(measured, name):
    """Efficiency, 1/(MSE T), relative to no roulette."""
    off, one = measured["off"], measured[name]
    return inefficiency_ratio(off.mses, off.seconds, one.mses, one.seconds)


def rays_per_sample(measured):
    report = measured.runs[0].report
    return report["rays"] / report["samples"]


def roulette_rows(found):
    for bounces, measured in found.items():
        for name, one in measured.items():
            efficiency = "1" if name == "off" and sum(one.mses) else interval(against_off(measured, name))
            yield [bounces, name, number(rays_per_sample(one)), seconds(one.median_seconds),
                   whole_error(one), surface_error(one), efficiency]


def variance_words(scene):
    """When constant roulette has infinite variance: each bounce multiplies the second moment by a^2/(1 - P)."""
    albedo, survival = largest_albedo(scene), 1 - TERMINATION
    factor = albedo**2 / survival
    state = ("below 1, so the variance is finite" if factor < 1 else
             "not below 1, so among surfaces of that albedo alone the variance is infinite")
    return (f"A path that goes on with probability 1 − P carries 1/(1 − P) more, so a bounce off albedo a multiplies the mean "
            f"of the squared weight by a²/(1 − P). Where light stays among surfaces with a² > 1 − P (a > {number(survival**0.5)} "
            f"for P = {TERMINATION}) that mean grows without bound with the depth: constant termination has infinite variance "
            f"there, however many samples are taken, while termination by throughput never lets a weight grow. The largest "
            f"albedo of {scene.stem} is {number(albedo)}: a²/(1 − P) = {number(factor)}, {state}.")


def roulette_words(found):
    deepest = max(found)
    measured = found[deepest]
    parts = []
    for name in ("constant", "throughput"):
        low, ratio, high = against_off(measured, name)
        sure = low is not None and (low > 1 or high < 1)
        parts.append(f"roulette by {name if name == 'throughput' else 'a constant'} takes "
                     f"{percent(measured[name].median_seconds / measured['off'].median_seconds)} of the time and has "
                     f"{percent(measured[name].surface_rmse[1] / measured['off'].surface_rmse[1])} of the error on "
                     f"surfaces of none: "
                     f"{number(ratio)} times the efficiency{'' if sure else ', which the interval does not tell from none'}")
    return f"At a depth of {deepest}, " + "; ".join(parts) + "."


def roulette_pictures(found):
    yield from ((f"constant, depth {bounces}", measured["constant"]) for bounces, measured in found.items())
    deepest = max(found)
    yield from ((f"{name}, depth {deepest}", found[deepest][name]) for name in ("off", "throughput"))


FURNACE_SIZE = (32, 32)
FURNACE_ROULETTES = {
    "off": NO_ROULETTE,
    "constant 0.3": ["--roulette", "constant:0.3", "--roulette-start", "2"],
    "constant 0.5": ["--roulette", "constant:0.5", "--roulette-start", "2"],
    "throughput": ["--roulette", "throughput", "--roulette-start", "2"],
}


def furnace_scatter(study, bounces, options):
    """The standard deviation of one sample over the mean, in blue."""
    run = study.runner.render(study.request(FURNACE, [*depth(bounces), *options], study.effort.furnace_spp, size=FURNACE_SIZE))
    values = read_channels(run.exr, ["B", "variance.B"])[2]
    return math.sqrt(math.fsum(values["variance.B"]) * len(values["B"])) / math.fsum(values["B"])


def furnace_blocks(study):
    """Where constant roulette has infinite variance: its scatter grows with every bounce that is allowed."""
    scatter = {name: [furnace_scatter(study, bounces, options) for bounces in study.effort.furnace_depths]
               for name, options in FURNACE_ROULETTES.items()}
    rows = [[name, *(number(value) for value in values)] for name, values in scatter.items()]
    factors = ", ".join(f"P = {p}: {number(FURNACE_ALBEDO**2 / (1 - p))}" for p in (0.3, 0.5))
    commands = [f"isolux render {FURNACE.name} -o image.exr --size 32x32 --spp {study.effort.furnace_spp} --max-depth D "
                + " ".join(options) for options in FURNACE_ROULETTES.values()]
    caption = (f"A closed furnace of albedo {FURNACE_ALBEDO}: the scatter of one sample relative to the mean, by maximum depth. "
               f"a²/(1 − P) is, for {factors}. Above 1 every bounce adds more than the one before; with no limit of depth "
               "the variance is infinite, and what so many samples show of it is an underestimate.")
    head = ["roulette", *(f"depth {bounces}" for bounces in study.effort.furnace_depths)]
    return [table_block(caption, head, rows, commands)], scatter


def roulette_section(study):
    scene, spp = study.scenes.bunny, study.effort.roulette_spp
    found = {bounces: roulette_measured(study, bounces) for bounces in study.effort.roulette_depths}
    command = f"isolux render {scene.name} -o image.exr --spp {spp} --seed 0...{study.effort.seeds - 1} --max-depth D "
    commands = [command + " ".join(options) for options in ROULETTES.values()]
    head = ["maximum depth", "roulette", "rays a sample", "time", "error, whole image", "error on surfaces",
            "efficiency against off"]
    table = table_block(f"{scene.stem}, {spp} samples a pixel. Relative RMSE over {study.effort.seeds} seeds [95 %, t]; "
                        "efficiency 1/(mean squared error on surfaces × time) with a bootstrap interval over the seeds; times are "
                        "medians of runs in turn, and what else the machine did in them is not in the interval.",
                        head, list(roulette_rows(found)), commands)
    lines = [series(f"roulette {name}", [[bounces + 1, measured[name].median_seconds] for bounces, measured in found.items()])
             for name in ROULETTES]
    chart = chart_block("Time against the most path segments (maximum depth + 1): without roulette it goes on growing until "
                        "paths leave the scene by themselves.", "path segments at most", "seconds", lines, commands)
    furnace, scatter = furnace_blocks(study)
    blocks = [pictures_block(f"{scene.stem}, {spp} samples a pixel", study.pictures(dict(roulette_pictures(found)))), table,
              text_block(roulette_words(found)), text_block(variance_words(scene)), *furnace, chart]
    figures = [{"bounces": bounces, "methods": {name: {
        "seconds": one.median_seconds, "surfaceRmse": one.surface_rmse, "raysPerSample": rays_per_sample(one),
        "efficiencyAgainstOff": against_off(measured, name)} for name, one in measured.items()}}
               for bounces, measured in found.items()]
    deepest = found[max(found)]
    headline = (f"Efficiency at depth {max(found)} against no roulette",
                ", ".join(f"{name} {interval(against_off(deepest, name))}" for name in ("constant", "throughput")))
    return section("roulette", "Russian roulette", blocks, {"depths": figures, "furnaceScatter": scatter}, [headline])


def ladder_seeds(study, spp):
    return max(2, min(study.effort.seeds, study.effort.ladder_samples // spp))


def ladder_measured(study):
    scene, options = study.scenes.bunny, depth(FULL_DEPTH)
    reference = study.depth_reference(scene, FULL_DEPTH)
    return {spp: study.runner.measured(study.seeds(scene, options, spp, ladder_seeds(study, spp)), reference)
            for spp in study.effort.ladder}


def slope_words(where, slope):
    low, estimate, high = slope
    agrees = "holds" if low <= -0.5 <= high else "does not hold"
    return (f"Over {where} the slope of log error against log samples is {number(estimate)} [{number(low)}, {number(high)}] "
            f"(least squares, bootstrap over the seeds); the interval {agrees} the {number(-0.5)} of independent samples.")


def ladder_rows(found):
    for spp, one in found.items():
        yield [spp, len(one.runs), seconds(one.median_seconds), whole_error(one), surface_error(one),
               percent(one.reference_share)]


def ladder_series(name, found, errors_of):
    """What was measured with the line fitted to it, and the slope."""
    errors = {spp: errors_of(one) for spp, one in found.items()}
    slope, line = log_log_slope(list(found), [[error.mse for error in column] for column in errors.values()])
    mean = errors[min(found)][0].reference_mean
    points = [error_point(spp, root_mean_square(column)) for spp, column in errors.items()]
    fitted = {**series(f"{name}: slope {number(slope[1])}", [[spp, value / mean] for spp, value in zip(found, line)]),
              "marks": False}
    return slope, [series(name, points, line=False), fitted]


def samples_section(study):
    scene = study.scenes.bunny
    found = ladder_measured(study)
    slope, whole = ladder_series("whole image", found, lambda one: one.errors)
    surface_slope, surfaces = ladder_series("surfaces", found, lambda one: one.surface_errors)
    head = ["spp", "seeds", "time", "error, whole image", "error on surfaces", "share of the reference's noise"]
    command = f"isolux render {scene.name} -o image.exr --spp {'|'.join(map(str, found))} --max-depth {FULL_DEPTH} --seed K"
    blocks = [pictures_block(f"{scene.stem}, all bounces",
                             study.pictures({f"{spp} sample{'s' if spp > 1 else ''}": one for spp, one in found.items()})),
              chart_block("Error against samples a pixel, both axes logarithmic", "samples a pixel", "relative RMSE",
                          [*whole, *surfaces], [command]),
              table_block("Relative RMSE over the seeds [95 %, t]. The variance of the reference is subtracted; its share of "
                          "the squared error of the whole image is in the last column.", head, list(ladder_rows(found)),
                          [command]),
              text_block(slope_words("the whole image", slope) + " " + slope_words("surfaces", surface_slope))]
    figures = {"slope": slope, "surfaceSlope": surface_slope,
               "relativeRmse": {spp: one.relative_rmse for spp, one in found.items()}}
    headline = ("Slope of log error against log samples", f"{interval(slope)} over the whole image, {interval(surface_slope)} on surfaces")
    return section("samples", "Samples a pixel", blocks, figures, [headline])

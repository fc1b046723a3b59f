"""How direct light is found: hemisphere, light and multiple importance sampling; the number of shadow rays."""

from study_plan import depth, depth_name
from study_statistics import inefficiency_ratio
from study_text import (chart_block, error_point, interval, number, percent, pictures_block, section, seconds, series,
                        surface_error, table_block, text_block, whole_error)

METHODS = {"hemisphere": "uniform hemisphere", "light": "light sampling", "mis": "MIS"}
BEST = "mis"


def options_of(method, bounces):
    return ["--light-sampling", method, *depth(bounces)]


def same_error_time(measured, name, best=BEST):
    """How many times longer than the best a method takes for the same error."""
    one, other = measured[name], measured[best]
    return inefficiency_ratio(one.mses, one.seconds, other.mses, other.seconds)


def equal_samples(study, scene, bounces, reference):
    groups = {method: study.seeds(scene, options_of(method, bounces), study.effort.light_spp) for method in METHODS}
    return study.runner.interleaved(groups, reference)


def equal_time(study, scene, bounces, reference, measured):
    """Each method with as many samples as fit the time of MIS, so far as whole samples allow."""
    available = measured[BEST].median_seconds
    groups = {}
    for method in METHODS:
        spp = max(1, round(available / measured[method].seconds_per_spp))
        groups[method] = study.seeds(scene, options_of(method, bounces), spp)
    return study.runner.interleaved(groups, reference)


def method_rows(scene, bounces, by_samples, by_time):
    for method, name in METHODS.items():
        samples, timed = by_samples[method], by_time[method]
        ratio = "1" if method == BEST else interval(same_error_time(by_samples, method))
        yield [f"{scene.stem}, {depth_name(bounces)}", name, number(samples.runs[0].spp), seconds(samples.median_seconds),
               whole_error(samples), surface_error(samples), ratio, number(timed.runs[0].spp),
               seconds(timed.median_seconds), surface_error(timed)]


HEAD = ["scene", "method", "spp", "time", "error, whole image", "error on surfaces", "time for the error of MIS",
        "spp at equal time", "time", "error on surfaces at equal time"]


def method_figures(by_samples, by_time):
    return {method: {"relativeRmse": by_samples[method].relative_rmse, "surfaceRmse": by_samples[method].surface_rmse,
                     "seconds": by_samples[method].median_seconds,
                     "timeForErrorOfMis": same_error_time(by_samples, method),
                     "surfaceRmseAtEqualTime": by_time[method].surface_rmse,
                     "secondsAtEqualTime": by_time[method].median_seconds} for method in METHODS}


def named(measured):
    return {METHODS[method]: one for method, one in measured.items()}


def verdict(scene, bounces, figures):
    parts = [f"{METHODS[method]} takes {number(figures[method]['timeForErrorOfMis'][1])} times as long"
             for method in METHODS if method != BEST]
    return f"{scene.stem}, {depth_name(bounces)}: for the error of MIS {', '.join(parts)}."


def light_section(study):
    blocks, rows, figures, verdicts = [], [], [], []
    for scene in (study.scenes.bunny, study.scenes.spheres):
        for bounces in study.effort.light_depths:
            reference = study.depth_reference(scene, bounces)
            by_samples = equal_samples(study, scene, bounces, reference)
            by_time = equal_time(study, scene, bounces, reference, by_samples)
            found = method_figures(by_samples, by_time)
            title = f"{scene.stem}, {depth_name(bounces)}"
            blocks += [pictures_block(f"{title}, equal samples a pixel", study.pictures(named(by_samples))),
                       pictures_block(f"{title}, equal time", study.pictures(named(by_time)))]
            rows += method_rows(scene, bounces, by_samples, by_time)
            verdicts.append(verdict(scene, bounces, found))
            figures.append({"scene": scene.stem, "bounces": bounces, "methods": found})
    command = f"isolux render SCENE -o image.exr --spp N --seed 0...{study.effort.seeds - 1} --max-depth D --light-sampling "
    table = table_block(f"Relative RMSE over {study.effort.seeds} seeds [95 %, t]. How many times longer a method takes for "
                        "the error of MIS: the ratio of mean squared error × time, with a bootstrap interval over the seeds. "
                        "A scene with one area light is light sampling's own ground; MIS is for the others as well.",
                        HEAD, rows, [command + "|".join(METHODS)])
    first = figures[0]
    headline = (f"Hemisphere sampling against MIS, {first['scene']}, {depth_name(first['bounces'])}",
                f"{interval(first['methods']['hemisphere']['timeForErrorOfMis'])} times longer for the same error")
    return section("light", "Hemisphere, light and multiple importance sampling",
                   [table, text_block(" ".join(verdicts)), *blocks], {"scenes": figures}, [headline])


def soft_options(count):
    return ["--light-sampling", "light", "--light-samples", str(count), *depth(1)]


def rays_a_sample(measured):
    report = measured.runs[0].report
    return report["rays"] / report["samples"]


def samples_name(count):
    return f"{count} light sample{'s' if count > 1 else ''}"


def soft_rows(at_one, at_rays):
    for count, one in at_one.items():
        equal = at_rays[count]
        yield [count, number(rays_a_sample(one)), seconds(one.median_seconds), whole_error(one), surface_error(one),
               number(equal.runs[0].spp), number(equal.runs[0].report["rays"] / 1e6), seconds(equal.median_seconds),
               whole_error(equal), surface_error(equal)]


def soft_verdict(at_one, at_rays):
    fewest, most = min(at_one), max(at_one)
    errors = {count: at_rays[count].surface_rmse[1] for count in at_rays}
    best = min(errors, key=errors.get)
    return (f"At 1 sample a pixel {most} light samples instead of {fewest} bring the error on surfaces "
            f"from {percent(at_one[fewest].surface_rmse[1])} to {percent(at_one[most].surface_rmse[1])}; what is left are the "
            f"edges of shapes, one camera ray a pixel, which no shadow ray smooths. Over the whole image the edge of the light "
            f"itself hides this. With the same rays in all, "
            f"{samples_name(best)} a shading point {'are' if best > 1 else 'is'} best "
            f"({percent(errors[best])}).")


def soft_section(study):
    scene, counts = study.scenes.bunny, study.effort.light_samples
    reference = study.depth_reference(scene, 1)
    at_one = study.runner.interleaved({n: study.seeds(scene, soft_options(n), 1) for n in counts}, reference)
    most_rays = rays_a_sample(at_one[max(counts)])
    equal = {n: study.seeds(scene, soft_options(n), max(1, round(most_rays / rays_a_sample(at_one[n])))) for n in counts}
    at_rays = study.runner.interleaved(equal, reference)
    errors = ["error, whole image", "error on surfaces"]
    head = ["light samples", "rays a sample", "time at 1 spp", *errors, "spp at equal rays", "million rays", "time", *errors]
    command = (f"isolux render {scene.name} -o image.exr --spp N --seed 0...{study.effort.seeds - 1} --max-depth 1 "
               f"--light-sampling light --light-samples {'|'.join(map(str, counts))}")
    lines = [series(words, [error_point(n, one.surface_rmse) for n, one in found.items()])
             for words, found in (("1 sample a pixel", at_one), ("equal rays", at_rays))]
    blocks = [pictures_block(f"{scene.stem}, direct light, 1 sample a pixel",
                             study.pictures({samples_name(n): one for n, one in at_one.items()})),
              pictures_block(f"{scene.stem}, direct light, as many rays in all",
                             study.pictures({samples_name(n): one for n, one in at_rays.items()})),
              chart_block("Error on surfaces against light samples a shading point", "light samples", "relative RMSE",
                          lines, [command]),
              table_block(f"Relative RMSE over {study.effort.seeds} seeds [95 %, t].", head, list(soft_rows(at_one, at_rays)),
                          [command]),
              text_block(soft_verdict(at_one, at_rays))]
    figures = {"atOneSample": {n: one.surface_rmse for n, one in at_one.items()},
               "atEqualRays": {n: one.surface_rmse for n, one in at_rays.items()}}
    headline = (f"{max(counts)} light samples instead of {min(counts)}, at 1 spp",
                f"error on surfaces {percent(at_one[min(counts)].surface_rmse[1])} → "
                f"{percent(at_one[max(counts)].surface_rmse[1])}")
    return section("soft", "Soft shadows: the number of light samples", blocks, figures, [headline])

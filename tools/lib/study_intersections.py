"""The study's first part: images of normals, and what it costs to find what rays meet, without and with a BVH."""

import dataclasses
import statistics

from study_plan import triangle_count
from study_text import chart_block, interval, number, pictures_block, section, seconds, series, table_block, text_block, times

NORMALS = ["--integrator", "normals"]
METHODS = ["none", "mean-split", "sah"]
LEGEND = {"none": "no BVH", "mean-split": "split at the mean", "sah": "surface area heuristic"}

# The report's times without and with its BVH, in seconds.
REPORTED = {"cow": (5, 0.04), "banana": (2, 0.02), "maxplanck": (55, 0.11), "blob": (300, 0.22)}

# What the times are stated for: one ray through each pixel of an image of 800 x 600.
STATED_RAYS = 800 * 600
MOST_TIMED_SPP = 4096


def normals_pictures(study):
    items = []
    for scene in study.scenes.normals:
        run = study.runner.render(study.request(scene, NORMALS, study.effort.normals_spp))
        compared, = study.runner.compared([run], study.reference(scene, NORMALS, 16 * study.effort.normals_spp))
        items.append(study.picture(run, scene.stem, dataclasses.replace(compared, surfaces=None)))
    return pictures_block("Shading normals as colours, (n + 1)/2", items)


def timed_spp(study, scene, options):
    """So many samples that the time can be measured, told by one render."""
    pilot = study.runner.render(study.request(scene, options, 1, size=study.effort.timing_size, seed=99))
    return max(1, min(round(study.effort.timing_seconds / max(pilot.seconds, 1e-6)), MOST_TIMED_SPP))


def time_scene(study, scene):
    """Seconds for the stated rays by method: low, median, high of interleaved runs."""
    options = {method: [*NORMALS, "--accel", method] for method in METHODS}
    spp = {method: timed_spp(study, scene, options[method]) for method in METHODS}
    found = {method: [] for method in METHODS}
    for seed in range(study.effort.timing_repeats):
        for method in METHODS:
            request = study.request(scene, options[method], spp[method], size=study.effort.timing_size, seed=seed)
            run = study.runner.render(request)
            found[method].append(run.seconds / run.report["samples"] * STATED_RAYS)
    return {method: [min(values), statistics.median(values), max(values)] for method, values in found.items()}


def tests_of(study, scene, method):
    """Box and triangle tests a ray."""
    options = [*NORMALS, "--accel", method, "--count-tests"]
    tests = study.runner.render(study.request(scene, options, 1, size=study.effort.timing_size)).report["tests"]
    return [tests["boxesPerRay"], tests["primitivesPerRay"]]


def measure(study, scene):
    return {"scene": scene.stem, "triangles": triangle_count(scene), "standIn": study.scenes.stand_in(scene),
            "seconds": time_scene(study, scene), "tests": {method: tests_of(study, scene, method) for method in METHODS}}


def speed_up(entry, method="sah"):
    return entry["seconds"]["none"][1] / entry["seconds"][method][1]


def reported(entry):
    """The report's times of the scene, or of what it stands in for; None if it states none."""
    return next((pair for scene, pair in REPORTED.items() if entry["scene"].startswith(scene)), None)


def reported_text(entry):
    found = reported(entry)
    return f"{found[0]} s → {found[1]} s, {times(found[0] / found[1])}" if found else "–"


def headline(entries):
    """Beside the report's figures where it has some, else of the largest scene."""
    parts = [f"{entry['scene']} {times(speed_up(entry))} ({times(reported(entry)[0] / reported(entry)[1])})"
             for entry in entries if reported(entry)]
    if parts:
        return "A BVH against none, and the report's", ", ".join(parts)
    return f"A BVH against none, {entries[-1]['scene']}, {entries[-1]['triangles']} triangles", times(speed_up(entries[-1]))


def times_table(entries):
    rows = [[entry["scene"] + (" *" if entry["standIn"] else ""), f"{entry['triangles']:,}",
             *(interval(entry["seconds"][method]) for method in METHODS), times(speed_up(entry, "mean-split")),
             times(speed_up(entry)), reported_text(entry)] for entry in entries]
    head = ["scene", "triangles", *(f"{LEGEND[method]}, s" for method in METHODS), "speed-up, mean split",
            "speed-up, SAH", "the report"]
    return table_block(f"Seconds for {STATED_RAYS:,} camera rays (800 × 600, one a pixel): the median [lowest, highest] of "
                       "interleaved runs, scaled from the rays that were timed; rendering alone, without start-up. "
                       "The report states no number of rays, so its speed-ups compare, its seconds do not. "
                       "* stand-in for the report's scene.", head, rows)


def tests_table(entries):
    rows = [[entry["scene"], f"{entry['triangles']:,}",
             *(" + ".join(map(number, entry["tests"][method])) for method in METHODS)] for entry in entries]
    return table_block("Ray-box + ray-triangle tests a ray. Unlike times they are the same on every machine.",
                       ["scene", "triangles", *(LEGEND[method] for method in METHODS)], rows)


def times_chart(entries, commands):
    lines = [series(LEGEND[method], [[entry["triangles"], entry["seconds"][method][1], entry["seconds"][method][0],
                                      entry["seconds"][method][2]] for entry in entries]) for method in METHODS]
    return chart_block(f"Time for {STATED_RAYS:,} camera rays against triangles, both axes logarithmic. Without a BVH it "
                       "grows with the triangles; with one, with their logarithm and what the cache holds.",
                       "triangles", "seconds", lines, commands)


def commands(study):
    width, height = study.effort.timing_size
    call = f"isolux render SCENE -o image.exr --size {width}x{height} --spp N --seed 0...{study.effort.timing_repeats - 1}"
    return [f"{call} --integrator normals --accel {'|'.join(METHODS)}", "the same with --spp 1 --count-tests"]


def normals_section(study):
    entries = sorted((measure(study, scene) for scene in study.scenes.timed), key=lambda entry: entry["triangles"])
    shown = commands(study)
    blocks = [normals_pictures(study), times_chart(entries, shown), times_table(entries), tests_table(entries)]
    blocks[2]["commands"], blocks[3]["commands"] = shown[:1], shown[1:]
    largest = entries[-1]
    without, with_bvh = largest["seconds"]["none"][1], largest["seconds"]["sah"][1]
    blocks.append(text_block(
        f"{largest['scene']}, {largest['triangles']:,} triangles: {seconds(without)} without a BVH, {seconds(with_bvh)} with "
        f"one by the surface area heuristic, {times(speed_up(largest))}, and {times(speed_up(largest, 'mean-split'))} with one "
        "split at the mean of the centroids, as the report's is. The report's speed-ups: "
        + ", ".join(f"{name} {times(a / b)}" for name, (a, b) in REPORTED.items()) + "."))
    return section("normals", "Rays, intersections and the BVH", blocks, {"scenes": entries}, [headline(entries)])

"""Synthetic runs in the form of `isolux converge`: errors that fall as Monte Carlo's do, with the noise of so many seeds.

    synthetic.py FOLDER    writes there the runs that the page test uses
"""

import json
import math
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "lib"))
sys.dont_write_bytecode = True
from scene_images import RGB, grain, png

SEEDS = 16
SIZE = 48
ERRORS = [0.05, 0.01]
REFERENCE_ERROR = 0.004

# Name, options, relative RMSE of one sample, seconds a sample, exponent of MSE over samples, floor of relative RMSE.
PLAIN = [("hemisphere", "--light-sampling none", 1.9, 0.006, 1.0, 0.0),
         ("light", "--light-sampling light", 0.62, 0.011, 1.0, 0.0), ("mis", "--light-sampling mis", 0.5, 0.013, 1.0, 0.0),
         ("mis-sobol", "--light-sampling mis --pixel-sampler sobol", 0.5, 0.0135, 1.25, 0.0),
         ("adaptive", "--light-sampling mis --adaptive 0.02", 0.42, 0.014, 1.0, 0.0)]
BIASED = ("clamped", "--light-sampling mis --clamp 4", 0.3, 0.013, 1.0, 0.03)


def around(generator, value, relative):
    """[low, estimate, high] of a mean over seeds whose standard error is a share of it."""
    estimate = value * (1 + relative * generator.gauss(0, 1))
    half = 2.131 * relative * abs(value)  # t of 15 degrees of freedom
    return [estimate - half, estimate, estimate + half]


def wilson(inside, total):
    """Wilson (1927): the interval of a share."""
    z, share = 1.96, inside / total
    middle, scale = share + z * z / (2 * total), 1 + z * z / total
    half = z * math.sqrt(share * (1 - share) / total + z * z / (4 * total * total))
    return {"inside": inside, "total": total, "share": [(middle - half) / scale, share, (middle + half) / scale]}


def calibration(generator, floor):
    truth = 0.95 if floor == 0 else 0.6
    inside = sum(generator.random() < truth for _ in range(SEEDS))
    shares = [0.82, 0.91, 0.945, 0.95, 0.951] if floor == 0 else [0.7, 0.8, 0.9, 0.94, 0.92]
    total = SEEDS * SIZE * SIZE // 5
    pixels = [{"below": below} | wilson(round(share * total), total) for below, share in zip((0.1, 0.2, 0.4, 0.8, 4.0), shares)]
    return {"meanLuminance": wilson(inside, SEEDS), "pixels": pixels,
            "estimateOverError": around(generator, 0.97 if floor == 0 else 0.6, 0.02)}


def checkpoint(generator, variant, samples):
    _, _, single, cost, exponent, floor = variant
    mse = single**2 * samples**-exponent + floor**2
    seconds, noise = samples * cost, 0.25 / math.sqrt(SEEDS)
    rmse = around(generator, math.sqrt(mse), noise / 2)
    scale = 0.36  # of the mean, squared
    return {"samplesPerPixel": samples, "raysPerPixel": 5.5 * samples, "wallSeconds": seconds, "deviceSeconds": 0.95 * seconds,
            "mse": around(generator, mse * scale, noise), "relMse": around(generator, 1.3 * mse, noise),
            "relMseTrimmed": around(generator, 0.9 * mse, noise),
            "mae": around(generator, 0.6 * math.sqrt(mse * scale), noise / 2),
            "flip": around(generator, min(0.9, 1.4 * math.sqrt(mse)), noise / 4),
            "bias": [-floor + 0.15 * math.sqrt(mse / SEEDS) * part
                     for part in (generator.uniform(-3, -1), 0.1, generator.uniform(1, 3))],
            "biasSquared": [floor**2 * scale - 1e-5, floor**2 * scale, floor**2 * scale + 1e-5], "relativeRmse": rmse,
            "estimate": around(generator, math.sqrt(mse - floor**2) * 0.97, noise / 2),
            "calibration": calibration(generator, floor)}


def seconds_to(variant, error):
    _, _, single, cost, exponent, floor = variant
    if error <= floor:
        return None
    return cost * (single**2 / (error**2 - floor**2))**(1 / exponent)


def time_to(generator, variant, error, last):
    seconds = seconds_to(variant, error)
    if seconds is None or (seconds > last and variant[5] > 0):
        return {"error": error, "seconds": [None, None, None], "extrapolated": False,
                "reason": "not reached, and the error ends at a floor"}
    return {"error": error, "seconds": around(generator, seconds, 0.03), "extrapolated": seconds > last, "reason": ""}


def summary(generator, variant, longest):
    name, options, _, cost, exponent, floor = variant
    counts = [4 * 2**step for step in range(14) if 4 * 2**step * cost <= longest]
    checkpoints = [checkpoint(generator, variant, samples) for samples in counts]
    last = checkpoints[-1]
    return {"name": name, "options": options, "seeds": SEEDS, "setupSeconds": 0.12 + cost, "checkpoints": checkpoints,
            "slopeTime": around(generator, -exponent if floor == 0 else -0.6, 0.01),
            "slopeSamples": around(generator, -exponent if floor == 0 else -0.6, 0.01),
            "floor": [floor**2 - 2e-5, floor**2, floor**2 + 2e-5], "slopeHolds": floor == 0,
            "efficiency": around(generator, 1 / (last["mse"][1] * last["wallSeconds"]), 0.05),
            "timeTo": [time_to(generator, variant, error, last["wallSeconds"]) for error in ERRORS]}


def ratios(summaries):
    found = []
    for place in range(len(ERRORS)):
        times = [(one["timeTo"][place], one["name"]) for one in summaries if one["timeTo"][place]["seconds"][1]]
        times.sort(key=lambda entry: entry[0]["seconds"][1])
        for first, (fast, faster) in enumerate(times):
            for slow, slower in times[first + 1:]:
                ratio = slow["seconds"][1] / fast["seconds"][1]
                low, high = 0.93 * ratio, 1.07 * ratio
                found.append({"faster": faster, "slower": slower, "error": ERRORS[place], "ratio": [low, ratio, high],
                              "extrapolated": fast["extrapolated"] or slow["extrapolated"],
                              "text": f"{faster} reaches {100 * ERRORS[place]:g} % relative RMSE {ratio:.3g} ({low:.3g}-{high:.3g}) "
                                      f"times sooner than {slower}"})
    return found


def picture(seed, noise):
    """A sphere above a floor, in grain."""
    def texel(x, y):
        u, v = (x + 0.5) / SIZE * 2 - 1, (y + 0.5) / SIZE * 2 - 1
        depth = 0.4 - u * u - v * v
        lit = max(0.0, 0.9 * math.sqrt(depth) - 0.4 * u - 0.4 * v) if depth > 0 else 0.35 + 0.3 * v
        shade = lit * (1 + noise * (grain(x + 97 * seed, y + 31 * seed) - 0.5))
        return tuple(min(255, max(0, int(255 * part * shade))) for part in (1.0, 0.85, 0.7))
    return png(SIZE, SIZE, RGB, texel)


def flip_map(seed, noise):
    def texel(x, y):
        return min(255, int(255 * noise * grain(x + seed, y))), int(40 * noise), int(90 * noise)
    return png(SIZE, SIZE, RGB, texel)


def write_images(folder, summaries, equal):
    (folder / "reference.png").write_bytes(picture(0, 0.0))
    shown = []
    for seed, one in enumerate(summaries, 1):
        nearest = min(one["checkpoints"], key=lambda point: abs(math.log(point["wallSeconds"] / equal)))
        error = nearest["relativeRmse"][1]
        (folder / f"{one['name']}.png").write_bytes(picture(seed, 6 * error))
        (folder / f"{one['name']}-flip.png").write_bytes(flip_map(seed, min(1.0, 6 * error)))
        shown.append({"name": one["name"], "image": f"{one['name']}.png", "flip": f"{one['name']}-flip.png",
                      "samplesPerPixel": nearest["samplesPerPixel"], "seconds": nearest["wallSeconds"], "relativeRmse": error,
                      "flipMean": nearest["flip"][1]})
    return {"reference": "reference.png", "equalTimeSeconds": equal, "variants": shown}


def run(folder, scene, variants, scale=1.0):
    """Writes a run; every error of one sample is multiplied by `scale`."""
    generator = random.Random(scene)
    folder.mkdir(parents=True, exist_ok=True)
    scaled = [(name, options, single * scale, *rest) for name, options, single, *rest in variants]
    summaries = [summary(generator, variant, 12.0) for variant in scaled]
    report = {
        "schema": 1, "kind": "convergence", "scene": f"scenes/{scene}/{scene}.gltf", "sceneHash": "5f1e" * 16, "width": SIZE,
        "height": SIZE, "camera": "default", "maxDepth": 8, "version": "0.1.0", "revision": "81c4575",
        "device": "llvmpipe (LLVM 15.0.6, 256 bits)", "driver": "llvmpipe", "driverVersion": "Mesa 22.3.6", "seeds": list(range(SEEDS)),
        "flip": {"pixelsPerDegree": 67.02},
        "reference": {"files": ["cache/5f1e-a.exr", "cache/5f1e-b.exr"], "samplesPerPixel": 16384, "relativeRmse": REFERENCE_ERROR,
                      "relativeBiasError": 0.0003, "tooNoisy": [], "method": "two independent"},
        "diagnostics": {"nonFiniteSamples": 0, "negativeSamples": 0, "stackOverflows": 0, "invalidIndices": 0},
        "truncated": {"maxDepth": 8, "clampedSamples": 0}, "errors": ERRORS, "variants": summaries, "ratios": ratios(summaries),
        "images": write_images(folder, summaries, 1.3),
        "command": f"isolux converge scenes/{scene}/{scene}.gltf --seeds {SEEDS} --max-time 12 -o {folder.name}"}
    write(folder, report)
    return report


def write(folder, report):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "convergence.json").write_text(json.dumps(report, indent=1))


def fitted(folder):
    """What `--fit` writes: no images, no calibration, nothing known of the machine."""
    report = run(folder, "peers", [("isolux", "", 0.6, 0.01, 1.0, 0.0), ("mitsuba <llvm>", "", 0.6, 0.014, 1.0, 0.0)])
    for name in ("scene", "sceneHash", "width", "height", "camera", "maxDepth", "driver", "driverVersion", "revision", "reference",
                 "diagnostics", "truncated", "images", "flip"):
        report[name] = None
    report["device"] = ""
    for variant in report["variants"]:
        for point in variant["checkpoints"]:
            point.update(deviceSeconds=None, estimate=[None, None, None], calibration=None, flip=None, biasSquared=None)
    for path in folder.glob("*.png"):
        path.unlink()
    write(folder, report)
    return report


def faulty(folder):
    """Everything that a page must warn of."""
    report = run(folder, "spheres", PLAIN[1:3] + [BIASED], 0.7)
    report["reference"]["tooNoisy"] = ["mis@9"]
    report["diagnostics"]["nonFiniteSamples"] = 12
    report["truncated"]["clampedSamples"] = 345
    report["variants"][0]["checkpoints"][-1]["relativeRmse"] = [-0.002, -0.001, 0.0]  # below what its reference can show
    (folder / "mis-flip.png").unlink()
    write(folder, report)
    return report


def write_all(folder):
    return {"cornell": run(folder / "cornell", "cornell_box", PLAIN), "blob": run(folder / "blob", "blob", PLAIN[1:4], 1.6),
            "faulty": faulty(folder / "faulty"), "fitted": fitted(folder / "fitted")}


if __name__ == "__main__":
    write_all(pathlib.Path(sys.argv[1]))

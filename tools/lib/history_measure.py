"""A run of tools/bench/history: Embree and Isolux in turns on the same machine, and the ratios of each round."""

import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import tempfile

from history_file import SCHEMA
from study_statistics import bootstrap

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BLOB = ROOT / "build" / "scenes" / "blob.glb"
SPHERES = ROOT / "scenes" / "cornell_spheres" / "cornell_spheres.gltf"
BOX = ROOT / "scenes" / "cornell_box" / "cornell_box.gltf"
ERROR = 0.05  # relative RMSE whose time is asked for
RAYS_OF_ERROR = 1e9  # `error` is in images a billion rays of Embree, so that it is a number to read
FULL = {"rounds": 7, "seconds": 0.2, "raysSamples": 32, "pathSamples": 64, "errorSamples": 128}
QUICK = {"rounds": 2, "seconds": 0.02, "raysSamples": 4, "pathSamples": 8, "errorSamples": 32}
REFERENCE_SAMPLES = 2048


class Failed(Exception):
    """A program did not do what was asked; the message is one line."""


def call(command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if result.returncode != 0:
        lines = (result.stderr.strip() or result.stdout.strip() or "no output").splitlines()
        raise Failed(f"exit status {result.returncode} from '{' '.join(map(str, command))}': {lines[-1]}")
    return result.stdout


class Programs:
    """What is timed. Each returns the figures of one turn."""

    def __init__(self, program, effort, folder):
        self.program = program
        self.embree = program.parent / "bench" / "embree_rays"
        self.effort = effort
        self.folder = folder
        self.cache = ROOT / "build" / "bench" / "cache"

    def measure_embree(self, scene):
        return json.loads(call([self.embree, scene, "--seconds", self.effort["seconds"]]))

    def render(self, scene, *options):
        report = self.folder / "report.json"
        call([self.program, "render", scene, "-q", "-o", self.folder / "image.exr", "--json", report, "--cache-dir",
              self.cache, *options])
        return json.loads(report.read_text())

    def converge(self, scene):
        call([self.program, "converge", scene, "-q", "--size", "64x64", "--seeds", "4", "--max-spp",
              self.effort["errorSamples"], "--reference-spp", REFERENCE_SAMPLES, "--flip-seeds", "0", "--no-images",
              "--cache-dir", self.cache, "-o", self.folder / "converge"])
        return json.loads((self.folder / "converge" / "convergence.json").read_text())

    def turns(self):
        """What a round does, by name."""
        effort = self.effort
        return {
            "embreeBlob": lambda: self.measure_embree(BLOB),
            "rays": lambda: self.render(BLOB, "--integrator", "normals", "--size", "256x256", "--spp", effort["raysSamples"]),
            "embreeSpheres": lambda: self.measure_embree(SPHERES),
            "path": lambda: self.render(SPHERES, "--size", "128x128", "--spp", effort["pathSamples"]),
            "embreeBox": lambda: self.measure_embree(BOX),
            "error": lambda: self.converge(BOX),
        }


def device_rate(report, counted):
    """Of rays or samples, a second on the device itself where it measures."""
    seconds = report["seconds"]["device"] or report["seconds"]["render"]
    return report[counted] / seconds


def seconds_to_error(report):
    """From the last checkpoint along the law of independent samples, MSE ~ 1/n, which the default render follows. Seeds are
    the same in every run: on the same machine its error changes with the renderer alone."""
    point = report["variants"][0]["checkpoints"][-1]
    found = point["relativeRmse"]
    if not found or found[1] is None or found[1] <= 0:
        raise Failed("converge measured no error above zero")
    return point["wallSeconds"] * (found[1] / ERROR)**2


def embree_rate(report, rays):
    return report[rays]["raysPerSecond"]["embree-robust"]["all"]


def raw_figures(turn):
    """Of one round, by name; what the ratios are made of, and what explains a change in them."""
    blob, spheres, box = turn["embreeBlob"], turn["embreeSpheres"], turn["embreeBox"]
    builds = blob["buildSeconds"]
    own = {f"reference{kind.capitalize()}RaysPerSecond": blob[kind]["raysPerSecond"]["isolux-reference"]["all"]
           for kind in ("primary", "bounce")}
    return {
        "raysPerSecond": device_rate(turn["rays"], "rays"),
        "embreePrimaryRaysPerSecond": embree_rate(blob, "primary"),
        "buildSeconds": builds["isolux-binary"]["all"] + builds["isolux-wide"]["all"],
        "embreeBuildSeconds": builds["embree-robust"]["all"],
        "samplesPerSecond": device_rate(turn["path"], "samples"),
        "embreeSpheresBounceRaysPerSecond": embree_rate(spheres, "bounce"),
        "secondsToError": seconds_to_error(turn["error"]),
        "embreeBoxBounceRaysPerSecond": embree_rate(box, "bounce"),
        **own,
        "sahCost": blob["bvh"]["sahCost"],
        "boxesPerRay": blob["bounce"]["tests"]["boxesPerRay"],
        "primitivesPerRay": blob["bounce"]["tests"]["primitivesPerRay"],
    }


def ratios_of(raw):
    """Of one round; more is better in all of them."""
    return {
        "rays": raw["raysPerSecond"] / raw["embreePrimaryRaysPerSecond"],
        "build": raw["embreeBuildSeconds"] / raw["buildSeconds"],
        "path": raw["samplesPerSecond"] / raw["embreeSpheresBounceRaysPerSecond"],
        "error": RAYS_OF_ERROR / (raw["secondsToError"] * raw["embreeBoxBounceRaysPerSecond"]),
    }


def summary(rounds):
    """Ratios with intervals, and raw medians, of the raw figures of the rounds."""
    ratios = [ratios_of(raw) for raw in rounds]
    found = {}
    for name in ratios[0]:
        values = [one[name] for one in ratios]
        found[name] = {"interval": bootstrap(lambda samples: statistics.median(samples[0]), [values]), "rounds": values}
    return {"rounds": len(rounds), "ratios": found,
            "raw": {name: statistics.median(raw[name] for raw in rounds) for name in rounds[0]}}


def cpu_model():
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine() or "unknown"


def git(*words):
    result = subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True)
    return result.stdout.strip() if result.returncode == 0 else None


def identity(program):
    """When, and which Isolux: asked before the run, during which the sources may change."""
    return {
        "schema": SCHEMA,
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "revision": git("rev-parse", "--short=9", "HEAD") or "unknown",
        "dirty": bool(git("status", "--porcelain", "--untracked-files=no")),
        "version": call([program, "--version"]).split()[-1],
    }


def circumstances(turn):
    """On what, as a round tells."""
    device = turn["rays"]["device"]
    return {
        "machine": {"cpu": cpu_model(), "cores": len(os.sched_getaffinity(0))},
        "device": device["name"],
        "driver": f"{device['driver']} {device['driverVersion']}",
        "embree": turn["embreeBlob"]["embree"],
        "scenes": {name: turn[name]["sceneHash"] for name in ("rays", "path", "error")},
    }


def measure(program, effort, tell):
    """A run. The first round compiles kernels and makes the references, and is not counted; each begins at another turn."""
    began = identity(program)
    with tempfile.TemporaryDirectory() as folder:
        turns = Programs(program, effort, pathlib.Path(folder)).turns()
        names = list(turns)
        for name in ("rays", "path", "error"):
            turns[name]()
        rounds = []
        for number in range(effort["rounds"]):
            start = number % len(names)
            found = {name: turns[name]() for name in names[start:] + names[:start]}
            rounds.append(raw_figures(found))
            tell(f"round {number + 1} of {effort['rounds']}")
        return {**began, **circumstances(found), **summary(rounds)}

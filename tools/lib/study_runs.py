"""Runs the program for the study. What was rendered or compared once is kept in the output folder, so that a study that
was interrupted goes on where it stopped."""

import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import shutil
import statistics
import subprocess

from gltf_facts import facts
from study_statistics import mean_interval, signed_root

# The reference's own variance should be less than this share of an error measured against it.
REFERENCE_SHARE = 0.01


class Failed(Exception):
    """The program did not do what was asked; the message is one line."""


@dataclasses.dataclass(frozen=True)
class Request:
    """One call of `isolux render`, but for where its files go."""
    scene: pathlib.Path
    options: tuple
    spp: int
    size: tuple
    seed: int = 0
    sample_map: bool = False

    def arguments(self):
        width, height = self.size
        return ["--size", f"{width}x{height}", "--spp", str(self.spp), "--seed", str(self.seed), *self.options]

    def command(self):
        extra = ["--sample-map", "samples.png"] if self.sample_map else []
        return " ".join(["isolux render", self.scene.name, "-o image.exr", *self.arguments(), *extra])


class Run:
    """A render that is done."""

    def __init__(self, request, folder):
        self.request = request
        self.folder = folder
        self.report = json.loads((folder / "report.json").read_text())
        self.exr = folder / "image.exr"
        self.png = folder / "image.png"
        self.sample_map = folder / "samples.png"
        device = self.report["seconds"].get("device")
        # On a device the time of its work alone; start-up is no part of either.
        self.seconds = self.report["seconds"]["render"] if device is None else device
        self.spp = self.report["samples"] / (self.report["width"] * self.report["height"])


@dataclasses.dataclass(frozen=True)
class Error:
    """Of an image against a reference: over all pixels, linear R, G and B."""
    raw_mse: float
    reference_variance: float
    reference_mean: float
    relative_bias: float

    @property
    def mse(self):
        """E[(x - r)^2] = MSE + Var(r): may fall below zero, and stays there."""
        return self.raw_mse - self.reference_variance

    @property
    def relative_rmse(self):
        return signed_root(self.mse) / self.reference_mean

    @property
    def flagged(self):
        """Whether the reference's noise is too large a share of the error, unless both are nothing."""
        return self.reference_variance > REFERENCE_SHARE * self.mse and self.raw_mse > 0


@dataclasses.dataclass(frozen=True)
class Measured:
    """Renders that differ by their seed alone, with their errors."""
    runs: list
    errors: list

    @property
    def mses(self):
        return [error.mse for error in self.errors]

    @property
    def seconds(self):
        return [run.seconds for run in self.runs]

    @property
    def median_seconds(self):
        return statistics.median(self.seconds)

    @property
    def seconds_per_spp(self):
        return statistics.median(run.seconds / run.spp for run in self.runs)

    @property
    def relative_rmse(self):
        """Root of the mean over seeds of the squared error, with its t interval."""
        mean = self.errors[0].reference_mean
        return [value if value is None else signed_root(value) / mean for value in mean_interval(self.mses)]

    @property
    def flagged(self):
        """As for one image, but of the mean over the seeds: they share the reference."""
        mean = statistics.fmean(self.mses)
        return self.errors[0].reference_variance > REFERENCE_SHARE * mean and any(e.raw_mse > 0 for e in self.errors)


def write_text(path, text):
    """To a temporary name, then renamed."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    temporary.write_text(text)
    temporary.replace(path)


def scene_digest(path):
    digest = hashlib.sha256(path.read_bytes())
    for part in facts(path)["files"]:
        digest.update(part.read_bytes() if part.is_file() else b"absent")
    return digest.hexdigest()


class Runner:
    def __init__(self, program, output, jobs):
        self.program = str(program)
        self.output = output
        self.digest = hashlib.sha256(pathlib.Path(program).read_bytes()).hexdigest()
        self.pool = concurrent.futures.ThreadPoolExecutor(jobs)
        self.scene_digests = {}
        self.rendered = 0
        self.used = 0
        self.faults = {}
        self.devices = set()

    def scene_digest(self, path):
        if path not in self.scene_digests:
            self.scene_digests[path] = scene_digest(path)
        return self.scene_digests[path]

    def key(self, request, with_program):
        drivers = [os.environ.get(name) for name in ("VK_DRIVER_FILES", "VK_ICD_FILENAMES")]
        made_by = [self.digest, drivers] if with_program else []
        parts = [self.scene_digest(request.scene), request.arguments(), request.sample_map, made_by]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()[:24]

    def render(self, request):
        return self.kept(request, self.output / "runs" / self.key(request, True))

    def reference(self, request):
        """Kept by scene and options alone: another program must show the same image."""
        return self.kept(request, self.output / "references" / self.key(request, False))

    def kept(self, request, folder):
        if not (folder / "report.json").exists():
            self.run(request, folder)
            self.rendered += 1
        run = Run(request, folder)
        self.used += 1
        self.devices.add("{name}, {driver} {driverVersion}".format(**run.report["device"]))
        for fault, count in run.report["diagnostics"].items():
            self.faults[fault] = self.faults.get(fault, 0) + count
        return run

    def run(self, request, folder):
        """Into a folder of another name, renamed when all of it is there."""
        temporary = folder.with_name(folder.name + ".tmp")
        shutil.rmtree(temporary, ignore_errors=True)
        temporary.mkdir(parents=True)
        command = [self.program, "render", str(request.scene), "-q", "-o", str(temporary / "image.exr"),
                   "-o", str(temporary / "image.png"), "--json", str(temporary / "report.json"), *request.arguments()]
        if request.sample_map:
            command += ["--sample-map", str(temporary / "samples.png")]
        self.call(command, request.command())
        shutil.rmtree(folder, ignore_errors=True)
        temporary.rename(folder)

    def call(self, command, shown):
        result = subprocess.run(command, capture_output=True, text=True, errors="replace")
        if result.returncode != 0:
            lines = (result.stderr.strip() or result.stdout.strip() or "no output").splitlines()
            raise Failed(f"exit status {result.returncode} from '{shown}': {lines[0]}")
        return result.stdout

    def comparison(self, image, reference):
        path = image.folder / f"compared-{reference.folder.name}.json"
        if not path.exists():
            command = [self.program, "compare", "--json", "--flip", "none", str(image.exr), str(reference.exr)]
            write_text(path, self.call(command, "isolux compare image.exr reference.exr"))
        return json.loads(path.read_text())

    def reference_variance(self, reference):
        """The mean over pixels and channels of the variance of the reference's pixels: comparing it with itself counts it
        twice."""
        return self.comparison(reference, reference)["noiseMse"] / 2

    def error(self, image, reference):
        found = self.comparison(image, reference)
        if found["mse"] is None:
            raise Failed(f"an image of '{image.request.command()}' holds NaN or infinity")
        mean = statistics.fmean(found["mean"]["reference"]["rgb"])
        return Error(found["mse"], self.reference_variance(reference), mean, found["relativeBias"]["luminance"][1])

    def errors(self, images, reference):
        self.reference_variance(reference)  # once, before all of them ask for it
        return list(self.pool.map(lambda image: self.error(image, reference), images))

    def measured(self, requests, reference):
        runs = [self.render(request) for request in requests]
        return Measured(runs, self.errors(runs, reference))

    def interleaved(self, groups, reference):
        """Measured by name for requests by name, as many of each: rendered in turns, so that what else the machine does
        meets all of them alike."""
        rounds = zip(*groups.values())
        runs = [[self.render(request) for request in one_round] for one_round in rounds]
        return {name: Measured(list(column), self.errors(column, reference)) for name, column in zip(groups, zip(*runs))}

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
from study_surfaces import surface_error

# The reference's own variance should be less than this share of an error measured against it.
REFERENCE_SHARE = 0.01

# Of the image that tells which pixels see a light: one that is missed by so many rays holds next to nothing of it.
EMISSION_SPP = 256


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
    """Of an image against a reference: over all its pixels or some, linear R, G and B."""
    raw_mse: float
    reference_variance: float
    reference_mean: float

    @property
    def mse(self):
        """E[(x - r)^2] = MSE + Var(r): may fall below zero, and stays there."""
        return self.raw_mse - self.reference_variance

    @property
    def relative_rmse(self):
        return relative(self.mse, self.reference_mean)

    @property
    def flagged(self):
        """Whether the reference's noise is too large a share of the error, unless both are nothing."""
        return self.reference_variance > REFERENCE_SHARE * self.mse and self.raw_mse > 0


@dataclasses.dataclass(frozen=True)
class Compared:
    """An image held against its reference: the whole of it, the pixels that see no light (None without such), and the
    relative difference of the means."""
    whole: Error
    surfaces: Error
    relative_bias: float


@dataclasses.dataclass(frozen=True)
class Measured:
    """Renders that differ by their seed alone, with their comparisons."""
    runs: list
    compared: list

    @property
    def errors(self):
        return [one.whole for one in self.compared]

    @property
    def surface_errors(self):
        return [one.surfaces or one.whole for one in self.compared]

    @property
    def mses(self):
        """What efficiency is about: errors where methods differ."""
        return [error.mse for error in self.surface_errors]

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
        return root_mean_square(self.errors)

    @property
    def surface_rmse(self):
        return root_mean_square(self.surface_errors)

    @property
    def reference_share(self):
        """Of the variance of the reference, which the seeds share, in their mean squared error; None without an error."""
        return share_of_reference(self.errors)

    @property
    def surface_reference_share(self):
        return share_of_reference(self.surface_errors)

    @property
    def flagged(self):
        return is_flagged(self.errors)

    @property
    def surface_flagged(self):
        return is_flagged(self.surface_errors)


def relative(mse, mean):
    """None where the reference is black: there is nothing to be relative to."""
    return signed_root(mse) / mean if mean > 0 else None


def root_mean_square(errors):
    """Relative, of the mean over seeds of the squared error, with its t interval."""
    mean = errors[0].reference_mean
    return [value if value is None else relative(value, mean) for value in mean_interval([error.mse for error in errors])]


def share_of_reference(errors):
    mean = statistics.fmean(error.mse for error in errors)
    return errors[0].reference_variance / mean if mean else None


def is_flagged(errors):
    mean = statistics.fmean(error.mse for error in errors)
    return errors[0].reference_variance > REFERENCE_SHARE * mean and any(error.raw_mse > 0 for error in errors)


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

    def emission(self, request):
        """What the camera sees of the lights alone, in an image of the same size."""
        return self.render(Request(request.scene, ("--max-depth", "0"), EMISSION_SPP, request.size)).exr

    def comparison(self, image, reference, emission):
        """The program's report, and the errors on surfaces."""
        path = image.folder / f"compared-{reference.folder.name}.json"
        if not path.exists():
            command = [self.program, "compare", "--json", "--flip", "none", str(image.exr), str(reference.exr)]
            found = json.loads(self.call(command, "isolux compare image.exr reference.exr"))
            found["surfaces"] = surface_error(image.exr, reference.exr, emission)
            write_text(path, json.dumps(found) + "\n")
        return json.loads(path.read_text())

    def compare(self, image, reference, emission):
        found = self.comparison(image, reference, emission)
        if found["mse"] is None:
            raise Failed(f"an image of '{image.request.command()}' holds NaN or infinity")
        # Comparing the reference with itself counts the variance of its pixels twice.
        variance = self.comparison(reference, reference, emission)["noiseMse"] / 2
        whole = Error(found["mse"], variance, statistics.fmean(found["mean"]["reference"]["rgb"]))
        part = found["surfaces"] and Error(*(found["surfaces"][name] for name in ("mse", "referenceVariance", "referenceMean")))
        return Compared(whole, part, found["relativeBias"]["luminance"][1])

    def compared(self, images, reference):
        emission = self.emission(reference.request)
        self.comparison(reference, reference, emission)  # once, before all of them ask for it
        return list(self.pool.map(lambda image: self.compare(image, reference, emission), images))

    def measured(self, requests, reference):
        runs = [self.render(request) for request in requests]
        return Measured(runs, self.compared(runs, reference))

    def interleaved(self, groups, reference):
        """Measured by name for requests by name, as many of each: rendered in turns, so that what else the machine does
        meets all of them alike."""
        rounds = zip(*groups.values())
        runs = [[self.render(request) for request in one_round] for one_round in rounds]
        return {name: Measured(list(column), self.compared(column, reference)) for name, column in zip(groups, zip(*runs))}

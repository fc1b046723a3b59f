"""The renderers that `tools/bench/peers` compares: how each is called for an image of so many samples with a seed."""

import array
import dataclasses
import glob
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import venv

from peers_worker import PREFIX
from study_exr import read_channels

LIB = pathlib.Path(__file__).resolve().parent
THREADS = 2
MITSUBA = "mitsuba==3.9.1"
# What Isolux does before it renders; the rest of its report's seconds is rendering.
SET_UP = ("open", "load", "build", "upload", "compile")


class Missing(Exception):
    """A renderer cannot be had here; the message is one line."""


class Failed(Exception):
    """A renderer did not do what was asked; the message is one line."""


@dataclasses.dataclass(frozen=True)
class Render:
    image: array.array  # red, green, blue of each pixel, row by row from the top
    seconds: float  # of rendering alone
    setup: float  # of loading and compiling, as far as the renderer tells
    device_seconds: float | None = None
    rays: int = 0


@dataclasses.dataclass(frozen=True)
class Variant:
    """A way to render: one of the renderers with its settings."""
    name: str
    renderer: str
    settings: tuple

    @property
    def comparable(self):
        """The variant of Isolux that it is held against: like with like."""
        return "isolux" if self.settings[-1] == "independent" else "isolux sobol"


# Cycles has no independent samples. The first of `REFERENCES` that is there renders what a renderer's images converge to.
VARIANTS = [Variant("isolux", "isolux", ("independent",)), Variant("isolux sobol", "isolux", ("sobol",)),
            Variant("mitsuba llvm", "mitsuba", ("llvm_ad_rgb", "independent")),
            Variant("mitsuba llvm multijitter", "mitsuba", ("llvm_ad_rgb", "multijitter")),
            Variant("mitsuba scalar", "mitsuba", ("scalar_rgb", "independent")),
            Variant("cycles pmj", "cycles", ("PROGRESSIVE_MULTI_JITTER",)), Variant("cycles sobol", "cycles", ("SOBOL",))]
REFERENCES = {"isolux": ["isolux sobol"], "mitsuba": ["mitsuba llvm multijitter", "mitsuba llvm", "mitsuba scalar"],
              "cycles": ["cycles sobol", "cycles pmj"]}


def interleaved(pixels):
    return array.array("f", [value for pixel in zip(pixels["R"], pixels["G"], pixels["B"]) for value in pixel])


class Isolux:
    """A process for each image; its kernels are cached in the folder."""

    def __init__(self, program, scene, folder, sampler, size):
        self.image, self.report = folder / "isolux.exr", folder / "isolux.json"
        self.command = [str(program), "render", str(scene), "-q", "--size", f"{size}x{size}", "--pixel-sampler", sampler,
                        "--aov", "none", "--cache-dir", str(folder / "cache"), "-o", str(self.image),
                        "--json", str(self.report)]

    def render(self, spp, seed):
        result = subprocess.run([*self.command, "--spp", str(spp), "--seed", str(seed)], capture_output=True, text=True,
                                env={**os.environ, "LP_NUM_THREADS": str(THREADS)})
        if result.returncode != 0:
            raise Failed((result.stderr.strip() or "isolux: no output").splitlines()[0])
        report = json.loads(self.report.read_text())
        seconds = report["seconds"]
        _, _, pixels = read_channels(self.image, ["R", "G", "B"])
        return Render(interleaved(pixels), seconds["render"], sum(seconds[name] for name in SET_UP), seconds["device"],
                      report["rays"])

    def close(self):
        """Nothing is left running."""


class Worker:
    """A process that stays, so that loading and compiling happen once."""

    def __init__(self, name, command, folder, environment):
        self.name, self.image = name, folder / f"{name.replace(' ', '-')}.f32"
        self.log = open(folder / f"{name.replace(' ', '-')}.log", "w")
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log, text=True,
                                        env={**os.environ, **environment})

    def render(self, spp, seed):
        answer = self.ask({"spp": spp, "seed": seed, "out": str(self.image)})
        if "error" in answer:
            raise Failed(f"{self.name}: {answer['error']}")
        if answer["spp"] != spp:
            raise Failed(f"{self.name}: took {answer['spp']} samples a pixel instead of {spp}")
        return Render(array.array("f", self.image.read_bytes()), answer["seconds"], answer["loadSeconds"])

    def ask(self, request):
        try:
            self.process.stdin.write(json.dumps(request) + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            raise Failed(f"{self.name}: ended; see {self.log.name}") from None
        for line in self.process.stdout:
            if line.startswith(PREFIX):
                return json.loads(line[len(PREFIX):])
        raise Failed(f"{self.name}: ended; see {self.log.name}")

    def close(self):
        """It holds nothing worth waiting for, and a renderer's own way to end may hang."""
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout, self.log):
            stream.close()


def llvm_library():
    """The newest of those installed, unless DRJIT_LIBLLVM_PATH names one."""
    named = os.environ.get("DRJIT_LIBLLVM_PATH")
    found = glob.glob("/usr/lib/*/libLLVM.so.*") + glob.glob("/usr/lib/*/libLLVM-*.so")
    if not named and not found:
        raise Missing("Mitsuba's LLVM variant needs LLVM's library: install libllvm19, or name it in DRJIT_LIBLLVM_PATH")
    return named or max(found, key=lambda path: [int(number) for number in re.findall(r"\d+", pathlib.Path(path).name)])


def mitsuba_python(folder):
    """The Python of a virtual environment that has Mitsuba, made if it is not there."""
    python = folder / "venv" / "bin" / "python"
    if not python.exists() or subprocess.run([python, "-c", "import mitsuba, numpy"], capture_output=True).returncode != 0:
        print(f"peers: installing {MITSUBA} into {folder / 'venv'}", file=sys.stderr, flush=True)
        try:
            venv.create(folder / "venv", with_pip=True, clear=True)
            subprocess.run([python, "-m", "pip", "install", "-q", MITSUBA, "numpy"], check=True, capture_output=True, text=True)
        except (subprocess.CalledProcessError, OSError) as error:
            reason = (getattr(error, "stderr", "") or str(error)).strip().splitlines()
            raise Missing(f"Mitsuba could not be installed: {reason[-1] if reason else error}") from None
    return str(python)


def blender():
    found = shutil.which("blender")
    if not found:
        raise Missing("Cycles needs Blender: install blender")
    return found


class Renderers:
    """Opens variants for a scene."""

    def __init__(self, program, folder, size):
        self.program, self.folder, self.size = program, folder, size
        self.python = None  # that has Mitsuba, or the reason why there is none: found out once

    def mitsuba(self):
        if self.python is None:
            try:
                self.python = mitsuba_python(self.folder)
            except Missing as error:
                self.python = error
        if isinstance(self.python, Missing):
            raise self.python
        return self.python

    def start(self, variant, scene, folder):
        """`folder` holds the exported scene. Raises Missing."""
        if variant.renderer == "isolux":
            return Isolux(self.program, scene, folder, *variant.settings, self.size)
        if variant.renderer == "mitsuba":
            backend, sampler = variant.settings
            environment = {"DRJIT_LIBLLVM_PATH": llvm_library()} if backend.startswith("llvm") else {}
            command = [self.mitsuba(), LIB / "peers_mitsuba.py", backend, THREADS, folder, sampler, self.size]
            return Worker(variant.name, [str(word) for word in command], folder, environment)
        command = [blender(), "-b", "--factory-startup", "--python-exit-code", "1", "--python", LIB / "peers_cycles.py", "--",
                   THREADS, folder, *variant.settings, self.size]
        return Worker(variant.name, [str(word) for word in command], folder, {})

"""Reads convergence.json, which `isolux converge` writes: what must be there is checked, what may be unknown is None."""

import dataclasses
import json
import math
import pathlib
import re

KIND, SCHEMA = "convergence", 1
FILE = "convergence.json"


class BadInput(Exception):
    """One line for the user, with the file and the place in it."""


def number(value, where):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BadInput(f"{where} wants a number, not {json.dumps(value)[:40]}")
    return value if math.isfinite(value) else None


def positive(value, where):
    found = number(value, where)
    if found is None or found <= 0:
        raise BadInput(f"{where} wants a number above 0, not {json.dumps(value)[:40]}")
    return found


def string(value, where):
    if not isinstance(value, str):
        raise BadInput(f"{where} wants a text, not {json.dumps(value)[:40]}")
    return value


def flag(value, where):
    if not isinstance(value, bool):
        raise BadInput(f"{where} wants true or false, not {json.dumps(value)[:40]}")
    return value


def counts(value, where):
    """Numbers by name; deeper ones by both names."""
    if not isinstance(value, dict):
        raise BadInput(f"{where} wants an object")
    found = {}
    for name, part in value.items():
        if isinstance(part, dict):
            found.update({f"{name} {inner}": count for inner, count in counts(part, f"{where}.{name}").items()})
        elif part is not None:
            found[name] = number(part, f"{where}.{name}")
    return found


def interval(value, where):
    """[low, estimate, high]; nothing without an estimate."""
    if not isinstance(value, list) or len(value) != 3:
        raise BadInput(f"{where} wants [low, estimate, high]")
    found = [None if part is None else number(part, where) for part in value]
    return None if found[1] is None else found


def items(read):
    def read_items(value, where):
        if not isinstance(value, list):
            raise BadInput(f"{where} wants a list")
        return [None if part is None else read(part, f"{where}[{place}]") for place, part in enumerate(value)]
    return read_items


def record(required, optional):
    """Unknown optional fields are None; unknown to this program: left out."""
    def read_record(value, where):
        if not isinstance(value, dict):
            raise BadInput(f"{where} wants an object")
        for name in required:
            if value.get(name) is None:
                raise BadInput(f"{where} has no '{name}'")
        return {name: None if value.get(name) is None else read(value[name], f"{where}.{name}")
                for name, read in (required | optional).items()}
    return read_record


COVERAGE = record({"inside": number, "total": number}, {"share": interval, "below": number})
CALIBRATION = record({}, {"meanLuminance": COVERAGE, "pixels": items(COVERAGE), "estimateOverError": interval})
MEASURES = ["mse", "relMse", "relMseTrimmed", "mae", "flip", "bias", "biasSquared", "relativeRmse", "estimate"]
CHECKPOINT = record({"samplesPerPixel": positive, "wallSeconds": positive},
                    {"raysPerPixel": number, "deviceSeconds": number, "calibration": CALIBRATION}
                    | {name: interval for name in MEASURES})
TIME_TO = record({"error": positive}, {"seconds": interval, "extrapolated": flag, "reason": string})
VARIANT = record({"name": string, "checkpoints": items(CHECKPOINT)},
                 {"options": string, "seeds": number, "setupSeconds": number, "slopeTime": interval, "slopeSamples": interval,
                  "floor": interval, "slopeHolds": flag, "efficiency": interval, "timeTo": items(TIME_TO)})
RATIO = record({"faster": string, "slower": string, "error": positive},
               {"ratio": interval, "extrapolated": flag, "text": string})
IMAGE = record({"name": string}, {"image": string, "flip": string, "samplesPerPixel": number, "seconds": number,
                                  "relativeRmse": number, "flipMean": number})
IMAGES = record({}, {"reference": string, "equalTimeSeconds": number, "variants": items(IMAGE)})
REFERENCE = record({}, {"files": items(string), "samplesPerPixel": number, "relativeRmse": number,
                        "relativeBiasError": number, "tooNoisy": items(string), "method": string})
RUN = record({"variants": items(VARIANT)},
             {"scene": string, "sceneHash": string, "width": number, "height": number, "camera": string, "maxDepth": number,
              "version": string, "revision": string, "device": string, "driver": string, "driverVersion": string,
              "seeds": items(number), "flip": record({}, {"pixelsPerDegree": number}), "reference": REFERENCE,
              "diagnostics": counts, "truncated": counts, "errors": items(number), "ratios": items(RATIO),
              "images": IMAGES, "command": string})


@dataclasses.dataclass
class Run:
    folder: pathlib.Path
    data: dict
    title: str  # unique on the page
    slug: str   # the same, for names of files and places in the page

    @property
    def variants(self):
        return self.data["variants"]


def parse(text, where):
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as problem:
        raise BadInput(f"{where}: damaged JSON: {problem}") from problem
    if not isinstance(found, dict) or found.get("kind") != KIND:
        raise BadInput(f"{where}: not a convergence report (no \"kind\": \"{KIND}\")")
    if found.get("schema") != SCHEMA:
        raise BadInput(f"{where}: schema {json.dumps(found.get('schema'))[:40]}, only {SCHEMA} is known")
    return found


def filled(data):
    """Lists that may be unknown are empty, so that nobody else must ask."""
    for name in ("ratios", "errors", "variants"):
        data[name] = [part for part in data[name] or [] if part is not None]
    for variant in data["variants"]:
        for name in ("checkpoints", "timeTo"):
            variant[name] = [part for part in variant[name] or [] if part is not None]
    data["errors"] = data["errors"] or sorted({found["error"] for variant in data["variants"]
                                               for found in variant["timeTo"]}, reverse=True)
    return data


def read_data(folder):
    path = folder / FILE
    try:
        text = path.read_text()
    except (OSError, UnicodeDecodeError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else "not a text"
        raise BadInput(f"{path}: {reason}") from problem
    data = filled(RUN(parse(text, path), f"{path}: run"))
    if not data["variants"]:
        raise BadInput(f"{path}: no variants")
    return data


def words(name):
    return re.sub(r"[-_\s]+", " ", name).strip()


def titles(named):
    """The scene's name, with the folder's where scenes repeat, with a count where that is not enough."""
    scenes = [words(pathlib.PurePath(data["scene"]).stem) if data["scene"] else words(folder.name) for folder, data in named]
    found = []
    for (folder, _), scene in zip(named, scenes):
        title = scene if scenes.count(scene) == 1 else f"{scene} ({folder.name})"
        found.append(title if title not in found else f"{title} {len(found) + 1}")
    return found


def read_runs(folders):
    named = [(folder.resolve(), read_data(folder)) for folder in folders]
    runs = []
    for (folder, data), title in zip(named, titles(named)):
        slug = re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-") or "run"
        taken = {run.slug for run in runs}
        runs.append(Run(folder, data, title, slug if slug not in taken else f"{slug}-{len(runs) + 1}"))
    return runs

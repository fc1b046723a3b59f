"""The file of tools/bench/history: one run a line, as JSON. What cannot be read is named and left as it is."""

import fcntl
import json
import math
import os

SCHEMA = 1
RATIOS = ("rays", "build", "path", "error")
TEXTS = ("date", "revision", "version", "device", "driver")


class BadInput(Exception):
    """What is wrong with a file or a line, in one line."""


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def check_ratio(name, ratio):
    """Ratios may be missing (null): what a device or a tree cannot measure is left out."""
    if ratio is None:
        return
    if not isinstance(ratio, dict) or not isinstance(ratio.get("rounds"), list) or not ratio["rounds"]:
        raise BadInput(f"ratios.{name} has no rounds")
    if not all(is_number(value) and value > 0 for value in ratio["rounds"]):
        raise BadInput(f"ratios.{name}.rounds wants numbers above 0")
    interval = ratio.get("interval")
    if not isinstance(interval, list) or len(interval) != 3 or not is_number(interval[1]):
        raise BadInput(f"ratios.{name}.interval wants [low, estimate, high]")
    if not all(end is None or is_number(end) for end in interval):
        raise BadInput(f"ratios.{name}.interval wants numbers or null")


def parsed(text):
    """A run, checked."""
    try:
        run = json.loads(text)
    except (ValueError, RecursionError):
        raise BadInput("damaged JSON") from None
    if not isinstance(run, dict) or run.get("schema") != SCHEMA:
        raise BadInput(f"not a run of schema {SCHEMA}")
    for name in TEXTS:
        if not isinstance(run.get(name), str):
            raise BadInput(f"{name} wants a text")
    machine = run.get("machine")
    if not isinstance(machine, dict) or not isinstance(machine.get("cpu"), str) or not is_number(machine.get("cores")):
        raise BadInput("machine wants cpu and cores")
    if not isinstance(run.get("ratios"), dict):
        raise BadInput("no ratios")
    for name in RATIOS:
        check_ratio(name, run["ratios"].get(name))
    return run


def read(path):
    """Runs in order, and (line number, what is wrong) of the others. No file: none of either."""
    runs, damaged = [], []
    try:
        text = path.read_bytes()
    except FileNotFoundError:
        return runs, damaged
    for number, line in enumerate(text.split(b"\n"), start=1):
        if not line.strip():
            continue
        try:
            runs.append(parsed(line.decode()))
        except BadInput as problem:
            damaged.append((number, str(problem)))
        except UnicodeDecodeError:
            damaged.append((number, "not UTF-8"))
    return runs, damaged


def append(path, run):
    """In one write at the end, so that readers and other writers see all of the line or nothing. A line that was torn off
    before its end stays alone."""
    line = json.dumps(run, ensure_ascii=False, allow_nan=False).encode() + b"\n"
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "a+b", buffering=0) as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        size = os.fstat(stream.fileno()).st_size
        if size and os.pread(stream.fileno(), 1, size - 1) != b"\n":
            line = b"\n" + line
        written = stream.write(line)
        if written != len(line):
            os.ftruncate(stream.fileno(), size)
            raise OSError(None, "could not write the whole line", str(path))
        os.fsync(stream.fileno())


def machine_of(run):
    """What must be equal for two runs to be compared."""
    return run["machine"]["cpu"], run["machine"]["cores"], run["device"]


def revision_of(run):
    return run["revision"] + ("+" if run.get("dirty") else "")

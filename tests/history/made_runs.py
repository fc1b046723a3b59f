"""Runs as tools/bench/history writes them, made up: two machines, ratios that are known."""

import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "lib"))
sys.dont_write_bytecode = True
import history_measure

# Factors about 1 whose median is 1: the noise of seven rounds.
NOISE = [0.97, 1.02, 1.0, 0.99, 1.03, 0.98, 1.01]


def raw_round(factor=1.0, noise=1.0):
    """Isolux is `factor` as fast as it usually is: ratios 0.5, 0.25, 0.1 and 2 where factor and noise are 1."""
    return {
        "raysPerSecond": 4e6 * factor * noise, "embreePrimaryRaysPerSecond": 8e6,
        "buildSeconds": 0.2 / factor / noise, "embreeBuildSeconds": 0.05,
        "samplesPerSecond": 1e6 * factor * noise, "embreeSpheresBounceRaysPerSecond": 1e7,
        "secondsToError": 50.0 / factor / noise, "embreeBoxBounceRaysPerSecond": 1e7,
    }


def run(number=0, factor=1.0, cpu="A CPU", **changed):
    """The number-th run on a machine."""
    return {
        "schema": 1, "date": f"2026-01-{number + 1:02}T12:00:00Z", "revision": f"{0xabcdef + number:x}", "dirty": False,
        "version": "0.1.0", "machine": {"cpu": cpu, "cores": 4}, "device": "a device", "driver": "a driver 1.0",
        "embree": "3.13.5", "scenes": {"rays": "1"}, "quick": False,
        **history_measure.summary([raw_round(factor, noise) for noise in NOISE]), **changed,
    }

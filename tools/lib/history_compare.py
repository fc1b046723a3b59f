"""What changed between two runs on one machine, and a run as a table."""

import statistics

from history_file import RATIOS, machine_of, revision_of
from report_text import NOTHING, short
from study_statistics import bootstrap

UNITS = {"rays": "rays a ray of Embree", "build": "builds a build of Embree", "path": "samples a ray of Embree",
         "error": "images to 5 % a billion rays of Embree"}


def last_two(runs):
    """The last run and, before it, the one before on the same machine, as long as that; nothing where there is none."""
    last = runs[-1]
    before = [run for run in runs[:-1]
              if machine_of(run) == machine_of(last) and bool(run.get("quick")) == bool(last.get("quick"))]
    return (before[-1] if before else None), last


def change(before, after):
    """Of the medians, after over before, with its interval by resampling the rounds of both; nothing where either run has
    no such ratio."""
    if not before or not after:
        return None
    return bootstrap(lambda samples: statistics.median(samples[1]) / statistics.median(samples[0]),
                     [before["rounds"], after["rounds"]])


def verdict(found):
    """Whether the whole interval lies on one side of 1. Fewer than five rounds have no interval to trust."""
    low, _, high = found
    if low is None or high is None:
        return "one round: no interval"
    if low > 1:
        return "better, beyond noise"
    return "worse, beyond noise" if high < 1 else "within noise"


def interval_text(found):
    low, estimate, high = found
    ends = "" if low is None or high is None else f" [{short(low)}, {short(high)}]"
    return short(estimate) + ends


def title(run):
    return f"{revision_of(run)} {run['date'][:16].replace('T', ' ')}"


def comparison(before, after):
    """A line a ratio."""
    lines = [f"{after['machine']['cpu']}, {after['machine']['cores']} cores, {after['device']}",
             f"{title(before)} to {title(after)}"]
    for name in RATIOS:
        found = change(before["ratios"].get(name), after["ratios"].get(name))
        said = NOTHING if found is None else f"times {interval_text(found)}: {verdict(found)}"
        lines.append(f"{name:6} {said}")
    if min(before.get("rounds", 0), after.get("rounds", 0)) < 5:
        lines.append("fewer than five rounds: the intervals are narrower than the noise")
    if before.get("scenes") != after.get("scenes"):
        lines.append("the scenes are not the same: what changed may be they")
    return "\n".join(lines)


def table(run):
    """Markdown."""
    rows = ["| ratio | median | 95 % interval | of what |", "|---|---|---|---|"]
    for name in RATIOS:
        ratio = run["ratios"].get(name)
        low, estimate, high = ratio["interval"] if ratio else (None, None, None)
        ends = NOTHING if low is None else f"{short(low)} to {short(high)}"
        rows.append(f"| `{name}` | {short(estimate)} | {ends} | {UNITS[name]} |")
    return "\n".join(rows)

"""The ratios of all runs as one picture, a panel a ratio: SVG that follows the reader's light or dark mode, and PNG."""

import re

import matplotlib
import matplotlib.pyplot as pyplot
from history_compare import UNITS
from history_file import RATIOS, machine_of, revision_of
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator
from page_style import STYLE as PAGE_STYLE
from report_plots import INK, STYLE, colour, marker
from report_style import STYLE as REPORT_STYLE
from report_svg import svg_text, with_variables
from report_text import plain_number

MOST_LABELS = 12  # of runs below a panel
DARK = "@media (prefers-color-scheme: dark)"


def shown(runs):
    """Quick runs are noise: they are drawn only where there is nothing else."""
    return [run for run in runs if not run.get("quick")] or runs


def machines_of(runs):
    """In the order in which they first ran."""
    return list(dict.fromkeys(machine_of(run) for run in runs))


def points(runs, machine, name):
    """(place of the run, interval) of those that have the ratio."""
    return [(place, run["ratios"][name]["interval"]) for place, run in enumerate(runs)
            if machine_of(run) == machine and run["ratios"].get(name)]


def draw_machine(axes, number, found, label):
    x = [place for place, _ in found]
    estimates = [interval[1] for _, interval in found]
    below = [0 if low is None else max(0, estimate - low) for _, (low, estimate, _) in found]
    above = [0 if high is None else max(0, high - estimate) for _, (_, estimate, high) in found]
    axes.errorbar(x, estimates, yerr=[below, above], color=colour(number), marker=marker(number), linewidth=1.2,
                  elinewidth=1.4, capsize=3, label=label)


def label_of(run):
    return f"{revision_of(run)}\n{run['date'][:10]}"


def set_places(axes, runs):
    """Some runs have their revision and date below."""
    step = -(-len(runs) // MOST_LABELS)
    axes.set_xlim(-0.5, len(runs) - 0.5)
    axes.xaxis.set_major_locator(FixedLocator(range(0, len(runs), step)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda place, _: label_of(runs[round(place)])))
    crowded = len(runs) > 5
    pyplot.setp(axes.get_xticklabels(), fontsize=8.5, rotation=35 if crowded else 0, ha="right" if crowded else "center",
                rotation_mode="anchor" if crowded else "default")


def draw_panel(axes, runs, name):
    for number, machine in enumerate(machines_of(runs)):
        found = points(runs, machine, name)
        if found:
            cpu, cores, device = machine
            draw_machine(axes, number, found, f"{cpu}, {cores} cores; {device}")
    axes.set_title(name, loc="left", fontsize=11, color=INK, fontweight="bold")
    axes.set_ylabel(UNITS[name], fontsize=9)
    axes.set_ylim(0, 1.1 * axes.get_ylim()[1])
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: plain_number(round(value, 12))))
    set_places(axes, runs)


def figure(runs):
    drawn, panels = pyplot.subplots(2, 2, figsize=(11, 7.2), layout="constrained")
    for axes, name in zip(panels.flat, RATIOS):
        draw_panel(axes, runs, name)
    handles, labels = panels.flat[0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="upper center", bbox_to_anchor=(0.5, 0.0), fontsize=9)
    return drawn


def variables(style):
    """The colours that a style names, the last definition of each."""
    return dict(re.findall(r"(--[\w-]+): (#[0-9a-f]{3,8})", style))


def colours_by_mode():
    """As a style of the picture: those of the project's pages."""
    light, dark = {}, {}
    for style in (PAGE_STYLE, REPORT_STYLE):
        before, after = style.split(DARK, 1)
        light |= variables(before)
        dark |= variables(after)
    written = [" ".join(f"{name}: {value};" for name, value in found.items()) for found in (light, dark)]
    return f"<style>:root {{ {written[0]} }} {DARK} {{ :root {{ {written[1]} }} }}</style>"


def with_modes(svg):
    """The figure's background and letters change with the rest; what the style holds stays."""
    return re.sub(r"(<svg[^>]*>)", lambda match: match[1] + colours_by_mode(), with_variables(svg), count=1)


def draw(runs, path):
    """`path` without an ending; the files written."""
    with matplotlib.rc_context(STYLE):
        drawn = figure(shown(runs))
        written = [path.with_name(path.name + ending) for ending in (".svg", ".png")]
        for name in written:
            temporary = name.with_name("." + name.name)
            if name.suffix == ".svg":
                temporary.write_text(with_modes(svg_text(drawn)))
            else:
                drawn.savefig(temporary, format="png", dpi=160, bbox_inches="tight", pad_inches=0.06, metadata={"Software": None})
            temporary.replace(name)
        pyplot.close(drawn)
    return written

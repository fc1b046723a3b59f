"""The page of tools/report: one HTML file with plots and images in it, made of runs and of the plots' SVG, nothing else."""

import page_style
import report_style
from page_parts import comparator, embedded, text
from report_figures import best, counted, facts, headlines, missing_images, time_to, warnings
from report_parts import cell, empty_cell, legend, table
from report_tables import calibration, checkpoints, rates, ratios, times
from report_text import clock, plain_percent, short, short_percent, short_seconds

CAPTIONS = {
    "error-time": (
        "Error against time",
        "Bands: 95 % intervals over seeds. Dashed: the renderer's own estimate of its error. Dotted: errors whose times are "
        "asked for. Shaded: the reference's own error; it is taken out of the curves, which may go below."),
    "error-samples": (
        "Error against samples",
        "Dash-dotted: slope −½, as of independent samples. What differs here differs in noise, not in speed."),
    "bias-time": (
        "Bias against time",
        "Of the mean luminance, relative to the reference, with 95 % intervals: they should hold 0. Linear about 0, "
        "logarithmic beyond. Shaded: how well the reference's own mean is known. Points are moved a little sideways."),
    "estimate-samples": (
        "The renderer's estimate of its error",
        "Over the true one: 1 is right, below 1 promises too much. Shaded: 10 % about 1."),
}

EXPLANATION = (
    "Relative RMSE is √mean((x − r)²)/mean(r) of image x and reference r, linear RGB, over the whole image; the reference's "
    "own variance is taken out (the method is named with each reference), and what is left may be negative. Intervals are "
    "at 95 %, over independent seeds. Seconds are wall-clock seconds of rendering, without set-up and without measuring. A "
    "ratio of times compares the times at which two variants reach the same error.")


def picture(run, name, label, caption):
    """An image or, where it is missing, its place; the place has no entry in the comparison."""
    path = run.folder / name
    if not path.is_file():
        return f'<div class="gap" role="img" aria-label="{text(label)}: missing">missing</div>'
    return f'<img alt="{text(run.title)}: {text(label)}{text(caption)}" src="{embedded(path)}">'


def image_figure(run, entry):
    samples = f"{short(entry['samplesPerPixel'])} spp" if entry["samplesPerPixel"] is not None else None
    seconds = short_seconds(entry["seconds"]) if entry["seconds"] is not None else None
    error = f"relative RMSE {short_percent(entry['relativeRmse'])}" if entry["relativeRmse"] is not None else None
    flip = f"mean FLIP {short(entry['flipMean'])}" if entry["flipMean"] is not None else None
    lines = [", ".join(filter(None, (samples, seconds))), error, flip]
    shown = "".join(f"<span>{text(line)}</span>" for line in lines if line)
    images = "".join(picture(run, entry[kind], f"{entry['name']}{label}", f", {error or 'error unknown'}")
                     for kind, label in (("image", ""), ("flip", ", FLIP map")) if entry[kind])
    return f'<figure>{images}<figcaption><b>{text(entry["name"])}</b>{shown}</figcaption></figure>'


def compared(run, images):
    """What the slider offers, in the order of the images on the page."""
    found = [(images["reference"], "reference")]
    for entry in filter(None, images["variants"] or []):
        found += [(entry["image"], entry["name"]), (entry["flip"], f"{entry['name']}, FLIP map")]
    missing = missing_images(run)
    return [{"label": label} for name, label in found if name and name not in missing]


def first_shown(run, choices):
    """The place of the best variant's image, or of what follows the reference."""
    error = run.data["errors"][0] if run.data["errors"] else None
    winner = best(run, error) if error else None
    name = run.variants[winner]["name"] if winner is not None else None
    return next((place for place, item in enumerate(choices) if item["label"] == name), 1)


def strip(run):
    images = run.data["images"]
    if not images or not images["variants"]:
        return ""
    reference = ""
    if images["reference"]:
        shown = picture(run, images["reference"], "reference", "")
        reference = f"<figure>{shown}<figcaption><b>reference</b></figcaption></figure>"
    figures = reference + "".join(image_figure(run, entry) for entry in images["variants"] if entry)
    choices = compared(run, images)
    slider = comparator(choices, first_shown(run, choices)) if len(choices) > 1 else ""
    seconds = images["equalTimeSeconds"]
    title = f"At equal time: {short_seconds(seconds)}" if seconds is not None else "Images"
    return (f'<div class="block" id="{run.slug}-images"><h3>{text(title)}</h3><p>The checkpoint of each variant '
            "nearest to that time; below it the FLIP map: the brighter, the more visible the difference.</p>"
            f'<div class="pictures">{slider}<div class="sheet strip">{figures}</div></div></div>')


def plots(run, drawn):
    def figure(name):
        title, explanation = CAPTIONS[name]
        return f"<figure>{drawn[name]}<figcaption><b>{text(title)}</b><span>{text(explanation)}</span></figcaption></figure>"

    figures = "".join(map(figure, drawn))
    return f'<div class="block" id="{run.slug}-plots">{legend(run.variants)}<div class="plots">{figures}</div></div>'


def plot_label(run, name):
    """What a plot says to who cannot see it."""
    title, _ = CAPTIONS[name]
    names = ", ".join(variant["name"] for variant in run.variants)
    return f"{run.title}: {title.lower()} of {names}; the numbers are under Every checkpoint"


def fact_list(run):
    known = facts(run)
    rows = "".join(f"<dt>{text(name)}</dt><dd>{text(value)}</dd>" for name, value in known.items() if value is not None)
    options = "".join(f"<dt>{text(variant['name'])}</dt><dd><code>{text(variant['options'])}</code></dd>"
                      for variant in run.variants if variant["options"])
    absent = [name.lower() if name not in ("FLIP", "Isolux") else name for name, value in known.items() if value is None]
    unknown = f"<p>Not recorded: {text(', '.join(absent))}.</p>" if absent else ""
    command = run.data["command"]
    shown = f"<pre tabindex=0>{text(command)}</pre>" if command else ""
    return (f'<details class="facts"{" open" if len(known) > len(absent) + 3 else ""}><summary>Scene, machine, command</summary>'
            f"<dl>{rows}{options}</dl>{unknown}{shown}</details>")


def count_list(run):
    words = "; ".join(words for _, words in counted(run))
    return f"<p>Counted: {text(words)}.</p>" if words else ""


def warning_box(run):
    lines = "".join(f"<li>{text(line)}</li>" for line in warnings(run))
    return f'<div class="warnings" role="note"><b>Warnings</b><ul>{lines}</ul></div>' if lines else ""


def sentences(run):
    first, *others = headlines(run)
    listed = "".join(f"<li>{text(line)}</li>" for line in others)
    return f'<p class="headline">{text(first)}.</p>' + (f'<ul class="more">{listed}</ul>' if listed else "")


def parts(run):
    """Links to what the run's section holds."""
    found = {"plots": "plots", "times": "times", "rates": "efficiency", "ratios": "ratios" if ratios(run) else "",
             "images": "images" if strip(run) else "", "calibration": "calibration" if calibration(run) else "",
             "checkpoints": "every checkpoint"}
    return "".join(f'<a href="#{run.slug}-{name}">{label}</a>' for name, label in found.items() if label)


def section(run, drawn, heading):
    return (f'<section id="{run.slug}"><h2>{text(heading)}</h2>{sentences(run)}{warning_box(run)}'
            f'<nav aria-label="{text(run.title)}">{parts(run)}</nav>'
            f"{plots(run, drawn)}{times(run)}{rates(run)}{ratios(run)}{strip(run)}{calibration(run)}{checkpoints(run)}"
            f"{fact_list(run)}{count_list(run)}</section>")


def overview_cell(run, name, error):
    for place, variant in enumerate(run.variants):
        if variant["name"] == name:
            found = time_to(variant, error)
            if not found:
                return empty_cell()
            kinds = f"{'best ' if place == best(run, error) else ''}{'extrapolated' if found['extrapolated'] else ''}".strip()
            low, seconds, high = found["seconds"]
            return cell(clock(seconds), "" if None in (low, high) else f"{clock(low)} to {clock(high)}", kinds)
    return cell("")


def overview(runs):
    """Scene by variant: the time to the first error."""
    if len(runs) < 2:
        return ""
    names = list(dict.fromkeys(variant["name"] for run in runs for variant in run.variants))
    rows = []
    for run in runs:
        error = run.data["errors"][0] if run.data["errors"] else None
        winner = best(run, error) if error else None
        first = cell(run.variants[winner]["name"] if winner is not None else "none")
        cells = [overview_cell(run, name, error) if error else cell("") for name in names]
        rows.append((f'<a href="#{run.slug}">{text(run.title)}</a>', [cell(plain_percent(error) if error else ""), first, *cells]))
    return ('<h2 id="overview">Overview</h2><p>Time to the first error asked for, with 95 % intervals; the least in bold, '
            "extrapolated times in italics.</p>" + table("Overview", ["scene", "to", "soonest", *names], rows))


MACHINE = {"Device": "", "Driver": "driver ", "Isolux": "Isolux ", "Image": ""}  # facts, with what goes before them


def machine(runs):
    """A line for each machine and size that runs were measured on."""
    lines = {}
    for known in filter(lambda known: known["Device"], map(facts, runs)):
        named = [f"{prefix}{known[name]}" for name, prefix in MACHINE.items() if known[name]]
        lines[" · ".join(named)] = True
    return "".join(f"<p>{text(line)}</p>" for line in lines)


def warned(run):
    return ' <b class="warned">(with warnings)</b>' if any(warnings(run)) else ""


def top(runs):
    """Of several runs a sentence each, then where to find them."""
    if len(runs) == 1:
        return ""
    lines = "".join(f'<li><a href="#{run.slug}">{text(run.title)}</a>: {text(headlines(run)[0])}{warned(run)}</li>'
                    for run in runs)
    links = "".join(f'<a href="#{run.slug}">{text(run.title)}</a>' for run in runs)
    return f'<ul class="more">{lines}</ul><nav aria-label="Scenes"><a href="#overview">Overview</a>{links}</nav>'


def page(runs, drawn):
    """`drawn`: of each run the plots' SVG by name."""
    title = f"Error against run time: {runs[0].title}" if len(runs) == 1 else f"Error against run time: {len(runs)} runs"
    body = "".join(section(run, shown, run.title if len(runs) > 1 else "Who is soonest") for run, shown in zip(runs, drawn))
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{text(title)}</title><style>{page_style.STYLE}{report_style.STYLE}</style></head><body>
<main><h1>{text(title)}</h1>
{machine(runs)}
{top(runs)}
{overview(runs)}
{body}
<h2>How to read this</h2><p>{text(EXPLANATION)}</p></main>
<script>{page_style.SCRIPT}{report_style.SCRIPT}</script></body></html>
"""

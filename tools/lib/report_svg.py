"""matplotlib's SVG made fit for a page: no second document, no names that clash, colours from the page's style."""

import html
import io
import re

import matplotlib
import matplotlib.pyplot as pyplot
from report_page import plot_label
from report_plots import GRID, INK, PAPER, PLOTS, SERIES, SHADE, SOFT, STYLE, add_legend, add_title

VARIABLES = {INK: "--text", SOFT: "--soft", GRID: "--line", SHADE: "--floor", PAPER: "--card"} | {
    colour: f"--v{place}" for place, colour in enumerate(SERIES)}


def svg_text(drawn):
    """The same for the same figure: no date, names by a fixed salt."""
    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "isolux"}):
        drawn.savefig(buffer, format="svg", bbox_inches="tight", pad_inches=0.06, metadata={"Date": None, "Creator": None})
    return buffer.getvalue()


def unique_names(svg, prefix):
    """Names of what is referred to get a prefix, those of variants become classes, the others go."""
    used = set(re.findall(r'(?:href="#|url\(#)([^")]+)', svg))

    def name(match):
        found = match[1]
        variant = re.match(r"variant-(\d+)-(\w+)", found)
        if variant:
            return f'class="variant-{variant[1]} {variant[2]}"'
        return f'id="{prefix}-{found}"' if found in used else ""

    svg = re.sub(r'(?<= )id="([^"]*)"', name, svg)
    svg = re.sub(r'xlink:href="#', f'href="#{prefix}-', svg)
    return svg.replace("url(#", f"url(#{prefix}-")


def with_variables(svg):
    return re.sub("#[0-9a-f]{6}", lambda match: f"var({VARIABLES[match[0]]})" if match[0] in VARIABLES else match[0], svg)


def inline(svg, prefix, label):
    """The element alone, as wide as its place, read out as `label`."""
    body = svg[svg.index("<svg"):]
    box = re.search(r'viewBox="[^"]*"', body)[0]
    body = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>", "", body, flags=re.S)
    body = re.sub(r"<svg[^>]*>", "", body, count=1)
    body = re.sub(r"font: ([\d.]+)px [^;\"]*", r"font-size: \1px", body)
    body = with_variables(unique_names(body, prefix))
    return f'<svg class="plot" {box} role="img" aria-label="{html.escape(label)}">{body.strip()}'


def standalone(drawn, run, path):
    """SVG and PNG in light colours with a title and a legend; `path` without an ending."""
    add_legend(drawn)
    add_title(drawn, run)
    for ending in ("svg", "png"):
        temporary = path.with_name(f".{path.name}.{ending}")
        if ending == "svg":
            temporary.write_text(svg_text(drawn))
        else:
            drawn.savefig(temporary, format="png", dpi=160, bbox_inches="tight", pad_inches=0.06, metadata={"Software": None})
        temporary.replace(path.with_name(f"{path.name}.{ending}"))


def draw(run, folder):
    """Writes a run's plots to the folder; for the page their SVG by name."""
    found = {}
    with matplotlib.rc_context(STYLE):
        for name, plot in PLOTS.items():
            drawn = plot(run)
            if drawn is None:
                continue
            found[name] = inline(svg_text(drawn), f"{run.slug}-{name}", plot_label(run, name))
            standalone(drawn, run, folder / f"{run.slug}-{name}")
            pyplot.close(drawn)
    return found

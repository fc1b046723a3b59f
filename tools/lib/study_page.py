"""The study's page: one HTML file with its images in it, for light and dark, wide and narrow screens, with and without a
mouse. It is made of results.json and the images that names, nothing else."""

from page_parts import commands, comparator, embedded, text
from page_style import SCRIPT, STYLE
from study_chart import chart
from study_text import flag, number, percent, seconds


def error_text(item):
    """Of the whole image, with the mark of a reference that is not clean enough; on surfaces if that is something else."""
    if item["relativeRmse"] is None:
        return ""
    error = f"error {percent(item['relativeRmse'])}" + flag(item["flagged"], item["referenceShare"])
    if item["surfaceRmse"] not in (None, item["relativeRmse"]):
        error += f", on surfaces {percent(item['surfaceRmse'])}"
    return error


def picture(item, output):
    """The first line under an image names it, the second measures it."""
    figures = [f"{number(item['spp'])} spp", seconds(item["seconds"]), error_text(item)]
    mark = f'<span class="mark" title="{text(item["standIn"])}">stand-in</span>' if item["standIn"] else ""
    return (f'<figure><img alt="{text(item["scene"])}: {text(item["label"])}" src="{embedded(output / item["image"])}">'
            f'<figcaption><b>{text(item["label"])}</b> {mark}'
            f'<span>{", ".join(filter(None, figures))}</span></figcaption></figure>')


def reasons(items):
    """Why what is a stand-in is one, each reason once."""
    found = {}
    for item in items:
        if item["standIn"]:
            found.setdefault(item["standIn"], {})[item["scene"]] = True
    return "".join(f"<p class=standin>Stand-in: {text(', '.join(scenes))}, {text(reason)}.</p>"
                   for reason, scenes in found.items())


def same_scene(items):
    return len({item["scene"] for item in items}) == 1


def pictures(block, output):
    items = block["items"]
    shown = "".join(picture(item, output) for item in items)
    compared = comparator(items) if len(items) > 1 and same_scene(items) else ""
    return (f'<div class="block"><h3>{text(block["caption"])}</h3><div class="pictures">{compared}'
            f'<div class="sheet">{shown}</div></div>{reasons(items)}{commands([item["command"] for item in items])}</div>')


def table(block, _):
    heads = "".join(f"<th scope=col>{text(cell)}</th>" for cell in block["head"])
    rows = "".join("<tr>" + "".join(f"<td>{text(cell)}</td>" for cell in row) + "</tr>" for row in block["rows"])
    return (f'<div class="block"><p>{text(block["caption"])}</p><div class="scroll" tabindex=0><table>'
            f'<thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table></div>{commands(block["commands"])}</div>')


def chart_figure(block, _):
    return (f'<div class="block plot"><p>{text(block["caption"])}</p>{chart(block)}{commands(block["commands"])}</div>')


def paragraph(block, _):
    return f'<p class="words">{text(block["text"])}</p>'


KINDS = {"pictures": pictures, "table": table, "chart": chart_figure, "text": paragraph}


def section(found, output):
    blocks = "".join(KINDS[block["kind"]](block, output) for block in found["blocks"])
    return f'<section id="{found["name"]}"><h2>{text(found["title"])}</h2>{blocks}</section>'


def headline_rows(sections):
    for found in sections:
        for line in found["headlines"]:
            yield (f'<tr><td><a href="#{found["name"]}">{text(line["what"])}</a></td><td>{text(line["figure"])}</td></tr>')


def contents(sections):
    return "".join(f'<a href="#{found["name"]}">{text(found["title"])}</a>' for found in sections)


EXPLANATION = (
    "Error is relative RMSE: the root of the mean squared difference from a long reference over the whole image in linear RGB, "
    "divided by the reference's mean. The reference's own variance is subtracted (E[(x − r)²] = MSE + Var(r)); ⚑ marks an error "
    "of whose square it is more than 1 %, with that share. On surfaces: the same over the pixels that see no light, because the "
    "edge of a lamp, hit or missed by camera rays alone, else hides what differs between ways to light the rest; efficiencies "
    "are of that error. Intervals are at 95 %. Seconds are those of rendering on the device, "
    "without loading, building and compiling. A picture shows the first seed.")


def page(results, output):
    """The whole page; paths of images are relative to the folder `output`."""
    facts = "".join(f"<p>{text(line)}</p>" for line in results["facts"])
    rows = "".join(headline_rows(results["sections"]))
    body = "".join(section(found, output) for found in results["sections"])
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Isolux: a path-tracing study</title><style>{STYLE}</style></head><body>
<h1>Isolux: a path-tracing study</h1>
{facts}
<div class="scroll"><table class="summary"><thead><tr><th scope=col>what</th><th scope=col>figure</th></tr></thead>
<tbody>{rows}</tbody></table></div>
<p>{text(EXPLANATION)}</p>
<nav>{contents(results["sections"])}</nav>
{body}
<script>{SCRIPT}</script></body></html>
"""

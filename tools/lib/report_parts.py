"""HTML that the sections of a report are made of: tables whose cells carry an interval below the figure, keys of variants."""

from page_parts import text
from report_text import NOTHING, with_interval

# Outlines of the marks, in the order of report_plots.MARKS, about a centre and 5 wide.
OUTLINES = [None, "-4,-4 4,-4 4,4 -4,4", "0,-5 4.6,4 -4.6,4", "0,-5.4 5.4,0 0,5.4 -5.4,0", "0,5 4.6,-4 -4.6,-4",
            "-1.6,-5 1.6,-5 1.6,-1.6 5,-1.6 5,1.6 1.6,1.6 1.6,5 -1.6,5 -1.6,1.6 -5,1.6 -5,-1.6 -1.6,-1.6",
            "-5,-3 -3,-5 0,-2 3,-5 5,-3 2,0 5,3 3,5 0,2 -3,5 -5,3 -2,0", "0,-5 4.8,-1.5 3,4 -3,4 -4.8,-1.5"]


def cell(figure, below="", kind=""):
    """A figure, under it in small what it is sure to."""
    small = f"<small>{text(below)}</small>" if below else ""
    return f'<td class="{kind}">{text(figure)}{small}</td>' if kind else f"<td>{text(figure)}{small}</td>"


def interval_cell(found, write, kind=""):
    return cell(*with_interval(found, write), kind)


def empty_cell(reason=""):
    return cell(NOTHING, reason, "none")


def head(names):
    return "".join(f"<th scope=col>{text(name)}</th>" for name in names)


def table(caption, names, rows):
    """`rows`: of a name and its cells, which are HTML already."""
    body = "".join(f"<tr><th scope=row>{name}</th>{''.join(cells)}</tr>" for name, cells in rows)
    return (f'<div class="scroll" tabindex=0 role="region" aria-label="{text(caption)}">'
            f"<table><thead><tr>{head(names)}</tr></thead><tbody>{body}</tbody></table></div>")


def block(name, title, explanation, *parts):
    shown = f"<p>{text(explanation)}</p>" if explanation else ""
    return f'<div class="block" id="{name}"><h3>{text(title)}</h3>{shown}{"".join(parts)}</div>'


def swatch(place):
    """Line and mark of a variant, as in the plots."""
    outline = OUTLINES[(place + place // len(OUTLINES)) % len(OUTLINES)]
    mark = f'<polygon points="{outline}" transform="translate(13 7)"/>' if outline else '<circle cx="13" cy="7" r="4.4"/>'
    colour = f"var(--v{place % len(OUTLINES)})"
    return (f'<svg class="swatch" width="26" height="14" aria-hidden="true"><g style="fill:{colour};stroke:{colour}">'
            f'<path d="M0 7H26" stroke-width="2"/>{mark}</g></svg>')


def variant_name(place, variant):
    return f'<span class="variant">{swatch(place)}{text(variant["name"])}</span>'


def legend(variants):
    """Buttons that hide and show a variant in the plots, where the script runs."""
    keys = "".join(f'<button type="button" aria-pressed="true" data-variant="{place}">'
                   f'{swatch(place)}{text(variant["name"])}</button>' for place, variant in enumerate(variants))
    return f'<div class="keys">{keys}</div>'

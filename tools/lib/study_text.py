"""How the study writes numbers; and the parts a section of its page is made of, as plain data."""

import math

NO_BREAK = "\u00a0"
MINUS = "\u2212"
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(value, digits=3):
    """With so many significant digits; whole numbers whole, thousands apart, small numbers with a power of ten."""
    if value is None:
        return "–"
    if value == round(value):
        return format(round(value), ",").replace("-", MINUS)
    exponent = math.floor(math.log10(abs(value)))
    if exponent < -4:
        return number(value / 10.0**exponent, digits) + f"{NO_BREAK}×{NO_BREAK}10" + str(exponent).translate(SUPERSCRIPT)
    return format(value, f",.{max(digits - 1 - exponent, 0)}f").replace("-", MINUS)


def percent(value, digits=3):
    return "–" if value is None else number(100 * value, digits) + NO_BREAK + "%"


def seconds(value, digits=3):
    return number(value, digits) + NO_BREAK + "s"


def interval(values, write=number):
    """The estimate, with its interval if it has one."""
    low, estimate, high = values
    if low is None:
        return write(estimate)
    return f"{write(estimate)} [{write(low)},{NO_BREAK}{write(high)}]"


def times(value):
    return "×" + number(value)


def flag(flagged, share):
    """What is put after an error whose square holds too much of the reference's noise: a mark, and the share if there is
    an error left to have a share of."""
    if not flagged:
        return ""
    return f" ⚑{NO_BREAK}{percent(share, 2)}" if share and share > 0 else " ⚑"


def whole_error(measured):
    """Over the whole image; marked where the reference is not clean enough for it."""
    return interval(measured.relative_rmse, percent) + flag(measured.flagged, measured.reference_share)


def surface_error(measured):
    """Over the pixels that see no light."""
    return interval(measured.surface_rmse, percent) + flag(measured.surface_flagged, measured.surface_reference_share)


def pictures_block(caption, items):
    return {"kind": "pictures", "caption": caption, "items": items}


def table_block(caption, head, rows, commands=()):
    return {"kind": "table", "caption": caption, "head": head, "rows": rows, "commands": list(commands)}


def series(name, points, line=True):
    """`points`: (x, y) or (x, y, low, high)."""
    return {"name": name, "points": points, "line": line}


def error_point(x, error):
    """A point of a series from [low, estimate, high]."""
    return [x, error[1], error[0], error[2]]


def chart_block(caption, x, y, lines, commands=()):
    return {"kind": "chart", "caption": caption, "x": x, "y": y, "series": lines, "commands": list(commands)}


def text_block(text):
    return {"kind": "text", "text": text}


def section(name, title, blocks, figures, headlines):
    """`figures`: what was measured, as numbers; `headlines`: (what, figure) for the table at the top."""
    return {"name": name, "title": title, "blocks": blocks, "figures": figures,
            "headlines": [{"what": what, "figure": figure} for what, figure in headlines]}

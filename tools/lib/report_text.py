"""How the report writes numbers, intervals and times, beside what study_text does."""

import math

from study_text import MINUS, NO_BREAK, number

NOTHING = "–"


def plain_number(value):
    """Of an axis: no powers of ten between a millionth and a million."""
    return f"{value:,.10g}".replace("-", MINUS)


def plain_percent(value):
    return f"{plain_number(round(100 * value, 10))}{NO_BREAK}%"


def short(value, digits=3):
    """A figure of a table; whole thousands lose no digit."""
    return NOTHING if value is None else number(float(value), digits)


def short_percent(value, digits=3):
    return NOTHING if value is None else short(100 * value, digits) + NO_BREAK + "%"


def short_seconds(value):
    return NOTHING if value is None else short(value) + NO_BREAK + "s"


def with_interval(found, write=short):
    """Estimate and ends as text: ("1.2", "1.1–1.3"); the second is empty without an interval."""
    if not found:
        return NOTHING, ""
    low, estimate, high = found
    ends = "" if low is None or high is None else f"{write(low)} to {write(high)}"
    return write(estimate), ends


def inverse(found):
    """The interval of 1/x, nothing where 0 may be in it."""
    if not found or None in found or min(found) <= 0:
        return None
    return [1 / found[2], 1 / found[1], 1 / found[0]]


def clock(value):
    """Seconds as a person says them."""
    if value is None or not math.isfinite(value):
        return NOTHING
    if value < 120:
        return short_seconds(value)
    if value < 7200:
        return f"{short(value / 60)}{NO_BREAK}min"
    return f"{short(value / 3600)}{NO_BREAK}h"

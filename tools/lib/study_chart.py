"""Charts of the study's page: SVG with logarithmic axes, coloured by the page's style so that both schemes can be read."""

import html
import math

WIDTH, HEIGHT = 560, 380
LEFT, RIGHT, TOP, BOTTOM = 66, 16, 14, 48
MARK = 4.5
SHAPES = 4  # marks that can be told apart without colour


class Axis:
    """Values to places along a length, by their logarithm; the ends lie a little beyond the values."""

    def __init__(self, values, start, end):
        low, high = math.log10(min(values)), math.log10(max(values))
        margin = max(0.04 * (high - low), 0.05)
        self.low, self.high = low - margin, high + margin
        self.start, self.end = start, end

    def place(self, value):
        return self.start + (math.log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self):
        """Powers of ten, every n-th where there are many, with digits between them where there are few."""
        powers = range(math.floor(self.low), math.ceil(self.high) + 1)
        inside = [power for power in powers if self.low <= power <= self.high]
        if len(inside) >= 3:
            step = -(-len(inside) // 6)
            return [10.0**power for power in inside[::step]]
        for digits in ((1, 2, 5), (1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9)):
            values = [digit * 10.0**power for power in powers for digit in digits]
            found = [value for value in values if self.low <= math.log10(value) <= self.high]
            if len(found) >= 3:
                break
        return found


def tick_text(value):
    if 0.001 <= value < 1_000_000:
        return f"{value:,.10g}"
    return power_text(round(math.log10(value)))


def power_text(exponent):
    sign = "\u2212" if exponent < 0 else ""
    return f'10<tspan dy="-5" font-size="10">{sign}{abs(exponent)}</tspan>'


def mark(shape, x, y):
    """A circle, square, triangle or diamond of about the same area."""
    if shape == 0:
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{MARK}"/>'
    outlines = {1: [(-1, -1), (1, -1), (1, 1), (-1, 1)], 2: [(0, -1.3), (1.2, 0.9), (-1.2, 0.9)],
                3: [(0, -1.4), (1.4, 0), (0, 1.4), (-1.4, 0)]}
    corners = " ".join(f"{x + 0.9 * MARK * a:.1f},{y + 0.9 * MARK * b:.1f}" for a, b in outlines[shape])
    return f'<polygon points="{corners}"/>'


def drawable(points):
    """What has a place on logarithmic axes."""
    return [point for point in points if point[0] > 0 and point[1] > 0]


def limits(point):
    """The ends of a point's interval that can be drawn."""
    return [value for value in point[2:] if value is not None and value > 0]


def series_shapes(line, number, x, y):
    points = drawable(line["points"])
    shape, places = number % SHAPES, [(x.place(point[0]), y.place(point[1])) for point in points]
    parts = []
    if line["line"]:
        path = " ".join(f"{a:.1f},{b:.1f}" for a, b in places)
        parts.append(f'<polyline class="line" points="{path}"/>')
    for point, (a, b) in zip(points, places):
        ends = limits(point)
        if len(ends) == 2:
            parts.append(f'<path class="bar" d="M{a:.1f} {y.place(ends[0]):.1f}V{y.place(ends[1]):.1f}"/>')
        if line.get("marks", True):
            title = html.escape(f"{line['name']}: {point[0]:,g}, {point[1]:.4g}")
            parts.append(f"<g><title>{title}</title>{mark(shape, a, b)}</g>")
    return f'<g class="series s{shape}">{"".join(parts)}</g>'


def grid(x, y):
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    for value in x.ticks():
        at = x.place(value)
        yield f'<path class="grid" d="M{at:.1f} {TOP}V{bottom}"/>'
        yield f'<text x="{at:.1f}" y="{bottom + 18}" text-anchor="middle">{tick_text(value)}</text>'
    for value in y.ticks():
        at = y.place(value)
        yield f'<path class="grid" d="M{LEFT} {at:.1f}H{right}"/>'
        yield f'<text x="{LEFT - 8}" y="{at + 4:.1f}" text-anchor="end">{tick_text(value)}</text>'


def titles(block):
    middle = (TOP + HEIGHT - BOTTOM) / 2
    center = (LEFT + WIDTH - RIGHT) / 2
    yield f'<text class="axis" x="{center}" y="{HEIGHT - 8}" text-anchor="middle">{html.escape(block["x"])}</text>'
    yield (f'<text class="axis" transform="translate(14 {middle}) rotate(-90)" text-anchor="middle">'
           f'{html.escape(block["y"])}</text>')


def legend(lines):
    """Beside the picture, so that it wraps on a narrow screen."""
    def key(line, number):
        marks = mark(number % SHAPES, 11, 7) if line.get("marks", True) else ""
        stroke = '<path class="line" d="M0 7H22"/>' if line["line"] else ""
        drawn = f'<svg width="22" height="14" aria-hidden="true"><g class="series s{number % SHAPES}">{stroke}{marks}</g></svg>'
        return f"<span>{drawn}{html.escape(line['name'])}</span>"

    return f'<div class="legend">{"".join(key(line, number) for number, line in enumerate(lines))}</div>'


def chart(block):
    points = [point for line in block["series"] for point in drawable(line["points"])]
    if not points:
        return "<p>nothing above zero to draw</p>"
    x = Axis([point[0] for point in points], LEFT, WIDTH - RIGHT)
    y = Axis([value for point in points for value in (point[1], *limits(point))], HEIGHT - BOTTOM, TOP)
    drawn = "".join(series_shapes(line, number, x, y) for number, line in enumerate(block["series"]))
    label = html.escape(block["caption"])
    return (f'<svg class="chart" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{label}">{"".join(grid(x, y))}'
            f'{"".join(titles(block))}{drawn}</svg>{legend(block["series"])}')

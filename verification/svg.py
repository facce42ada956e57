"""Plots of lines and points as SVG, with the standard library alone."""
import math
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 640, 420  # pixels
LEFT, RIGHT, TOP, BOTTOM = 78, 16, 38, 50
COLOURS = ["#1b4f8f", "#c0392b", "#2e8b57", "#8e5ea2", "#d98c10", "#17a2b8", "#555555"]


def number(value):
    return f"{value:.6g}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


class Axis:
    """From data to pixels, with its ticks; logarithmic ones drop values that are not positive."""

    def __init__(self, values, log, begin, end):
        self.log, self.begin, self.end = log, begin, end
        values = [self._scale(value) for value in values if self.shows(value)] or [0, 1]
        self.low, self.high = min(values), max(values)
        margin = 0.04 * (self.high - self.low) or 0.5 * abs(self.high) or 0.5
        self.low, self.high = self.low - margin, self.high + margin

    def shows(self, value):
        return math.isfinite(value) and (not self.log or value > 0)

    def _scale(self, value):
        return math.log10(value) if self.log else value

    def place(self, value):
        share = (self._scale(value) - self.low) / (self.high - self.low)
        return self.begin + share * (self.end - self.begin)

    def ticks(self):
        if self.log and self.high - self.low >= 1:
            every = max(1, round((self.high - self.low) / 8))
            found = [10.0**k for k in range(math.ceil(self.low), math.floor(self.high) + 1, every)]
            if len(found) < 3:
                found = [d * 10.0**k for k in range(math.floor(self.low), math.ceil(self.high) + 1) for d in (1, 2, 5)]
            return [value for value in found if self.low <= math.log10(value) <= self.high]
        low, high = (10**self.low, 10**self.high) if self.log else (self.low, self.high)
        raw = (high - low) / 6
        unit = 10 ** math.floor(math.log10(raw))
        step = next(unit * factor for factor in (1, 2, 5, 10) if unit * factor >= raw)
        return [step * k for k in range(math.ceil(low / step), math.floor(high / step) + 1) if step * k > 0 or not self.log]


class Plot:
    """Series against one pair of axes.

    add() takes points (x, y) and how they are shown: any of "line", "dashed" and "points".
    """

    def __init__(self, title, x, y, log_x=False, log_y=False):
        self.title, self.x, self.y, self.log_x, self.log_y = title, x, y, log_x, log_y
        self.series = []

    def add(self, label, points, how="line"):
        self.series.append((label, [(float(x), float(y)) for x, y in points], how))
        return self

    def svg(self):
        points = [point for _, of_series, _ in self.series for point in of_series]
        x_axis = Axis([x for x, _ in points], self.log_x, LEFT, WIDTH - RIGHT)
        y_axis = Axis([y for _, y in points], self.log_y, HEIGHT - BOTTOM, TOP)
        legend, height = self._legend()
        parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" '
                 'font-size="12">', f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>',
                 f'<text x="{WIDTH / 2}" y="22" font-size="14" text-anchor="middle">{escape(self.title)}</text>']
        parts += self._frame(x_axis, y_axis)
        for i, (_, points, how) in enumerate(self.series):
            parts += self._drawn(points, how, COLOURS[i % len(COLOURS)], x_axis, y_axis)
        return "\n".join(parts + legend + ["</svg>"]) + "\n"

    def _frame(self, x_axis, y_axis):
        parts, floor = [], HEIGHT - BOTTOM
        for value in x_axis.ticks():
            x = x_axis.place(value)
            parts.append(f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{floor}" stroke="#dddddd"/>'
                         f'<text x="{x:.1f}" y="{floor + 16}" text-anchor="middle">{number(value)}</text>')
        for value in y_axis.ticks():
            y = y_axis.place(value)
            parts.append(f'<line x1="{LEFT}" y1="{y:.1f}" x2="{WIDTH - RIGHT}" y2="{y:.1f}" stroke="#dddddd"/>'
                         f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{number(value)}</text>')
        middle = (TOP + floor) / 2
        return parts + [
            f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH - RIGHT - LEFT}" height="{floor - TOP}" fill="none" stroke="#444444"/>',
            f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 12}" text-anchor="middle">{escape(self.x)}</text>',
            f'<text x="16" y="{middle}" text-anchor="middle" transform="rotate(-90 16 {middle})">{escape(self.y)}</text>']

    @staticmethod
    def _drawn(points, how, colour, x_axis, y_axis):
        places = [(x_axis.place(x), y_axis.place(y)) for x, y in points if x_axis.shows(x) and y_axis.shows(y)]
        parts = []
        if "line" in how or "dashed" in how:
            dash = ' stroke-dasharray="6 4"' if "dashed" in how else ""
            path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
            parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.6"{dash}/>')
        if "points" in how:
            parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.6" fill="{colour}"/>' for x, y in places]
        return parts

    def _legend(self):
        """In two columns below the plot; and the height of the whole picture."""
        labels = [(label, how, COLOURS[i % len(COLOURS)]) for i, (label, _, how) in enumerate(self.series) if label]
        parts = []
        for i, (label, how, colour) in enumerate(labels):
            x, y = LEFT + i % 2 * (WIDTH - LEFT) / 2, HEIGHT + 10 + 17 * (i // 2)
            parts += self._drawn([(x, y - 4), (x + 24, y - 4)], how, colour, Pixels, Pixels)
            parts.append(f'<text x="{x + 32:.0f}" y="{y}">{escape(label)}</text>')
        return parts, HEIGHT + 17 * ((len(labels) + 1) // 2) + (6 if labels else 0)


class Pixels:
    """An axis whose data are pixels."""

    @staticmethod
    def shows(_):
        return True

    @staticmethod
    def place(value):
        return value

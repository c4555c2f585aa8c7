"""Charts of a report: SVG within the page, without a script. Colours come from the style sheet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from django.utils.html import format_html, format_html_join
from django.utils.safestring import SafeString

WIDTH = 720
LABEL_WIDTH = 220  # of bars, left of the scale
FIGURES_WIDTH = 120  # right of it
FIGURE_END = WIDTH - FIGURES_WIDTH + 42  # there figures end, and their intervals begin behind it
ROW = 24
HEIGHT = 260  # of a chart of lines
LEFT, RIGHT, TOP, BOTTOM = 48, 110, 12, 40
LONGEST_LABEL = 34
LABEL_GAP = 15  # between the names of lines
STYLES = 4  # of lines, in the style sheet


@dataclass(frozen=True, slots=True)
class Bar:
    """``value`` with its interval, fractions of 1."""

    label: str
    value: float
    low: float
    high: float
    style: int = 0


@dataclass(frozen=True, slots=True)
class Line:
    """Points from left to right; those that are None or no number are left out."""

    name: str
    xs: Sequence[float]
    ys: Sequence[float | None]


def draw_bars(title: str, bars: Sequence[Bar]) -> SafeString:
    """Draw bars on a scale from 0 to 100 %, their intervals on them, and the figures beside them."""
    height = ROW * len(bars) + 26
    ticks = format_html_join(
        "",
        _TICK,
        (
            (_number(_bar_x(percent / 100)), height - 22, height - 6, percent)
            for percent in (0, 25, 50, 75, 100)
        ),
    )
    rows = format_html_join(
        "", "{}", ((_draw_bar(place, each),) for place, each in enumerate(bars))
    )
    return _svg(title, height, format_html("{}{}", ticks, rows))


_TICK = (
    '<line class="grid" x1="{0}" x2="{0}" y1="0" y2="{1}"/>'
    '<text class="tick" x="{0}" y="{2}" text-anchor="middle">{3} %</text>'
)


def _bar_x(fraction: float) -> float:
    return LABEL_WIDTH + fraction * (WIDTH - LABEL_WIDTH - FIGURES_WIDTH)


def _draw_bar(place: int, bar: Bar) -> SafeString:
    label = bar.label
    if len(label) > LONGEST_LABEL:
        label = f"{label[: LONGEST_LABEL - 1]}…"
    top, middle = place * ROW, place * ROW + ROW // 2
    return format_html(
        '<text class="label" x="{}" y="{}" text-anchor="end">{}</text>'
        '<rect class="bar style-{}" x="{}" y="{}" width="{}" height="{}"/>'
        '<line class="interval" x1="{}" x2="{}" y1="{}" y2="{}"/>'
        '<text class="figure" x="{}" y="{}" text-anchor="end">{}</text>'
        '<text class="figure quiet" x="{}" y="{}">{}–{}</text>',
        *(LABEL_WIDTH - 8, middle + 4, label),
        *(bar.style % STYLES, LABEL_WIDTH, top + 5),
        *(_number(_bar_x(bar.value) - LABEL_WIDTH), ROW - 10),
        *(_number(_bar_x(bar.low)), _number(_bar_x(bar.high)), middle, middle),
        *(FIGURE_END, middle + 4, f"{100 * bar.value:.1f}"),
        *(FIGURE_END + 6, middle + 4, f"{100 * bar.low:.1f}", f"{100 * bar.high:.1f}"),
    )


def draw_lines(
    title: str, lines: Sequence[Line], x_label: str, y_label: str, x_most: float | None = None
) -> SafeString:
    """Draw lines with their names at their ends; the scale of values begins at 0."""
    points = [
        [
            (x, y)
            for x, y in zip(line.xs, line.ys, strict=True)
            if y is not None and math.isfinite(y) and math.isfinite(x)
        ]
        for line in lines
    ]
    xs = [x for some in points for x, _ in some]
    ys = [y for some in points for _, y in some]
    if not xs:
        return format_html("")
    first = min(xs) if x_most is None else 0.0
    is_whole = all(float(x).is_integer() for x in xs)  # epochs, such as
    across = _Scale(first, x_most or max(xs), LEFT, WIDTH - RIGHT, is_whole)
    up = _Scale(0.0, max(ys), HEIGHT - BOTTOM, TOP)
    shown = [(number, some) for number, some in enumerate(points) if some]
    heights = spread([up.place(some[-1][1]) for _, some in shown])
    drawn = format_html_join(
        "",
        "{}",
        (
            (_draw_line(number, lines[number].name, some, across, up, height),)
            for (number, some), height in zip(shown, heights, strict=True)
        ),
    )
    return _svg(title, HEIGHT, format_html("{}{}", _axes(across, up, x_label, y_label), drawn))


def spread(heights: Sequence[float], gap: float = LABEL_GAP) -> list[float]:
    """Return the heights of labels, moved apart so that no two are closer than ``gap``.

    Those further up stay where they are as far as the lowest does not leave the chart.
    """
    order = sorted(range(len(heights)), key=lambda number: heights[number])
    placed = list(heights)
    for before, number in pairwise(order):
        placed[number] = max(placed[number], placed[before] + gap)
    lowest: float = HEIGHT - BOTTOM
    for number in reversed(order):
        placed[number] = min(placed[number], lowest)
        lowest = placed[number] - gap
    return placed


@dataclass(frozen=True, slots=True)
class _Scale:
    """Numbers from ``low`` to ``high`` as places from ``start`` to ``end``."""

    low: float
    high: float
    start: float
    end: float
    is_whole: bool = False

    def place(self, value: float) -> float:
        width = self.high - self.low
        share = (value - self.low) / width if width else 0.0
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[float]:
        """Return about five round numbers; whole ones on a scale of such."""
        width = self.high - self.low
        if width <= 0:
            return [self.low]
        step = 10.0 ** math.floor(math.log10(width / 4))
        step *= next(each for each in (1, 2, 5, 10) if width / (step * each) <= 5)
        step = max(step, 1.0) if self.is_whole else step
        first = math.ceil(self.low / step - 1e-9)
        last = math.floor(self.high / step + 1e-9)
        return [step * number for number in range(first, last + 1)]


def _axes(across: _Scale, up: _Scale, x_label: str, y_label: str) -> SafeString:
    horizontal = format_html_join(
        "",
        '<line class="grid" x1="{0}" x2="{1}" y1="{2}" y2="{2}"/>'
        '<text class="tick" x="{3}" y="{4}" text-anchor="end">{5}</text>',
        (
            (LEFT, WIDTH - RIGHT, _number(y), LEFT - 6, _number(y + 4), f"{tick:g}")
            for tick in up.ticks()
            for y in (up.place(tick),)
        ),
    )
    vertical = format_html_join(
        "",
        '<text class="tick" x="{}" y="{}" text-anchor="middle">{}</text>',
        (
            (_number(across.place(tick)), HEIGHT - BOTTOM + 16, f"{tick:g}")
            for tick in across.ticks()
        ),
    )
    return format_html(
        '{}{}<text class="tick" x="{}" y="{}" text-anchor="middle">{}</text>'
        '<text class="tick" x="{}" y="{}">{}</text>',
        *(horizontal, vertical, (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 6, x_label),
        *(LEFT, 10, y_label),
    )


def _draw_line(
    number: int,
    name: str,
    points: Sequence[tuple[float, float]],
    across: _Scale,
    up: _Scale,
    label_height: float,
) -> SafeString:
    path = " ".join(f"{_number(across.place(x))},{_number(up.place(y))}" for x, y in points)
    x, y = points[-1]
    return format_html(
        '<polyline class="line style-{0}" points="{1}"/>'
        '<circle class="end style-{0}" cx="{2}" cy="{3}" r="3"/>'
        '<text class="label style-{0}" x="{4}" y="{5}">{6}</text>',
        *(number % STYLES, path, _number(across.place(x)), _number(up.place(y))),
        *(_number(across.place(x) + 8), _number(label_height + 4), name),
    )


def _svg(title: str, height: int, content: SafeString) -> SafeString:
    return format_html(
        '<svg viewBox="0 0 {} {}" role="img" aria-label="{}">{}</svg>',
        WIDTH,
        height,
        title,
        content,
    )


def _number(value: float) -> str:
    return f"{value:.1f}"

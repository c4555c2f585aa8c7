"""The colours of ``static/css/tokens.css`` are legible on the grounds on which they stand, in both themes.

Contrast is that of WCAG 2.2 (relative luminance of sRGB); text needs 4.5:1.
"""

from __future__ import annotations

import re
from math import cos, radians, sin
from pathlib import Path

import pytest

from annotations.language.forms import DEFAULT_CLASSES, HUES

TOKENS = Path(__file__).resolve().parent.parent / "static" / "css" / "tokens.css"
PAIR = re.compile(r"--([\w-]+): light-dark\((#[0-9a-f]{6}), (#[0-9a-f]{6})\);")
LEAST = 4.5
# Lightness in percent and chroma of a colour whose angle is that of a class, for both themes.
HUE = re.compile(
    r"light-dark\(oklch\(([\d.]+)% ([\d.]+) var\(--angle\)\), oklch\(([\d.]+)% ([\d.]+) var\(--angle\)\)\)"
)

PLAIN = ("page", "surface", "sunken", "hover", "accent-soft")
GROUNDS = {
    "ink": (*PLAIN, "good-soft", "bad-soft", "warn-soft"),
    "ink-2": PLAIN,
    "ink-3": PLAIN,
    "accent": PLAIN,
    "accent-ink": ("accent", "accent-strong"),
    "good": ("page", "surface", "hover", "good-soft"),
    "bad": ("page", "surface", "hover", "bad-soft"),
    "warn": ("page", "surface", "hover", "warn-soft"),
}


def themes() -> dict[str, dict[str, str]]:
    """Colour by token, for each theme."""
    pairs = PAIR.findall(TOKENS.read_text(encoding="utf-8"))
    return {
        "light": {name: light for name, light, _ in pairs},
        "dark": {name: dark for name, _, dark in pairs},
    }


def luminance(colour: str) -> float:
    """Relative luminance of ``#rrggbb``, from 0 to 1."""
    parts = (int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
    linear = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts
    ]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    """From 1 (the same) to 21 (black on white)."""
    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("text", GROUNDS)
def test_text_stands_out_from_its_grounds(text: str, theme: str) -> None:
    colours = themes()[theme]
    ratios = {ground: contrast(colours[text], colours[ground]) for ground in GROUNDS[text]}
    faint = {ground: round(ratio, 2) for ground, ratio in ratios.items() if ratio < LEAST}
    assert not faint, f"--{text} is too faint in the {theme} theme on {faint}"


def colour_of(lightness: float, chroma: float, hue: int) -> str:
    """``#rrggbb`` of an OKLCH colour, cut to what screens show."""
    a, b = chroma * cos(radians(hue)), chroma * sin(radians(hue))
    long = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3
    medium = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3
    short = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3
    linear = (
        4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short,
        -1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short,
        -0.0041960863 * long - 0.7034186147 * medium + 1.7076147010 * short,
    )
    cut = (min(1.0, max(0.0, each)) for each in linear)
    parts = (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in cut)
    return "#" + "".join(f"{round(255 * each):02x}" for each in parts)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_chips_of_every_hue_are_legible(theme: str) -> None:
    css = TOKENS.read_text(encoding="utf-8")
    text, soft = (
        {"light": pair[:2], "dark": pair[2:]}[theme]
        for pair in (
            HUE.search(css, css.index(f"--{name}:")).groups() for name in ("hue", "hue-soft")
        )
    )
    grounds = [themes()[theme][name] for name in PLAIN]
    for hue in range(HUES):
        said = colour_of(float(text[0]) / 100, float(text[1]), hue)
        mine = colour_of(float(soft[0]) / 100, float(soft[1]), hue)
        assert min(contrast(said, ground) for ground in (*grounds, mine)) >= LEAST, hue


def test_the_classes_that_every_world_has_have_hues_of_their_own() -> None:
    assert len({each.hue for each in DEFAULT_CLASSES}) == len(DEFAULT_CLASSES)

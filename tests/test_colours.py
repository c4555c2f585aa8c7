"""The colours of ``static/css/tokens.css`` are legible on the grounds on which they stand, in both themes.

Contrast is that of WCAG 2.2 (relative luminance of sRGB); text needs 4.5:1.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from annotations.language.symbols import ENTITY_CLASSES

TOKENS = Path(__file__).resolve().parent.parent / "static" / "css" / "tokens.css"
PAIR = re.compile(r"--([\w-]+): light-dark\((#[0-9a-f]{6}), (#[0-9a-f]{6})\);")
LEAST = 4.5

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
    **{f"class-{name}": (*PLAIN, f"class-{name}-soft") for name in ENTITY_CLASSES},
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


def test_each_entity_class_has_a_hue_of_its_own() -> None:
    for colours in themes().values():
        hues = {colours[f"class-{name}"] for name in ENTITY_CLASSES}
        assert len(hues) == len(ENTITY_CLASSES)

"""The widths and themes in which every page has to look right."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product


@dataclass(frozen=True, slots=True)
class Variant:
    """A window of ``width`` × ``height`` pixels in a ``light`` or ``dark`` theme."""

    width: int
    height: int
    theme: str

    def __str__(self) -> str:
        return f"{self.width}-{self.theme}"

    @property
    def size(self) -> dict[str, int]:
        return {"width": self.width, "height": self.height}

    @property
    def options(self) -> dict[str, object]:
        """What makes a Playwright context such a window."""
        return {
            "viewport": self.size,
            "color_scheme": self.theme,
            "reduced_motion": "reduce",
        }


SIZES = ((1280, 800), (390, 844))
VARIANTS = [Variant(*size, theme) for size, theme in product(SIZES, ("light", "dark"))]
WIDE_LIGHT, _, _, NARROW_DARK = VARIANTS

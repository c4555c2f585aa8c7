"""Say a form in other words than its gloss, for parsers to learn from."""

from __future__ import annotations

from annotations.language.rewording.rewording import Rewording

__all__ = ["Rewording"]

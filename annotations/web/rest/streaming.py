"""Answers that are sent in pieces."""

from __future__ import annotations

JSON_LINES = "application/jsonl"


class BrokenOff(Exception):
    """An answer ends before all of it was sent; a sentence says why.

    Raised while the pieces are sent. The web server then closes the connection without the end of the
    answer, so that no client takes it for whole.
    """

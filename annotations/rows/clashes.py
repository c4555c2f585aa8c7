"""What the database refuses because two people wrote at once: a row twice, or a row below a deleted one."""

from __future__ import annotations

import re

from django.db import IntegrityError

MADE_MEANWHILE = (
    "Somebody has stored the same, or deleted what this belongs to, at the same moment. Nothing of "
    "yours was stored. Load the page again and look."
)
# unique_violation and foreign_key_violation (PostgreSQL, appendix A).
CLASH_CODES = ("23505", "23503")
CLASH_WORDS = re.compile(r"UNIQUE|FOREIGN KEY")  # SQLite


def is_clash(error: BaseException | None) -> bool:
    """Return whether a database error says so. Other errors of integrity are faults of the code."""
    if not isinstance(error, IntegrityError):
        return False
    cause = error.__cause__
    if cause is not None and hasattr(cause, "sqlstate"):
        return bool(cause.sqlstate in CLASH_CODES)
    return CLASH_WORDS.search(str(error)) is not None

"""How lists count their rows."""

from __future__ import annotations

import pytest

from annotations.templatetags.counting import of_rows


@pytest.mark.parametrize(
    ("total", "plural", "words"),
    [
        (0, "commands", "0 commands"),
        (1, "commands without a form", "1 command without a form"),
        (1, "entities", "1 entity"),
        (1, "logical forms", "1 logical form"),
        (1211, "commands", "1,211 commands"),
        (10_000, "commands", "10,000 commands"),
        (10_001, "commands", "over 10,000 commands"),
    ],
)
def test_one_row_is_counted_in_the_singular(total, plural, words):
    assert of_rows(total, plural) == words

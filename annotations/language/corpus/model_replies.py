"""Read the rewrites in what a language model replied, however it chose to write them down."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from annotations.language.texts import folded_words, normalise, normalise_line

LONGEST_REPLY = 100_000  # characters that are read of a reply
LONGEST_REWRITE = 500  # characters; what is longer is prose about the task
_MOST_JSON = 20  # places of a reply at which JSON is tried

_OPENING = re.compile(r"<(think|thinking|thought|reasoning)>", re.IGNORECASE)
_CLOSING = re.compile(r"</(?:think|thinking|thought|reasoning)>", re.IGNORECASE)
_JSON_OPENING = re.compile(r"[\[{]")
# "1.", "2)", "(3)", "-", "*", "•", "a)" before an item.
_ITEM = re.compile(r"\s*(?:\(?\d{1,3}[.):]\)?|[a-hA-H]\)|[-*•–—])\s+(?=\S)")
# A word of the task before an item: "Simple:", "**Version 2:**", "(terse)".
_LABEL = re.compile(
    r"(?:[*_(\[]{0,3})(?:very |most |more )?"
    r"(?:paraphrase|rewrite|rephrasing|version|variant|variation|option|wording|command|simple|simplest|simpler|"
    r"complex|elaborate|medium|moderate|plain|polite|formal|informal|casual|terse|short|long|direct|indirect)"
    r"(?: ?#?\d{1,3})?(?:[*_]{0,3}[:)\]][*_]{0,3}|[*_]{0,3} [-–—])\s*",
    re.IGNORECASE,
)
_QUOTES = {'"': '"', "'": "'", "“": "”", "‘": "’", "«": "»", "`": "`"}


def rewrites_in(reply: str) -> tuple[str, ...]:
    """Return the rewrites of a reply in their order, each once, without numbers, marks, labels and quotes.

    A block of thought is left out, also one that never begins or never ends. Then a JSON list counts, or the
    lists and texts of a JSON object; else the items of a list, if there is one; else every line that does not
    end with a colon. A reply without any gives none.
    """
    text = _without_thought(normalise(reply[:LONGEST_REPLY]))
    written = _in_json(text)
    found = list(_in_lines(text)) if written is None else written
    # What is far too long is not looked into: marks around it would come off one by one.
    plain = (normalise_line(_plain(each)) for each in found if len(each) <= 2 * LONGEST_REWRITE)
    return tuple(
        dict.fromkeys(each for each in plain if len(each) <= LONGEST_REWRITE and folded_words(each))
    )


def _without_thought(text: str) -> str:
    closed = list(_CLOSING.finditer(text))
    if closed:
        text = text[closed[-1].end() :]
    opening = _OPENING.search(text)
    return text[: opening.start()] if opening else text


def _in_json(text: str) -> list[str] | None:
    """Return the texts of the first JSON list or object that has any; None where there is none."""
    decoder = json.JSONDecoder()
    end = 0
    for _ in range(_MOST_JSON):
        opening = _JSON_OPENING.search(text, end)
        if opening is None:
            return None
        try:
            value, end = decoder.raw_decode(text, opening.start())
        except (ValueError, RecursionError):
            end = opening.end()
            continue
        if texts := list(_texts_of(value)):
            return texts
    return None


def _texts_of(value: Any) -> Iterator[str]:
    """Yield the texts of a list; of an object, those in its lists, or else its own. Nesting is not followed further."""
    if isinstance(value, dict):
        lists = [each for each in value.values() if isinstance(each, list)]
        value = [each for items in lists for each in items] if lists else list(value.values())
    for each in value if isinstance(value, list) else ():
        if isinstance(each, dict):
            each = next((text for text in each.values() if isinstance(text, str)), None)
        if isinstance(each, str):
            yield each


def _in_lines(text: str) -> Iterator[str]:
    lines = [line for line in text.split("\n") if line.strip() and not line.startswith("```")]
    items = [line[item.end() :] for line in lines if (item := _ITEM.match(line))]
    if items:
        yield from items
    else:
        yield from (line for line in lines if not line.rstrip(" *_").endswith(":"))


def _plain(text: str) -> str:
    """Return an item without a label, emphasis and quotation marks around it."""
    plain = text.strip()
    if label := _LABEL.match(plain):
        plain = plain[label.end() :]
    while len(plain) > 1 and (
        _QUOTES.get(plain[0]) == plain[-1] or (plain[0] == plain[-1] and plain[0] in "*_")
    ):
        plain = plain[1:-1].strip()
    return plain

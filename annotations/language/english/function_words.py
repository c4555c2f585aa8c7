"""Words that change how a command is said but not what it means: data for edits of utterances."""

from __future__ import annotations

ARTICLES = frozenset(("the", "a", "an"))
# What may stand before a command; the longest that fits is taken away.
POLITE_OPENINGS = (
    "please",
    "robot please",
    "could you",
    "could you please",
    "can you",
    "can you please",
    "would you",
    "would you please",
    "will you",
    "will you please",
)
# “please” cannot stand before a text that begins with one of them: a question or a wish.
NO_COMMAND_WORDS = frozenset(
    (
        "what",
        "what's",
        "whats",
        "where",
        "where's",
        "who",
        "who's",
        "whos",
        "whose",
        "which",
        "when",
        "why",
        "how",
        "is",
        "are",
        "do",
        "does",
        "did",
        "has",
        "have",
        "can",
        "could",
        "will",
        "would",
        "i",
        "i'd",
        "i'll",
        "i'm",
        "we",
    )
)
# Who a thing is for, said without a name.
RECIPIENT_PRONOUNS = ("me", "him", "her")

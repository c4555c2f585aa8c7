"""The conditions of a figure: what a parser may know, what it learns from and what it is tested on."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from itertools import combinations
from typing import NamedTuple

from annotations.language.texts import Refusal

GENERATED, PARAPHRASED, MODEL, SAID = "generated", "paraphrased", "model", "said"

# What figures call a source → the source of pairs, in the order in which sources are named together.
SOURCES = {"gen": GENERATED, "para": PARAPHRASED, "model": MODEL, "said": SAID}
PEOPLES = ("para", "said")  # what people wrote or said themselves
# What pages call it.
SOURCE_WORDS = {
    "gen": "generated commands",
    "para": "paraphrases",
    "model": "paraphrases of a language model",
    "said": "what people said",
}
SHORT_SOURCES = {
    "gen": "generated",
    "para": "paraphrases",
    "model": "model paraphrases",
    "said": "what people said",
}


class Protocol(StrEnum):
    """What a parser may know beside its training pairs, from the least to the most (docs/design/parsers.md)."""

    STRICT = "strict"
    DOMAIN = "domain"
    GRAMMAR = "grammar"


# What a parser can learn from: sources, written ``gen+para``; those of the paper first.
PAPERS_SOURCES = ("gen", "para", "gen+para")
_COMBINED = (
    "+".join(names) for size in range(len(SOURCES)) for names in combinations(SOURCES, size + 1)
)
TRAIN_SOURCES = tuple(dict.fromkeys([*PAPERS_SOURCES, *_COMBINED]))

# What a parser is tested on → the sources of the pairs that this stands for.
TEST_SOURCES = {
    "gen": (GENERATED,),
    "para": (PARAPHRASED,),
    "model": (MODEL,),
    "said": (SAID,),
    "mixed": (GENERATED, PARAPHRASED),
}


def sources_of(train_sources: str) -> tuple[str, ...]:
    """Return the sources of the pairs that ``train_sources``, such as ``gen+para``, stands for."""
    return tuple(SOURCES[name] for name in train_sources.split("+"))


def written_sources(sources: Iterable[str]) -> str:
    """Return what sources of pairs are called together: ``gen+para``."""
    named = set(sources)
    return "+".join(name for name, source in SOURCES.items() if source in named)


def in_words(sources: str) -> str:
    """Say what is trained on or tested on: ``gen+para`` as ``generated commands and paraphrases``."""
    if sources == "mixed":
        return f"{in_words('gen+para')} together"
    *names, last = (SOURCE_WORDS[name] for name in sources.split("+"))
    return f"{', '.join(names)} and {last}" if names else last


def in_short(sources: str) -> str:
    """Say the same in the head of a column: ``gen+para``, trained on or tested on, as ``both``."""
    if sources in ("mixed", "gen+para"):
        return "both"
    return ", ".join(SHORT_SOURCES[name] for name in sources.split("+"))


def only_source(test_source: str) -> str | None:
    """Return the source of the pairs of ``test_source`` where it is a single one."""
    sources = TEST_SOURCES[test_source]
    return sources[0] if len(sources) == 1 else None


class Setting(NamedTuple):
    """What a parser learns from and is tested on; written ``gen+para-mixed``."""

    train_sources: str
    test_source: str

    def __str__(self) -> str:
        return f"{self.train_sources}-{self.test_source}"

    @classmethod
    def read(cls, text: str) -> Setting:
        """Return the setting that is written ``text``. Raises Refusal naming those of the paper."""
        train_sources, _, test_source = text.rpartition("-")
        if train_sources in TRAIN_SOURCES and test_source in TEST_SOURCES:
            return cls(train_sources, test_source)
        raise Refusal(
            f"{text!r} is no setting; the paper has {', '.join(map(str, PAPERS_SETTINGS))}.",
            "unknown_setting",
        )


def settings_of(train_sources: str) -> list[Setting]:
    """Return the settings of an accuracy table for what is trained on, in its order: on all that people say or
    write, and on generated commands where nothing else was learned from."""
    tested = ["gen"] if train_sources == "gen" else []
    tested += ["para", "model", "said"]
    tested += ["mixed"] if {"gen", "para"} <= set(train_sources.split("+")) else []
    return [Setting(train_sources, test_source) for test_source in tested]


# The settings of an accuracy table, in its order; the paper's are those without ``model`` and ``said``.
SETTINGS = tuple(setting for each in TRAIN_SOURCES for setting in settings_of(each))
PAPERS_SETTINGS = tuple(
    setting
    for setting in SETTINGS
    if setting.train_sources in PAPERS_SOURCES and setting.test_source in ("gen", "para", "mixed")
)

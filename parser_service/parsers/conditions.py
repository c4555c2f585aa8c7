"""The conditions of a figure: what a parser may know, what it learns from and what it is tested on."""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from annotations.language.errors import Refusal

GENERATED, PARAPHRASED = "generated", "paraphrased"


class Protocol(StrEnum):
    """What a parser may know beside its training pairs, from the least to the most (docs/design/parsers.md)."""

    STRICT = "strict"
    DOMAIN = "domain"
    GRAMMAR = "grammar"


class TrainSources(StrEnum):
    """What a parser learns from: generated commands, paraphrases, or both."""

    GENERATED = "gen"
    PARAPHRASED = "para"
    BOTH = "gen+para"

    @property
    def sources(self) -> tuple[str, ...]:
        """The sources of the pairs that this stands for."""
        names = {"gen": GENERATED, "para": PARAPHRASED}
        return tuple(names[name] for name in self.split("+"))


# What a parser is tested on → the sources of the pairs that this stands for.
TEST_SOURCES = {
    "gen": (GENERATED,),
    "para": (PARAPHRASED,),
    "mixed": (GENERATED, PARAPHRASED),
}


def only_source(test_source: str) -> str | None:
    """Return the source of the pairs of ``test_source`` where it is a single one."""
    sources = TEST_SOURCES[test_source]
    return sources[0] if len(sources) == 1 else None


class Setting(NamedTuple):
    """What a parser learns from and is tested on; written ``gen+para-mixed``."""

    train_sources: TrainSources
    test_source: str

    def __str__(self) -> str:
        return f"{self.train_sources}-{self.test_source}"

    @classmethod
    def read(cls, text: str) -> Setting:
        """Return the setting that is written ``text``. Raises Refusal naming those there are."""
        for setting in SETTINGS:
            if str(setting) == text:
                return setting
        raise Refusal(
            f"{text!r} is no setting; there are: {', '.join(map(str, SETTINGS))}.",
            "unknown_setting",
        )


# The settings of an accuracy table, in the order of the paper.
SETTINGS = (
    Setting(TrainSources.GENERATED, "gen"),
    Setting(TrainSources.GENERATED, "para"),
    Setting(TrainSources.PARAPHRASED, "para"),
    Setting(TrainSources.BOTH, "para"),
    Setting(TrainSources.BOTH, "mixed"),
)

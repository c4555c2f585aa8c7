"""Texts that a parser should not understand, or not as usual: probes for unexpected defaults.

Walker, Peng and Cakmak (2019) show six texts of this kind. Texts with words taken away or out of order:
Feng et al., Pathologies of neural models make interpretations difficult, EMNLP 2018.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import islice
from random import Random

from annotations.language.texts import unrelated_sentences

FEWEST_WORDS = 4  # of an utterance that is shuffled or truncated
EMPTY_TEXTS = ("", " ", ".", "?", "…")


class ProbeKind(StrEnum):
    """What has been done to a text."""

    PAPER = "paper"
    EMPTY = "empty"
    SHUFFLED = "shuffled"
    TRUNCATED = "truncated"
    UNRELATED = "unrelated"


@dataclass(frozen=True, slots=True)
class ProbeText:
    """A text for a parser. ``base`` is the place of the utterance it was made from, None where there is none.

    ``expects_unknown`` where nothing but UNKNOWN is right; of the others no form is known to be right.
    """

    kind: ProbeKind
    text: str
    base: int | None = None
    expects_unknown: bool = False


# Tables 3 and 4: three commands that got the same wrong form, three that differ in one word.
PAPER_PROBES = (
    ProbeText(ProbeKind.PAPER, "Bring an umbrella"),
    ProbeText(ProbeKind.PAPER, "Navigate to the hallway"),
    ProbeText(ProbeKind.PAPER, "Do this then that", expects_unknown=True),
    ProbeText(ProbeKind.PAPER, "Bring an umbrella to me"),
    ProbeText(ProbeKind.PAPER, "Bring an umbrella to Bob"),
    ProbeText(ProbeKind.PAPER, "Bring an umbrella to him"),
)

_PAPER_VERBS = {each.text.split()[0].lower() for each in PAPER_PROBES if not each.expects_unknown}


def make_probes(utterances: Sequence[str], count: int, seed: int = 0) -> tuple[ProbeText, ...]:
    """Return the probes of the paper and at most ``count`` of each other kind.

    Those of the paper ask a robot to do something; they are left out where no utterance has one of their verbs.

    Args:
        utterances: texts to shuffle and to truncate; a probe is never one of them.
        count: of each kind; there are only so many empty and unrelated texts.
        seed: equal seeds give equal probes.
    """
    random = Random(seed)
    known = {_plain(text) for text in utterances}
    order = random.sample(range(len(utterances)), len(utterances))
    shuffled = islice(_shuffle(utterances, order, known, random), count)
    truncated = islice(_truncate(utterances, order, known, random), count)
    unrelated = random.sample(unrelated_sentences(), min(count, len(unrelated_sentences())))
    words = {word for text in known for word in text.split()}
    paper = PAPER_PROBES if words & _PAPER_VERBS else ()
    return (
        *paper,
        *(ProbeText(ProbeKind.EMPTY, text, expects_unknown=True) for text in EMPTY_TEXTS[:count]),
        *shuffled,
        *truncated,
        *(ProbeText(ProbeKind.UNRELATED, text, expects_unknown=True) for text in unrelated),
    )


def _shuffle(
    utterances: Sequence[str], order: Sequence[int], known: set[str], random: Random
) -> Iterator[ProbeText]:
    """Yield utterances with their words in random order."""
    for place in order:
        words = utterances[place].split()
        text = " ".join(random.sample(words, len(words)))
        if len(words) >= FEWEST_WORDS and _plain(text) not in known:
            yield ProbeText(ProbeKind.SHUFFLED, text, place)


def _truncate(
    utterances: Sequence[str], order: Sequence[int], known: set[str], random: Random
) -> Iterator[ProbeText]:
    """Yield the beginnings of utterances, up to half of their words."""
    for place in order:
        words = utterances[place].split()
        if len(words) >= FEWEST_WORDS:
            text = " ".join(words[: random.randint(1, len(words) // 2)])
            if _plain(text) not in known:
                yield ProbeText(ProbeKind.TRUNCATED, text, place)


def _plain(text: str) -> str:
    return " ".join(text.lower().split())

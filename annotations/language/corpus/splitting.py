"""Split commands into train, validation and test so that no two parts share one, and hash a split."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass
from enum import StrEnum
from random import Random
from types import MappingProxyType

from annotations.language.errors import LanguageError


class Part(StrEnum):
    TRAIN = "train"
    VALIDATION = "validation"
    TEST = "test"


class Criterion(StrEnum):
    """What two parts never share: a text, a source command or a logical form."""

    COMMAND = "command"
    SOURCE_COMMAND = "source_command"
    LOGICAL_FORM = "logical_form"


DEFAULT_PROPORTIONS = (0.7, 0.1, 0.2)
NOTHING_KEPT: Mapping[str, Part] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class SplitItem:
    """What decides which part an example goes to. ``source`` is ``generated`` or ``paraphrased``.

    For a generated example the source command is the command itself, for a paraphrase the
    anonymized command that it rewrites. If it is empty, the utterance is used.
    """

    source: str
    utterance: str
    source_command: str
    logical_form: str

    def key(self, criterion: Criterion) -> str:
        """Return the key that keeps examples together; the case and spacing of texts are ignored."""
        if criterion is Criterion.LOGICAL_FORM:
            return self.logical_form
        is_source = criterion is Criterion.SOURCE_COMMAND and self.source_command
        text = self.source_command if is_source else self.utterance
        return " ".join(text.casefold().split())


@dataclass(frozen=True, slots=True)
class FrozenExample:
    """The texts of one example of a split that can change a result."""

    part: str
    source: str
    utterance: str
    source_command: str
    task_category: str
    logical_form: str
    grounded_form: str = ""


def split(
    items: Sequence[SplitItem],
    criterion: Criterion,
    proportions: Sequence[float] = DEFAULT_PROPORTIONS,
    seed: int = 0,
    kept: Mapping[str, Part] = NOTHING_KEPT,
) -> tuple[Part, ...]:
    """Return the part of each item, in the order of the items.

    Items with the same key stay together, whatever their source, so generated and paraphrased parts
    match. The order of the keys depends only on the seed; each key goes to the part that lacks
    most, counting both sources by their shares. Every part with a proportion above 0 gets a key if
    there are enough keys.

    Args:
        kept: key → the part that it has already; these come first, so that the other keys fill what
            they leave.

    Raises:
        LanguageError: the proportions are not three shares of a whole, or there are no items.
    """
    targets = _targets(proportions)
    if not items:
        raise LanguageError("there is nothing to split", hint="generate or import commands first")
    weights: dict[str, Counter[str]] = {}
    for item in items:
        weights.setdefault(item.key(criterion), Counter())[item.source] += 1
    keys = sorted(weights.keys() - kept.keys())
    Random(seed).shuffle(keys)
    keys = [*sorted(weights.keys() & kept.keys()), *keys]
    parts = _deal(keys, weights, targets, kept)
    return tuple(parts[item.key(criterion)] for item in items)


def _deal(
    keys: Sequence[str],
    weights: Mapping[str, Counter[str]],
    targets: Mapping[Part, float],
    kept: Mapping[str, Part],
) -> dict[str, Part]:
    """Return the part of each key, given in the order of ``keys``; ``weights`` are its items by source."""
    totals: Counter[str] = Counter()
    for weight in weights.values():
        totals += weight
    missing = {
        part: {source: share * total for source, total in totals.items()}
        for part, share in targets.items()
    }
    parts: dict[str, Part] = {}
    empty = [part for part, share in targets.items() if share > 0]
    for place, key in enumerate(keys):
        choices = empty if len(keys) - place <= len(empty) else list(targets)
        chosen = kept.get(key) or max(
            choices, key=lambda part: _need(missing[part], weights[key], totals)
        )
        parts[key] = chosen
        empty = [part for part in empty if part is not chosen]
        for source, count in weights[key].items():
            missing[chosen][source] -= count
    return parts


def content_hash(examples: Iterable[FrozenExample]) -> str:
    """Return the SHA-256 of the examples, in order, as 64 hexadecimal digits."""
    digest = hashlib.sha256()
    for example in examples:
        line = json.dumps(astuple(example), ensure_ascii=False, separators=(",", ":"))
        digest.update(line.encode("utf-8") + b"\n")
    return digest.hexdigest()


def _targets(proportions: Sequence[float]) -> dict[Part, float]:
    trouble = ""
    if len(proportions) != len(Part):
        trouble = f"a split has three shares, for {', '.join(Part)}, not {len(proportions)}"
    elif min(proportions) < 0:
        trouble = f"a share of {100 * min(proportions):g} % is below 0 %"
    elif abs(sum(proportions) - 1) > 1e-6:
        whole = f"{100 * sum(proportions):g} %"
        trouble = f"the three shares sum to {whole}; they have to sum to 100 %"
    if trouble:
        raise LanguageError(trouble, hint="such as 70, 10 and 20 %")
    return dict(zip(Part, proportions, strict=True))


def _need(
    missing: Mapping[str, float], weight: Mapping[str, int], totals: Mapping[str, int]
) -> float:
    """Return how much a part still lacks of the sources that a key brings, as shares of each source."""
    return sum(
        missing[source] / totals[source] * (count / totals[source])
        for source, count in weight.items()
    )

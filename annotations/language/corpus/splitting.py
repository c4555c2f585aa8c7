"""Split commands into train, validation and test, hash a split, and draw from its training part."""

from __future__ import annotations

import hashlib
import json
import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass
from enum import StrEnum
from random import Random
from types import MappingProxyType

from annotations.language.texts import LanguageError, Refusal

KNOWN_SHARE = 0.1  # of the source commands of the training part
KNOWN = "known"  # what the held-out pairs are called where parts are named
_GENERATED = "generated"


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
    """What decides which part an example goes to. ``source`` is ``generated``, ``paraphrased``, ``model`` or ``said``.

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
    targets = dict(zip(Part, proportions, strict=True))
    if not items:
        raise LanguageError("there is nothing to split", hint="generate or import commands first")
    weights: dict[str, Counter[str]] = {}
    for item in items:
        weights.setdefault(item.key(criterion), Counter())[item.source] += 1
    keys = sorted(weights.keys() - kept.keys())
    Random(seed).shuffle(keys)
    keys = [*sorted(weights.keys() & kept.keys()), *keys]
    # In the order of the keys, each goes to the part that lacks most.
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
            choices,
            key=lambda part: sum(
                missing[part][source] / totals[source] * (count / totals[source])
                for source, count in weights[key].items()
            ),
        )
        parts[key] = chosen
        empty = [part for part in empty if part is not chosen]
        for source, count in weights[key].items():
            missing[chosen][source] -= count
    return tuple(parts[item.key(criterion)] for item in items)


def content_hash(examples: Iterable[FrozenExample]) -> str:
    """Return the SHA-256 of the examples, in order, as 64 hexadecimal digits."""
    digest = hashlib.sha256()
    for example in examples:
        line = json.dumps(astuple(example), ensure_ascii=False, separators=(",", ":"))
        digest.update(line.encode("utf-8") + b"\n")
    return digest.hexdigest()


def draw_share(
    items: Sequence[SplitItem], criterion: Criterion, share: float, seed: int = 0
) -> tuple[bool, ...]:
    """Return for each item whether it belongs to the drawn ``share``, from 0 to 1, of ``items``.

    Items that the criterion keeps together are drawn together, such as all pairs of one logical form:
    half of the pairs then shows half of the forms. The order of the keys depends only on the items and
    the seed, and a share is the shortest beginning of it with at least so many items. So a smaller
    share is part of every larger one. Raises Refusal for a share that is not above 0 and up to 1.
    """
    if not 0 < share <= 1:
        said = f"The share {share:g} has to be above 0 and at most 1."
        raise Refusal(said, "share_out_of_range")
    counts = Counter(item.key(criterion) for item in items)
    keys = sorted(counts)
    Random(seed).shuffle(keys)
    wanted = math.ceil(share * len(items) - 1e-9)
    drawn: set[str] = set()
    taken = 0
    for key in keys:
        if taken >= wanted:
            break
        drawn.add(key)
        taken += counts[key]
    return tuple(item.key(criterion) in drawn for item in items)


def hold_out_known(
    items: Sequence[SplitItem], seed: str, share: float = KNOWN_SHARE
) -> tuple[bool, ...]:
    """Return for each training item whether it is held out to test forms that training has.

    By form, accuracy on new forms alone rewards a parser that takes every form for a new one. Generalised
    zero-shot learning therefore asks for known and new classes at once, and summarises both by their
    harmonic mean (Xian et al., Zero-shot learning: a comprehensive evaluation of the good, the bad and the
    ugly, IEEE TPAMI 2018).

    Whole source commands are held out, each with its paraphrases, in a random order that depends on the
    items and the ``seed`` alone. One is passed over where a form of its items would lose its last pair
    among the generated or among the paraphrased ones. A paraphrase of unknown origin stays in training,
    since its siblings cannot be told; where no paraphrase has a known one, its text stands for it.

    Args:
        seed: such as the hash of the split with the seed of the training.
        share: of the source commands, from 0 to 1.
    """
    is_told = any(item.source_command for item in items if item.source != _GENERATED)
    of_command: dict[str, list[int]] = defaultdict(list)  # source command → the places of its items
    for at, item in enumerate(items):
        if item.source == _GENERATED or item.source_command or not is_told:
            of_command[item.key(Criterion.SOURCE_COMMAND)].append(at)
    commands = sorted(of_command)
    Random(seed).shuffle(commands)
    left = Counter((item.source, item.logical_form) for item in items)
    wanted = max(1, math.floor(share * len(commands) + 1e-9)) if share else 0
    held_out: set[int] = set()
    for command in commands:
        if not wanted:
            break
        leaving = Counter((items[at].source, items[at].logical_form) for at in of_command[command])
        if all(left[form] > count for form, count in leaving.items()):
            left -= leaving
            held_out.update(of_command[command])
            wanted -= 1
    return tuple(at in held_out for at in range(len(items)))


def harmonic_mean(unseen: float, known: float) -> float:
    """Return the harmonic mean of the accuracies on new and on known forms, 0 where either is 0."""
    return 2 * unseen * known / (unseen + known) if unseen and known else 0.0

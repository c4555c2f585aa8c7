"""Hold out training pairs whose forms stay in training: what a parser has to know still.

By form, accuracy on new forms alone rewards a parser that takes every form for a new one. Generalised
zero-shot learning therefore asks for known and new classes at once, and summarises both by their
harmonic mean (Xian et al., Zero-shot learning: a comprehensive evaluation of the good, the bad and the
ugly, IEEE TPAMI 2018).
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from random import Random

from annotations.language.corpus.splitting import Criterion, SplitItem

KNOWN_SHARE = 0.1  # of the source commands of the training part
KNOWN = "known"  # what the held-out pairs are called where parts are named
_GENERATED = "generated"


def hold_out_known(
    items: Sequence[SplitItem], seed: str, share: float = KNOWN_SHARE
) -> tuple[bool, ...]:
    """Return for each training item whether it is held out, so that its form can be asked for.

    Whole source commands are held out, each with its paraphrases, in a random order that depends on the
    items and the ``seed`` alone. One is passed over where a form of its items would lose its last pair
    among the generated or among the paraphrased ones. A paraphrase of unknown origin stays in training,
    since its siblings cannot be told; where no paraphrase has a known one, its text stands for it.

    Args:
        seed: such as the hash of the split with the seed of the training.
        share: of the source commands, from 0 to 1.
    """
    of_command = _by_source_command(items)
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


def _by_source_command(items: Sequence[SplitItem]) -> dict[str, list[int]]:
    """Return source command → the places of its items."""
    places: dict[str, list[int]] = defaultdict(list)
    for at in _of_known_origin(items):
        places[items[at].key(Criterion.SOURCE_COMMAND)].append(at)
    return places


def _of_known_origin(items: Sequence[SplitItem]) -> Iterator[int]:
    is_told = any(item.source_command for item in items if item.source != _GENERATED)
    for at, item in enumerate(items):
        if item.source == _GENERATED or item.source_command or not is_told:
            yield at

"""Verb: audit the labels of a world."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.background.progress import UNWATCHED, Progress
from annotations.language.auditing import (
    Suspect,
    check_answers,
    check_commands,
    check_words,
    rank,
)
from annotations.models import World
from parser_service.audit.out_of_fold import AUDITORS, answer_out_of_fold
from parser_service.audit.pairs import command_forms, labelled_pairs
from parser_service.parsers.interface import Pair
from parser_service.parsers.registry import entry


@dataclass(frozen=True, slots=True)
class Audit:
    """How many pairs were looked at, and those to look at again, the most suspect first."""

    pairs: int
    suspects: tuple[Suspect, ...]


def audit_labels(
    world: World,
    parser: str = AUDITORS[0],
    folds: int = 5,
    seed: int = 0,
    progress: Progress = UNWATCHED,
) -> Audit:
    """Check the labels of ``world`` against their commands, ``parser`` and their words. Stores nothing.

    Raises ValueError, a sentence, where the parser cannot do this, or there are too few pairs, and what
    ``progress`` raises between utterances to stop it.
    """
    progress.report(0, "reading the pairs")
    forms = command_forms(world)
    commands = [Pair(text, form) for text, form in forms.items()]
    pairs = labelled_pairs(world, forms, progress.check)
    answers = answer_out_of_fold(pairs, parser, folds, seed, commands, progress)
    progress.report(1, "ranking the labels")
    findings = [
        *check_commands(pairs),
        *check_words(pairs),
        *check_answers(pairs, answers, entry(parser).title),
    ]
    return Audit(len(pairs), rank(findings))

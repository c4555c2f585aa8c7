"""Answers of a parser to pairs that it was not trained on."""

from __future__ import annotations

from collections.abc import Sequence

from annotations.background.progress import UNWATCHED, Progress
from annotations.language.corpus import LabelledPair, ScoredForm, assign_folds, source_key
from annotations.language.texts import Refusal
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.interface import Check, Observer, Pair
from parser_service.parsers.registry import entry, load_class, parsers

BEAM_WIDTH = 10
# Those that learn from pairs alone, in seconds and without torch.
AUDITORS = tuple(
    name
    for name, each in parsers().items()
    if each.queue == "quick" and Protocol.STRICT in each.protocols
)


def answer_out_of_fold(
    pairs: Sequence[LabelledPair],
    parser: str = AUDITORS[0],
    folds: int = 5,
    seed: int = 0,
    commands: Sequence[Pair] = (),
    progress: Progress = UNWATCHED,
) -> dict[str, list[ScoredForm]]:
    """Return the candidates of ``parser`` by the key of the pair, best first.

    Each pair is answered by a parser trained on the pairs of the other folds and on those of
    ``commands`` that no pair of its own fold rewrites. Pairs of one source command are in one fold.

    Raises Refusal where the parser cannot do this, or there are too few pairs, and what
    ``progress``, which is asked between utterances, raises to stop it.
    """
    if parser not in AUDITORS:
        title = entry(parser).title
        raise Refusal(
            f"{title} cannot be used for an audit; use {', '.join(AUDITORS)}.",
            "parser_cannot_audit",
        )
    fold_of = assign_folds(pairs, folds, seed)
    answers: dict[str, list[ScoredForm]] = {}
    for fold in range(folds):
        progress.report(fold / folds, f"fold {fold + 1} of {folds}")
        held_out = [pair for pair in pairs if fold_of[source_key(pair)] == fold]
        train = [
            Pair(pair.utterance, pair.form, "paraphrased")
            for pair in pairs
            if fold_of[source_key(pair)] != fold
        ]
        train += [
            command
            for command in commands
            if fold_of.get(source_key(LabelledPair("", command.utterance, command.form))) != fold
        ]
        trained = load_class(parser)(seed=seed)
        trained.fit(train, observe=_Checking(progress.check))
        utterances = [pair.utterance for pair in held_out]
        predicted = trained.predict(utterances, BEAM_WIDTH, progress.check)
        for pair, candidates in zip(held_out, predicted, strict=True):
            answers[pair.key] = [ScoredForm(each.form, each.score) for each in candidates]
    return answers


class _Checking(Observer):
    """Passes the check on to the training."""

    def __init__(self, check: Check) -> None:
        self._check = check

    def check(self) -> None:
        self._check()

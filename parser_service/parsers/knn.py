"""The nearest neighbour: the form of the training utterance that is closest in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from annotations.language.texts import Refusal
from parser_service.parsers.conditions import Protocol
from parser_service.parsers.hyperparameters.fields import hyperparameter, validate
from parser_service.parsers.interface import (
    TRAINING,
    Candidate,
    Check,
    Knowledge,
    Observer,
    Pair,
    ScoreKind,
    keep_going,
)
from parser_service.parsers.nearest_pairs import PairKeeper, WordOverlap

VALIDATION = "validation"  # the origin of a form that no training pair has


@dataclass(frozen=True)
class NearestNeighbourConfig:
    """How much an utterance and its neighbour have to share."""

    least_overlap: float = hyperparameter(
        0.0,
        "Share of common words (0 to 1) below which the parser gives no answer; 0: it always answers.",
        minimum=0.0,
        maximum=1.0,
    )

    def __post_init__(self) -> None:
        validate(self)


class NearestNeighbour(PairKeeper):
    """K = 1 under the Jaccard distance between sets of words (Walker et al. 2019, baselines).

    Ties: of several nearest utterances, the form that most of them have wins; of equally frequent
    forms, the first in alphabetical order. The order of the training pairs has no effect. Further
    candidates are the forms of the next nearest utterances, each form once. A form that no neighbour
    has is never answered.

    Neighbours are the training pairs. The paper adds the validation pairs before it scores the
    test part; ``for_test_part(validation)`` does that.
    """

    name = "knn"
    version = 1
    protocols = (Protocol.STRICT,)
    score_kind = ScoreKind.SIMILARITY
    Config = NearestNeighbourConfig

    def __init__(
        self,
        config: NearestNeighbourConfig | None = None,
        seed: int = 0,
        knowledge: Knowledge | None = None,
    ):
        super().__init__(config, seed, knowledge)
        self._pairs = []

    def fit(
        self,
        train: Sequence[Pair],
        validation: Sequence[Pair] = (),
        observe: Observer | None = None,
    ) -> None:
        """Store ``train``. Raises Refusal where it is empty."""
        if not train:
            raise Refusal(
                "There is no training pair, so there is no neighbour to answer with.",
                "no_training_pairs",
            )
        (observe or Observer()).check()
        self.keep([(pair.utterance, pair.form) for pair in train])

    def for_test_part(self, validation: Sequence[Pair]) -> NearestNeighbour:
        """Return a nearest neighbour among the training pairs and ``validation``."""
        other = NearestNeighbour(self.config, self.seed, self.knowledge)
        added = [(pair.utterance, pair.form) for pair in validation]
        other.keep(self._pairs + added, trained=len(self._pairs))
        return other

    def predict(
        self, utterances: Sequence[str], beam_width: int = 1, check: Check = keep_going
    ) -> list[list[Candidate]]:
        """Return the nearest forms; the score is the share of common words, 1 − distance. Its parts are
        that ``similarity`` and the number of ``neighbours`` with the form at this distance."""
        answers = []
        for utterance in utterances:
            check()
            overlap = self._overlap.with_all(utterance)  # [pairs]
            best = np.zeros(len(self._forms))  # [forms]
            np.maximum.at(best, self._form_of, overlap)
            at_best = self._form_of[overlap == best[self._form_of]]
            votes = np.bincount(at_best, minlength=len(self._forms))  # [forms]
            candidates = []
            for at in np.lexsort((np.arange(len(best)), -votes, -best))[:beam_width]:
                form, similarity = self._forms[at], float(best[at])
                if similarity >= self.config.least_overlap:
                    origin = TRAINING if form in self._trained_forms else VALIDATION
                    parts = {"similarity": similarity, "neighbours": int(votes[at])}
                    candidates.append(Candidate(form, similarity, origin, parts))
            answers.append(candidates)
        return answers

    def keep(self, pairs: list[tuple[str, str]], trained: int | None = None) -> None:
        """Keep ``pairs``. The first ``trained`` of them are training pairs; by default all."""
        self._pairs = pairs
        self._trained_forms = {form for _, form in pairs[:trained]}
        self._forms = sorted({form for _, form in pairs})
        number = {form: index for index, form in enumerate(self._forms)}
        self._overlap = WordOverlap(utterance for utterance, _ in pairs)
        self._form_of = np.array([number[form] for _, form in pairs])  # [pairs]

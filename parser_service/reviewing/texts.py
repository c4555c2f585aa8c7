"""What the utterances of a run say: the entities that they name, and their words as its training uses them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache

from annotations.language.english import ARTICLES
from annotations.language.forms import CLASS_TOKEN, head_predicate, predicates
from annotations.language.grounding import Anonymizer
from annotations.models.splits import Part
from annotations.rows.from_rows import ontology_of
from parser_service.analysis.categories import SpokenFor, WordUse
from parser_service.analysis.edits import words_of
from parser_service.analysis.reading import read_or_none
from parser_service.models import TrainingRun
from parser_service.reviewing.answers import ROWS_AT_ONCE, Answered


class Texts:
    """Reads utterances as the world of ``run`` and its training pairs know them.

    Args:
        utterances: those that will be asked about, as far as ``alike_labels`` goes.
    """

    def __init__(self, run: TrainingRun, utterances: Iterable[str]) -> None:
        ontology = ontology_of(run.world)
        self._has_names = bool(ontology.entities)
        self._anonymizer = Anonymizer(ontology)
        self._alike: dict[tuple[str, ...], set[str]] = {
            _without_articles(self._words(text)): set() for text in utterances
        }
        self._word_use = WordUse(self._training_pairs(run))

    def alike_labels(self, utterance: str) -> list[str]:
        """Return the labels of training texts that differ from this one by names and articles at most."""
        return sorted(self._alike.get(_without_articles(self._words(utterance)), ()))

    def named(self, utterance: str) -> tuple[str, ...] | None:
        """Return the class of each entity that the utterance names; None where the world has no entities."""
        if not self._has_names:
            return None
        classes = CLASS_TOKEN.findall(self._anonymize(utterance))
        return tuple(sorted(name.rstrip("0123456789") for name in classes))

    def spoken_for(self, answered: Answered) -> SpokenFor | None:
        """Return a word of the utterance that in training goes with the answer, not with the label."""
        if not self.has_trained(answered.label):
            return None  # of a label that training lacks its words say nothing
        label, answer = _predicates_of(answered.label), _predicates_of(answered.answer)
        return self._word_use.speaks_for(
            self._words(answered.utterance), answer - label, label - answer
        )

    def has_trained(self, label: str) -> bool:
        """Tell whether the training pairs have the label."""
        return self._word_use.knows(label)

    def is_familiar(self, answered: Answered) -> bool:
        """Tell whether the utterance is worded like training pairs with the head predicate of the answer."""
        form = read_or_none(answered.answer)
        head = head_predicate(form) if form is not None else ""
        return self._word_use.is_familiar(self._words(answered.utterance), head)

    def _words(self, utterance: str) -> tuple[str, ...]:
        return words_of(self._anonymize(utterance))

    def _anonymize(self, utterance: str) -> str:
        return self._anonymizer.anonymize(utterance).command

    def _training_pairs(self, run: TrainingRun) -> Iterator[tuple[tuple[str, ...], str]]:
        rows = run.split.examples.filter(part=Part.TRAIN).order_by()
        for text, label in rows.values_list("utterance", "logical_form").iterator(ROWS_AT_ONCE):
            words = self._words(text)
            alike = self._alike.get(_without_articles(words))
            if alike is not None:
                alike.add(label)
            yield words, label


def _without_articles(words: Iterable[str]) -> tuple[str, ...]:
    return tuple(word for word in words if word not in ARTICLES)


@lru_cache(maxsize=1 << 14)
def _predicates_of(form: str) -> frozenset[str]:
    read = read_or_none(form)
    return frozenset(predicates(read)) if read is not None else frozenset()

"""What the utterances of a run say: the entities that they name, and their words as its training uses them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

from annotations.language.corpus import Part
from annotations.language.forms import CLASS_TOKEN, head_predicate, predicates, read_or_none
from annotations.language.grounding import Anonymizer
from annotations.language.texts import ARTICLES
from annotations.rows.from_rows import ontology_of
from parser_service.analysis.mining import words_of
from parser_service.analysis.word_use import SpokenFor, WordUse
from parser_service.models import TrainingRun
from parser_service.reviews.first_answers import ROWS_AT_ONCE


@dataclass(frozen=True, slots=True)
class Said:
    """The words of an utterance, class tokens for the entities that it names, and the class of each of these;
    None where the world has no entities."""

    words: tuple[str, ...]
    named: tuple[str, ...] | None

    @property
    def key(self) -> tuple[str, ...]:
        """What texts share that differ by names and articles at most."""
        return tuple(word for word in self.words if word not in ARTICLES)


class RunTexts:
    """Reads utterances as the world of ``run`` and its training pairs know them.

    Args:
        utterances: those that will be asked about, as far as ``alike_labels`` goes.
    """

    def __init__(self, run: TrainingRun, utterances: Iterable[str]) -> None:
        ontology = ontology_of(run.world)
        self._has_names = bool(ontology.entities)
        self._anonymizer = Anonymizer(ontology)
        self._alike: dict[tuple[str, ...], set[str]] = {
            self.read(text).key: set() for text in utterances
        }
        self._word_use = WordUse(self._training_pairs(run))

    def read(self, utterance: str) -> Said:
        """Return what an utterance says."""
        command = self._anonymizer.anonymize(utterance).command
        classes = (name.rstrip("0123456789") for name in CLASS_TOKEN.findall(command))
        return Said(words_of(command), tuple(sorted(classes)) if self._has_names else None)

    def alike_labels(self, said: Said) -> list[str]:
        """Return the labels of training texts that differ from this one by names and articles at most."""
        return sorted(self._alike.get(said.key, ()))

    def has_trained(self, label: str) -> bool:
        """Tell whether the training pairs have the label."""
        return self._word_use.knows(label)

    def spoken_for(self, said: Said, label: str, answer: str) -> SpokenFor | None:
        """Return a word of the utterance that in training goes with the answer, not with the label. Of a label
        that training lacks its words say nothing."""
        if not self.has_trained(label):
            return None
        of_label, of_answer = _predicates_of(label), _predicates_of(answer)
        return self._word_use.speaks_for(said.words, of_answer - of_label, of_label - of_answer)

    def is_familiar(self, said: Said, answer: str) -> bool:
        """Tell whether the utterance is worded like training pairs with the head predicate of the answer."""
        return self._word_use.is_familiar(said.words, head_of(answer))

    def _training_pairs(self, run: TrainingRun) -> Iterator[tuple[tuple[str, ...], str]]:
        rows = run.split.examples.filter(part=Part.TRAIN).order_by()
        for text, label in rows.values_list("utterance", "logical_form").iterator(ROWS_AT_ONCE):
            said = self.read(text)
            alike = self._alike.get(said.key)
            if alike is not None:
                alike.add(label)
            yield said.words, label


@lru_cache(maxsize=1 << 14)
def _predicates_of(form: str) -> frozenset[str]:
    read = read_or_none(form)
    return frozenset(predicates(read)) if read is not None else frozenset()


@lru_cache(maxsize=1 << 14)
def head_of(form: str) -> str:
    """Return the head predicate of a form as text; empty for what is no form."""
    read = read_or_none(form)
    return head_predicate(read) if read is not None else ""

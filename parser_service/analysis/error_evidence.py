"""What a proposal may go by besides the two forms; the caller hands in what is known."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.language.forms import Form
from parser_service.analysis.word_use import SpokenFor


@dataclass(frozen=True, slots=True)
class RunEvidence:
    """What holds for all errors of a run.

    ``predicates`` and ``entity_classes`` are those of the world, None where they are not known.
    ``attractors`` are canonical texts of the forms that attract unlike inputs (``attractors``).
    """

    predicates: frozenset[str] | None = None
    entity_classes: frozenset[str] | None = None
    attractors: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Neighbour:
    """An utterance one edit away: its label, and the answer of the same run to it (None: no form)."""

    utterance: str
    gold: Form
    answer: Form | None


@dataclass(frozen=True, slots=True)
class LabelDoubt:
    """A doubt about the label, as a sentence, and the form that the audit suggests, if it does.

    It ``is_sure`` where a person or the very words of the utterance say so.
    """

    sentence: str
    suggested: Form | None = None
    is_sure: bool = False


@dataclass(frozen=True, slots=True)
class ErrorEvidence:
    """What is known of one error.

    ``other_golds`` are further labels of the very same text, ``alike_golds`` those of training texts that
    differ by nothing but the names and articles. ``named`` are the classes of the entities that
    the utterance names, each as often as it does, None where that is not known. ``spoken_for`` is a word
    of it that in training goes with the answer, not with the label; ``agreeing`` are other parsers that
    give the same answer although training has the label. ``is_familiar``: the utterance is worded as those
    whose label has the head predicate of the answer.
    """

    neighbours: tuple[Neighbour, ...] = ()
    other_golds: tuple[Form, ...] = ()
    alike_golds: tuple[Form, ...] = ()
    audit: LabelDoubt | None = None
    named: tuple[str, ...] | None = None
    spoken_for: SpokenFor | None = None
    agreeing: tuple[str, ...] = ()
    is_familiar: bool = False

    @property
    def is_of_this_text(self) -> bool:
        """Whether there is evidence that hardly another error has: other forms, or a doubt."""
        return bool(self.neighbours or self.other_golds or self.alike_golds or self.audit)


NOTHING_MORE = ErrorEvidence()

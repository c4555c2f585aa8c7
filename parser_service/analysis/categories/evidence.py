"""What a proposal may go by besides the two forms; the caller hands in what is known."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.language.forms import Form


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
class Audit:
    """A doubt about the label, as a sentence, and the form that the audit suggests, if it does."""

    sentence: str
    suggested: Form | None = None


@dataclass(frozen=True, slots=True)
class ErrorEvidence:
    """What is known of one error. ``other_golds`` are further labels of the very same text."""

    neighbours: tuple[Neighbour, ...] = ()
    other_golds: tuple[Form, ...] = ()
    audit: Audit | None = None


NOTHING_MORE = ErrorEvidence()

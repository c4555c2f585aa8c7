"""What an audit says about a label, and which labels to look at first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

WEAK = 0.2  # a finding with this score or less is no further reason


class Reason(StrEnum):
    """What a label disagrees with, the one whose suggestion is most often right first."""

    COMMAND = "command"
    WORD = "word"
    PARSER = "parser"


@dataclass(frozen=True, slots=True)
class LabelledPair:
    """An utterance and its label, with class tokens or without.

    ``key`` tells the pairs of one audit apart. ``form`` is canonical corpus text. ``source_command`` is the
    command that the utterance rewrites and ``command_form`` the canonical form of that command; each
    is empty where it is not known.
    """

    key: str
    utterance: str
    form: str
    source_command: str = ""
    command_form: str = ""


@dataclass(frozen=True, slots=True)
class Finding:
    """One reason to doubt the label of ``pair``. ``score`` is how strong it is, above 0 and up to 1."""

    pair: LabelledPair
    reason: Reason
    sentence: str
    suggested_form: str
    score: float


@dataclass(frozen=True, slots=True)
class Suspect:
    """A pair and everything that speaks against its label, in the order of ``Reason``."""

    pair: LabelledPair
    findings: tuple[Finding, ...]

    @property
    def reasons(self) -> frozenset[Reason]:
        return frozenset(finding.reason for finding in self.findings)

    @property
    def best_scores(self) -> dict[Reason, float]:
        """Reason → the score of its strongest finding, in the order of ``Reason``."""
        return {
            reason: max(each.score for each in self.findings if each.reason is reason)
            for reason in Reason
            if reason in self.reasons
        }

    @property
    def score(self) -> float:
        """The sum of the best score of each reason."""
        return sum(self.best_scores.values())

    @property
    def strong_reasons(self) -> int:
        """How many reasons have a finding that is not weak."""
        return sum(score > WEAK for score in self.best_scores.values())

    @property
    def suggested_form(self) -> str:
        """The form that most findings suggest; of several such forms, that of the first finding."""
        forms = [finding.suggested_form for finding in self.findings]
        return max(forms, key=forms.count)


def rank(findings: Iterable[Finding]) -> tuple[Suspect, ...]:
    """Return one suspect per pair: several strong reasons first, then the higher score, then the key."""
    by_pair: dict[LabelledPair, list[Finding]] = defaultdict(list)
    for finding in findings:
        by_pair[finding.pair].append(finding)
    suspects = [
        Suspect(pair, tuple(sorted(some, key=lambda each: (_ORDER[each.reason], -each.score))))
        for pair, some in by_pair.items()
    ]
    return tuple(
        sorted(suspects, key=lambda each: (-each.strong_reasons, -each.score, each.pair.key))
    )


_ORDER = {reason: place for place, reason in enumerate(Reason)}

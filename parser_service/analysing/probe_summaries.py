"""What a run answers to its probes, by kind, as pages show it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from parser_service.analysing.asking import is_refusal
from parser_service.analysis.probing import ProbeKind
from parser_service.models import Probe, TrainingRun

# What each kind of probe is, and what its answers show.
EXPLANATIONS = {
    ProbeKind.EMPTY: "no text, or no word in it: only UNKNOWN is right",
    ProbeKind.SHUFFLED: "the words of an utterance in random order",
    ProbeKind.TRUNCATED: "the beginning of an utterance",
    ProbeKind.UNRELATED: "sentences that are no commands: only UNKNOWN is right",
}


@dataclass(frozen=True, slots=True)
class ProbeSummary:
    """How a run answers the ``count`` probes of one kind: ``answered`` get a form, the others UNKNOWN or none.

    ``commonest`` is the most common form among the answers, empty where there is none, and has
    ``commonest_count`` of them.
    """

    kind: str
    explanation: str
    count: int
    answered: int
    commonest: str
    commonest_count: int

    @property
    def share(self) -> float:
        """The share that gets a form, of 1."""
        return self.answered / self.count


def summaries_of(run: TrainingRun) -> list[ProbeSummary]:
    """Return a row for each kind of probe that was answered, those of the paper left out."""
    rows = run.probes.filter(kind__in=list(EXPLANATIONS), answer__isnull=False)
    answers: dict[str, list[str]] = defaultdict(list)
    for kind, form in rows.order_by("position").values_list("kind", "answer__logical_form"):
        answers[kind].append(form)
    return [_summarize(str(kind), answers[kind]) for kind in EXPLANATIONS if answers[kind]]


def paper_probes(run: TrainingRun) -> list[Probe]:
    """Return the six texts of the paper with the answers of the run; empty before it was asked."""
    rows = run.probes.filter(kind=ProbeKind.PAPER, answer__isnull=False)
    return list(rows.select_related("answer").order_by("position"))


def _summarize(kind: str, answers: Iterable[str]) -> ProbeSummary:
    forms = list(answers)
    given = Counter(form for form in forms if not is_refusal(form))
    commonest, count = given.most_common(1)[0] if given else ("", 0)
    return ProbeSummary(
        kind, EXPLANATIONS[ProbeKind(kind)], len(forms), given.total(), commonest, count
    )

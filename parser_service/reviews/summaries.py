"""What a run answers to its probes, by kind, as pages show it."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from parser_service.analysis.probe_texts import PAPER_PROBES, ProbeKind
from parser_service.models import ProbeAnswer, RunAnalysis, TrainingRun
from parser_service.reviews.probe_answers import is_refusal

# What each kind of probe is, and what its answers show.
EXPLANATIONS = {
    ProbeKind.EMPTY: "no text, or no word in it: only UNKNOWN is right",
    ProbeKind.SHUFFLED: "the words of an utterance in random order",
    ProbeKind.TRUNCATED: "the beginning of an utterance",
    ProbeKind.UNRELATED: "sentences that are no commands: only UNKNOWN is right",
}

MOST_BESIDE = 3  # runs beside the one that a page is about


@dataclass(frozen=True, slots=True)
class PaperText:
    """A text of the paper with each run and its answer, None where the run was not asked it."""

    text: str
    answers: tuple[tuple[TrainingRun, ProbeAnswer | None], ...]


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
    summaries = []
    for kind, explanation in EXPLANATIONS.items():
        if forms := answers[kind]:
            given = Counter(form for form in forms if not is_refusal(form))
            commonest, count = given.most_common(1)[0] if given else ("", 0)
            summaries.append(
                ProbeSummary(str(kind), explanation, len(forms), given.total(), commonest, count)
            )
    return summaries


def paper_texts(runs: Sequence[TrainingRun]) -> list[PaperText]:
    """Return the six texts of the paper with the answers of ``runs``; empty where none was asked."""
    rows = ProbeAnswer.objects.filter(probe__run__in=runs, probe__kind=ProbeKind.PAPER)
    given = {
        (each.probe.utterance, each.probe.run_id): each
        for each in rows.select_related("probe").order_by("pk")
    }
    if not given:
        return []
    return [
        PaperText(probe.text, tuple((run, given.get((probe.text, run.pk))) for run in runs))
        for probe in PAPER_PROBES
    ]


def runs_beside(run: TrainingRun) -> list[TrainingRun]:
    """Return the newest run of each other parser on the split of ``run`` that was asked its probes."""
    analysed = RunAnalysis.objects.filter(run__split=run.split_id).values("run")
    others = run.world.runs.filter(pk__in=analysed).exclude(parser=run.parser).on_all_pairs()
    newest: dict[str, TrainingRun] = {}
    for each in others.order_by("-pk"):
        newest.setdefault(each.parser, each)
    return list(newest.values())[:MOST_BESIDE]

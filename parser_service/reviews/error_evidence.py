"""Gathers what is known of the errors of a run beside the two forms."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np
from django.db.models import Count

from annotations.language.corpus import LabelledPair, check_words
from annotations.language.forms import CLASS_TOKEN, read_form, read_or_none
from annotations.models import Entity, Example, FindingStatus, Split, World
from annotations.models.background import Status
from parser_service.analysis.error_evidence import ErrorEvidence, LabelDoubt, Neighbour, RunEvidence
from parser_service.analysis.mining import mine_pairs, words_of
from parser_service.models import TrainingRun
from parser_service.reviews.first_answers import FirstAnswer
from parser_service.reviews.utterance_texts import RunTexts, head_of

PREDICATE = re.compile(r"\( ([^\s()\"]+) ")  # in canonical corpus text
ROWS_AT_ONCE = 500
MOST_NEIGHBOURS = 4  # the tree distance to each costs time
DECIDED = {
    FindingStatus.CORRECTED: "Somebody has corrected this label since the split was frozen.",
    FindingStatus.EXCLUDED: "Somebody has excluded this pair from new splits.",
}


def evidence_of_run(run: TrainingRun, attractors: frozenset[str]) -> RunEvidence:
    """Return what holds for all errors of ``run``; ``attractors`` are canonical texts of forms.

    The predicates of a world are those that it declares and those of its training labels; its classes are
    those of its entities and, again, of those labels.
    """
    declared = frozenset(run.world.predicates.values_list("name", flat=True))
    entities = Entity.objects.filter(ontology__world=run.world_id).order_by()
    classes = frozenset(entities.values_list("entity_class", flat=True).distinct())
    used: set[str] = set()
    named: set[str] = set()
    if declared or classes:
        training = run.split.examples.filter(part="train").order_by()
        for text in training.values_list("logical_form", flat=True).distinct().iterator():
            used.update(PREDICATE.findall(text))
            named.update(name.rstrip("0123456789") for name in CLASS_TOKEN.findall(text))
    return RunEvidence(
        declared | used if declared else None, classes | named if classes else None, attractors
    )


class ErrorEvidences:
    """What is known of each answer of one run."""

    def __init__(self, run: TrainingRun, answers: Sequence[FirstAnswer]) -> None:
        self._answers = answers
        self._audits: dict[tuple[str, str], LabelDoubt | None] = dict(_read_audits(run.world))
        self._labels = _ambiguous_labels(run.split)
        self._neighbours = _Neighbours(answers)
        self._texts = RunTexts(run, (each.utterance for each in answers if not each.is_right))
        self._others = list(_read_others(run))

    def of(self, at: int) -> ErrorEvidence:
        """Return what is known of the answer number ``at``."""
        answered = self._answers[at]
        utterance = self._texts.read(answered.utterance)
        labels = self._labels.get(answered.utterance, ())
        agreeing: tuple[str, ...] = ()
        if self._texts.has_trained(answered.label):
            at_example, answer = answered.example, answered.answer
            agreeing = tuple(
                name for name, wrong in self._others if wrong.get(at_example) == answer
            )
        return ErrorEvidence(
            neighbours=tuple(self._neighbours.of(at)),
            other_golds=tuple(read_form(text) for text in labels if text != answered.label),
            alike_golds=tuple(map(read_form, self._texts.alike_labels(utterance))),
            audit=self._doubt_about(answered),
            named=utterance.named,
            spoken_for=self._texts.spoken_for(utterance, answered.label, answered.answer),
            agreeing=agreeing,
            is_familiar=self._texts.is_familiar(utterance, answered.answer),
        )

    def _doubt_about(self, answered: FirstAnswer) -> LabelDoubt | None:
        """Return what an audit or a person says against the label, otherwise what its own words say."""
        pair = answered.utterance, answered.label
        if pair not in self._audits:
            finding = next(check_words([LabelledPair("", *pair)]), None)
            self._audits[pair] = (
                LabelDoubt(
                    f"The label may be wrong. {finding.sentence}",
                    read_or_none(finding.suggested_form),
                    is_sure=True,
                )
                if finding
                else None
            )
        return self._audits[pair]


def _read_others(run: TrainingRun) -> Iterator[tuple[str, dict[int, str]]]:
    """Yield the name of each other parser with the wrong answers of its newest run on the same split, by the
    key of the example."""
    runs = run.split.runs.filter(status=Status.SUCCEEDED, train_share=1).exclude(parser=run.parser)
    newest = {each.parser: each for each in runs.order_by("pk")}
    texts: dict[str, str] = {}
    for name, each in sorted(newest.items()):
        rows = each.predictions.best().filter(is_exact_match=False, is_well_formed=True).order_by()
        answers = rows.values_list("example_id", "logical_form").iterator(ROWS_AT_ONCE)
        yield name, {key: texts.setdefault(answer, answer) for key, answer in answers}


def _read_audits(world: World) -> Iterator[tuple[tuple[str, str], LabelDoubt | None]]:
    """Yield text and label of each audited pair, and the doubt: None where somebody has kept the label. What
    people have decided comes last.

    A pair stands in a split as it was said, or with class tokens.
    """
    findings = world.audit_findings.prefetch_related("reasons")
    for row in findings.open().iterator(ROWS_AT_ONCE):
        sentences = " ".join(reason.sentence for reason in row.reasons.all())
        suggested = read_or_none(row.suggested_form)
        audit = LabelDoubt(f"The label audit doubts the label: {sentences}", suggested)
        for text in {row.text, row.anonymized_text}:
            yield (text, row.form), audit
    for row in findings.decided().iterator(ROWS_AT_ONCE):
        decision = None
        if row.status != FindingStatus.KEPT:
            decided = read_or_none(row.decided_form)
            decision = LabelDoubt(DECIDED[FindingStatus(row.status)], decided, is_sure=True)
        for text in {row.text, row.anonymized_text}:
            yield (text, row.form), decision


def _ambiguous_labels(split: Split) -> dict[str, list[str]]:
    """Return the labels of each text of ``split`` that has several."""
    texts = split.examples.order_by().values("utterance")
    several = texts.annotate(labels=Count("logical_form", distinct=True)).filter(labels__gt=1)
    rows = Example.objects.filter(split=split, utterance__in=several.values("utterance"))
    labels = defaultdict(list)
    for text, label in rows.order_by().values_list("utterance", "logical_form").distinct():
        labels[text].append(label)
    return {text: sorted(forms) for text, forms in labels.items()}


class _Neighbours:
    """The answers to utterances one edit away from those of the run."""

    def __init__(self, answers: Sequence[FirstAnswer]) -> None:
        self._answers = answers
        numbers: dict[tuple[str, ...], int] = {}
        self._number_of = [
            numbers.setdefault(words_of(each.utterance), len(numbers)) for each in answers
        ]
        first_of = dict(zip(reversed(self._number_of), reversed(range(len(answers))), strict=True))
        self._first_of = [first_of[number] for number in range(len(numbers))]
        pairs = mine_pairs([answers[at].utterance for at in self._first_of])
        both_ways = np.concatenate((pairs.first, pairs.second))
        order = np.argsort(both_ways, kind="stable")
        self._others = np.concatenate((pairs.second, pairs.first))[order]
        self._starts = np.searchsorted(both_ways[order], np.arange(len(numbers) + 1))

    def of(self, at: int) -> Iterator[Neighbour]:
        """Yield the neighbours that could explain the answer number ``at``: their label has the same head
        predicate, their answer another one. Each label and answer comes once."""
        answered, number = self._answers[at], self._number_of[at]
        heads = head_of(answered.label), head_of(answered.answer)
        seen: set[tuple[str, str]] = set()
        for other in self._others[self._starts[number] : self._starts[number + 1]]:
            near = self._answers[self._first_of[other]]
            is_like = head_of(near.label) == heads[0] and head_of(near.answer) not in ("", heads[1])
            if not is_like or (near.label, near.answer) in seen:
                continue
            seen.add((near.label, near.answer))
            yield Neighbour(near.utterance, read_form(near.label), read_or_none(near.answer))
            if len(seen) == MOST_NEIGHBOURS:
                return

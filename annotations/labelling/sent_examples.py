"""Verb: send examples of splits back to people, as the rows that they were copied from.

A split never changes. What is sent is the paraphrase or utterance behind an example, or the template
behind a generated one; where there is none, its text becomes a new utterance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from django.db import transaction
from django.db.models import QuerySet

from annotations.labelling.collecting import collect, read_text
from annotations.labelling.enqueuing import ItemSubject, WantedItem, enqueue
from annotations.language.texts import Position, Refusal, normalise_line, say_count
from annotations.models import Example, Origin, Paraphrase, User, Utterance, WorkKind, World
from annotations.models.corpus import ParaphraseStatus
from annotations.models.splits import Source
from annotations.rows.synchronise import BATCH, batches

MOST_SENT = 1_000  # different utterances of one request
MOST_READ = 20 * MOST_SENT  # examples among which these are looked for

Behind = Mapping[str, ItemSubject]


@dataclass(frozen=True, slots=True)
class SentExamples:
    """What became of examples: ``utterances`` different texts, about ``subjects`` rows, of which ``queued``
    are in the queue now and were not before; ``left_out`` texts cannot be utterances."""

    utterances: int = 0
    subjects: int = 0
    queued: int = 0
    left_out: int = 0

    @property
    def sentence(self) -> str:
        waiting = self.subjects - self.queued
        parts = [f"{say_count(self.queued, 'item')} added to the work queue"]
        if self.subjects < self.utterances - self.left_out:
            said = say_count(self.utterances - self.left_out, "utterance")
            parts[0] += f" for {said}, some of which share a template"
        if waiting:
            parts.append(f"{waiting:,} {'was' if waiting == 1 else 'were'} there already")
        if self.left_out:
            parts.append(f"{self.left_out:,} cannot be an utterance, being empty or too long")
        return "; ".join(parts) + "."


def send_examples(world: World, examples: Iterable[Example], reason: str, by: User) -> SentExamples:
    """Ask annotators to look at what is behind ``examples``, each text once.

    Args:
        reason: what is to be looked at, as people read it in the queue.

    Raises Refusal where there are more than ``MOST_SENT`` different texts.
    """
    texts: dict[str, Example] = {}
    rows = examples.iterator(chunk_size=BATCH) if isinstance(examples, QuerySet) else examples
    for number, example in enumerate(rows):
        texts.setdefault(example.utterance, example)
        if len(texts) > MOST_SENT or number >= MOST_READ:
            raise Refusal(
                f"These are more than {MOST_SENT:,} different utterances, which is more than people look "
                "at. Narrow the list with its filters, then send it.",
                "nothing_to_send",
            )
    with transaction.atomic():
        subjects = find_subjects(world, texts.values())
        missing = [text for text in texts if text not in subjects]
        read = ((text, *read_text(text, Position())) for text in missing)
        possible = [text for text, said, problem in read if said and problem is None]
        collected: list[Utterance] = []
        if possible:
            collect(world, possible, Origin.REVIEW, by)
            for some in batches(sorted(set(map(normalise_line, possible))), BATCH):
                collected += world.utterances.filter(text__in=some)
        behind = {(type(row), row.pk): row for row in (*subjects.values(), *collected)}
        wanted = [WantedItem(row, f"{by} asks: {reason}") for row in behind.values()]
        queued = enqueue(world, WorkKind.REQUESTED, wanted, by)
    return SentExamples(len(texts), len(behind), queued, len(missing) - len(possible))


def subject_of_example(example: Example) -> ItemSubject | None:
    """Return the row that ``example`` would be sent as; None where a new utterance would be made."""
    return find_subjects(example.split.world, [example]).get(example.utterance)


def find_subjects(world: World, examples: Iterable[Example]) -> dict[str, ItemSubject]:
    """Return text → the row behind the example with this text, for those that have one."""
    by_text = {example.utterance: example for example in examples}
    subjects: dict[str, ItemSubject] = {}
    for find in FINDERS:
        for some in batches([text for text in by_text if text not in subjects], BATCH):
            subjects.update(find(world, {text: by_text[text] for text in some}))
    return subjects


def _paraphrases(world: World, examples: Mapping[str, Example]) -> Behind:
    """Prefer paraphrases with the label of the example, then accepted ones."""
    texts = [text for text, each in examples.items() if each.source != Source.GENERATED]
    rows = world.paraphrases.filter(utterance__in=texts).order_by("position")
    best: dict[str, Paraphrase] = {}

    def fit(row: Paraphrase) -> tuple[bool, bool]:
        is_same = row.logical_form == examples[row.utterance].logical_form
        return is_same, row.status == ParaphraseStatus.ACCEPTED

    for row in rows:
        known = best.get(row.utterance)
        if known is None or fit(row) > fit(known):
            best[row.utterance] = row
    return best


def _templates(world: World, examples: Mapping[str, Example]) -> Behind:
    texts = [text for text, each in examples.items() if each.source == Source.GENERATED]
    commands = world.commands.filter(anonymized_text__in=texts, template__isnull=False)
    return {
        row.anonymized_text: row.template
        for row in commands.select_related("template")
        if row.template is not None
    }


def _utterances(world: World, examples: Mapping[str, Example]) -> Behind:
    by_text = {normalise_line(text): text for text in examples}
    return {by_text[row.text]: row for row in world.utterances.filter(text__in=by_text)}


FINDERS: tuple[Callable[[World, Mapping[str, Example]], Behind], ...] = (
    _paraphrases,
    _templates,
    _utterances,
)

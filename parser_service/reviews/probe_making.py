"""Make the probes of a run, once: the texts of ``probe_texts``, edits of utterances, and removals of words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from random import Random

from annotations.background.progress import Progress
from annotations.language.forms import UNKNOWN, canonical_text, read_form
from annotations.language.texts import LanguageError
from annotations.models import Example, World
from annotations.rows.from_rows import ontology_of, predicates_of, task_categories
from annotations.rows.staging import Staging
from parser_service.analysis.all_edits import generate_edits
from parser_service.analysis.facts import WorldFacts, gather_facts
from parser_service.analysis.intervals import SEED
from parser_service.analysis.mining import words_of
from parser_service.analysis.probe_texts import make_probes
from parser_service.analysis.sensitivity import remove_words
from parser_service.models import Expectation, Probe, TrainingRun
from parser_service.reviews.probe_kinds import REMOVAL
from parser_service.reviews.target import Target

MOST_EDITED = 200  # utterances, one edit of each kind
MOST_OF_A_KIND = 40  # shuffled, truncated and unrelated texts
MOST_SHORTENED = 60  # utterances, which lose each of their words in turn
MOST_COMMANDS = 5_000  # generated ones that say what a change of words does to the form
_COLUMNS = tuple(
    field.column for field in Probe._meta.concrete_fields if field.column and not field.primary_key
)


def probe_findings(target: Target, progress: Progress) -> dict[str, int]:
    """Store the probes of the run unless it has some. Returns how many there are of each kind."""
    run = target.run
    if not run.probes.exists():
        examples = run.split.examples.filter(part=target.part).order_by("pk")
        keys = list(examples.values_list("pk", flat=True))
        chosen = Random(SEED).sample(keys, min(MOST_EDITED, len(keys)))
        rows_of_keys = Example.objects.in_bulk(chosen)
        bases = [rows_of_keys[key] for key in chosen]  # in random order
        progress.report(0, "learning from the grammar what an edit changes")
        facts = facts_of(run.world)
        rows = list(chain(_texts(bases), _edits(bases, facts, progress), _removals(bases)))
        for position, row in enumerate(rows):
            row.run, row.position = run, position
        with Staging(Probe, _COLUMNS) as staging:
            staging.add_new(rows, progress)
            with progress.writing():
                TrainingRun.objects.select_for_update().get(pk=run.pk)  # one of two jobs waits
                if not run.probes.exists():
                    staging.insert()
    kinds = run.probes.order_by().values_list("kind", flat=True)
    return {kind: kinds.filter(kind=kind).count() for kind in sorted(set(kinds))}


def facts_of(world: World) -> WorldFacts:
    """Return what the ontology, the grammar and the first generated commands say about edits.

    Without a grammar that can be read and expanded, they say less.
    """
    commands = world.commands.select_related("logical_form").order_by("position")
    pairs = [
        (command.anonymized_text, read_form(command.logical_form.text))
        for command in commands[:MOST_COMMANDS]
    ]
    ontology, predicates = ontology_of(world), predicates_of(world)
    try:
        grammars = [category.grammar for category in task_categories(world)]
        return gather_facts(ontology, grammars, pairs, predicates)
    except LanguageError:
        return gather_facts(ontology, [], pairs, predicates)


def _texts(bases: Sequence[Example]) -> Iterator[Probe]:
    for probe in make_probes([base.utterance for base in bases], MOST_OF_A_KIND, SEED):
        is_unknown = probe.expects_unknown
        yield Probe(
            kind=probe.kind,
            base=None if probe.base is None else bases[probe.base],
            utterance=probe.text,
            expectation=Expectation.UNKNOWN if is_unknown else Expectation.OPEN,
            expected_form=canonical_text(UNKNOWN) if is_unknown else "",
        )


def _edits(bases: Sequence[Example], facts: WorldFacts, progress: Progress) -> Iterator[Probe]:
    for place, base in enumerate(bases):
        progress.report(place / len(bases), "editing utterances")
        form = read_form(base.logical_form)
        if form == UNKNOWN:
            continue
        for edit in generate_edits(base.utterance, form, facts, SEED):
            yield Probe(
                kind=edit.kind,
                base=base,
                utterance=edit.text,
                old=edit.old,
                new=edit.new,
                expectation=Expectation.SAME if edit.kind.keeps_meaning else Expectation.CHANGED,
                expected_form=canonical_text(edit.form),
            )


def _removals(bases: Sequence[Example]) -> Iterator[Probe]:
    shortened = bases[:MOST_SHORTENED]
    removals = remove_words([base.utterance for base in shortened])
    for text, place, word in zip(removals.texts, removals.bases, removals.words, strict=True):
        yield Probe(
            kind=REMOVAL,
            base=shortened[int(place)],
            utterance=text,
            old=" ".join(words_of(word)) or word,  # without its punctuation
            expectation=Expectation.OPEN,
        )

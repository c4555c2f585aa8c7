"""The candidate forms that a protocol allows, from all steps together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice

from annotations.language.grounding import Anonymizer
from annotations.language.templates import TaskCategory, generate
from annotations.language.world import infer_signatures
from parser_service.parsers.closure import close, read_forms
from parser_service.parsers.geca import geca
from parser_service.parsers.interface import Check, Knowledge, Pair, keep_going
from parser_service.parsers.pool import SURE, CandidateForm, Pool, WayToForm
from parser_service.parsers.spreading import spread
from parser_service.parsers.unseen import substitute, unseen

GRAMMAR = "grammar"  # the name of the step that takes the forms of a grammar
MOST_CANDIDATES = 800
MOST_PAIRS = 20_000  # that recombination looks at
MOST_GRAMMAR_FORMS = 10_000  # all of them are real


@dataclass(frozen=True, slots=True)
class GeneratedForms:
    """The forms of the training pairs, and new ones made from them or from what is known.

    ``counts`` is the number of forms by the step that made them, unlikely ones included; ``commands``
    are those of the grammar by form.
    """

    training: tuple[str, ...]
    new: tuple[CandidateForm, ...] = ()
    counts: Mapping[str, int] = field(default_factory=dict)
    commands: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def __str__(self) -> str:
        made = ", ".join(f"{step} {count:,}" for step, count in self.counts.items())
        return (
            f"{len(self.training)} forms of the training pairs and {len(self.new)} new ones to "
            f"choose from; forms made by step: {made or 'none'}."
        )


def generate_candidates(
    pairs: Sequence[Pair],
    knowledge: Knowledge,
    is_open: bool = True,
    check: Check = keep_going,
) -> GeneratedForms:
    """Return the forms that a parser trained on ``pairs`` chooses from: those of the pairs alone unless
    ``is_open``.

    *strict* infers signatures from the forms of the pairs. *domain* uses the declared ones, and so
    reaches predicates that no pair has. *grammar* takes all forms of its templates and makes no
    others. Forms that only one kind of change arrives at are left out. ``check`` is called now and then.
    """
    training = _forms(pairs)
    if not is_open:
        return GeneratedForms(training)
    pool = reach(pairs, knowledge, check)
    candidates = list(pool.candidates())
    known = set(training)
    is_grammar = knowledge.grammar is not None
    likely = (each for each in candidates if each.form not in known and each.support >= SURE)
    new = tuple(islice(likely, MOST_GRAMMAR_FORMS if is_grammar else MOST_CANDIDATES))
    named = known.union(each.form for each in new)
    commands = {each.form: each.commands for each in candidates if each.form in named}
    return GeneratedForms(training, new, pool.counts(), commands if is_grammar else {})


def _forms(pairs: Sequence[Pair]) -> tuple[str, ...]:
    return tuple(sorted({pair.form for pair in pairs}))


def reach(pairs: Sequence[Pair], knowledge: Knowledge, check: Check = keep_going) -> Pool:
    """Return all forms that the steps arrive at, unlikely ones and those of ``pairs`` included."""
    pool = Pool()
    if knowledge.grammar is not None:
        pool.add(grammar_forms(knowledge.grammar))
        return pool
    training = _forms(pairs)
    some = spread(pairs, MOST_PAIRS, lambda pair: pair.form)
    if knowledge.ontology is not None:
        # With class tokens for known entities, more commands differ in one thing only.
        anonymizer = Anonymizer(knowledge.ontology)
        anonymized = []
        for pair in some:
            check()
            command = anonymizer.anonymize(pair.utterance).command
            anonymized.append(replace(pair, utterance=command))
        some = anonymized
    pool.add(geca(some, check))
    if knowledge.predicates is None:
        pool.add(close(training, infer_signatures(read_forms(training)), check=check))
        return pool
    pool.add(close(training, knowledge.predicates, check=check))
    pool.add(substitute(training, knowledge.predicates, check))
    pool.add(unseen(training, knowledge.predicates, check))
    return pool


def grammar_forms(categories: Sequence[TaskCategory]) -> list[WayToForm]:
    """Return each form that the templates make, with its commands. Raises LanguageError as generation does."""
    commands: defaultdict[str, list[str]] = defaultdict(list)
    first: dict[str, str] = {}
    for expansion in generate(categories).expansions:
        commands[expansion.form_text].append(expansion.command)
        first.setdefault(
            expansion.form_text,
            f"template {expansion.template_index + 1} of {expansion.task_category}",
        )
    return [
        WayToForm(form, GRAMMAR, change=first[form], commands=tuple(said), weight=SURE)
        for form, said in commands.items()
    ]

"""Verb: store the world that lines propose, and the lines themselves as utterances; all of it or nothing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from django.core.exceptions import ValidationError
from django.db import transaction
from django.utils import timezone

from annotations import models
from annotations.editing.edits import add_all, change_many
from annotations.editing.once_keys import made_before, remember
from annotations.labelling.collecting import collect
from annotations.labelling.entity_spans import anonymizer_of
from annotations.labelling.taking_back import reason_of
from annotations.labelling.upload_reading import UploadFormat
from annotations.language.corpus import require_entity_name, require_predicate
from annotations.language.forms import (
    MOST_CLASSES,
    SEQUENCE,
    Application,
    canonical_text,
    read_form,
)
from annotations.language.grammar import CHECK_STEPS, Budget, Production, read_production
from annotations.language.grounding import Anonymizer
from annotations.language.induction import (
    CATEGORY,
    Edit,
    Example,
    KnownWorld,
    Proposal,
    categories_with,
    clauses_of,
    names_all,
    new_classes,
    new_entities,
    new_predicates,
    new_productions,
    propose,
    text_of,
)
from annotations.language.templates import SemanticTemplate, TemplateChart
from annotations.language.texts import LanguageError, Position, Problem, Refusal, error_at
from annotations.language.world import Predicate
from annotations.models import Duty, Editable, User, World
from annotations.models.description import TemplateStatus
from annotations.rows.composition import new_category, require_set_name, split_entry
from annotations.rows.from_rows import classes_of
from annotations.rows.known_world import known_world_of
from annotations.rows.stored_problems import as_json


class NoExamples(Refusal):
    """Lines that make no world; each problem has its line."""

    code = "no_examples"

    def __init__(self, problems: Iterable[Problem]) -> None:
        found = tuple(problems)
        said = "Nothing was stored. " + " ".join(
            f"Line {each.position.line}: {each.message}{f' ({each.hint})' if each.hint else ''}."
            for each in found[:3]
        )
        super().__init__(said, problems=[as_json(each) for each in found])


@dataclass(frozen=True, slots=True)
class StoredExamples:
    """How many rows were added; ``changed`` are predicates that take other arguments as well now, ``lengthened``
    productions and templates that say more."""

    classes: int = 0
    entities: int = 0
    predicates: int = 0
    changed: int = 0
    productions: int = 0
    templates: int = 0
    utterances: int = 0
    lengthened: int = 0
    upload: int = field(default=0, compare=False)


def store_examples(
    world: World, text: str, by: User, category: str = CATEGORY, once: str = ""
) -> StoredExamples | None:
    """Store what the lines of ``text`` add to ``world``, in a task category, which is made where it is missing.

    The lines become utterances. Where ``by`` is an admin, their forms become labels, as those of an upload.

    Args:
        once: the key of the form; None is returned where it has stored them before.

    Raises:
        NoExamples: a line is no example, a class has no name yet, or there is nothing to store.
        LanguageError: a task category cannot have this name, or a stored text cannot be read.
    """
    require_set_name(category)
    with transaction.atomic():
        held = World.objects.hold().get(pk=world.pk)
        if made_before(by, once):
            return None
        known = known_world_of(held, category)
        proposal = propose(text, known)
        if problems := tuple(problems_of(proposal, held)):
            raise NoExamples(problems)
        remember(by, once, held.pk)
        changed = [
            (row, {"signatures": _signatures(each), "gloss": each.gloss})
            for each in new_predicates(proposal, known)
            for row in held.predicates.filter(name=each.name)
        ]
        edits = [edit for change in proposal.changes for edit in change.edits]
        lengthened = [_lengthened(held, each) for each in edits if each.was is not None]
        upload = models.Upload.objects.create(
            world=held, created_by=by, format=UploadFormat.TEXT, stored_at=None
        )
        change_many(held, [*changed, *lengthened], by, reason_of(upload))
        groups = _unsaved(held, proposal, known, category)
        try:
            add_all(groups, by, reason=reason_of(upload))
        except ValidationError as error:
            raise NoExamples([error_at(Position(), "; ".join(error.messages))]) from error
        classes, entities, predicates, productions, templates, _ = map(len, groups)
        return StoredExamples(
            *(classes, entities, predicates, len(changed), productions, templates),
            utterances=_keep_lines(held, upload, proposal, known, by),
            lengthened=len(lengthened),
            upload=upload.pk,
        )


def problems_of(proposal: Proposal, world: World) -> Iterator[Problem]:
    """Yield what keeps a proposal from being stored."""
    yield from proposal.problems
    if not proposal.examples and not proposal.problems:
        yield error_at(Position(line=1), "there is no example", "write a command a line")
    for each in proposal.classes:
        place = Position(line=each.lines[0])
        if not each.is_named:
            members = ", ".join(each.texts[:3])
            yield error_at(place, f"nobody has said yet what {members} are", "name their class")
        for text in each.texts:
            try:
                require_entity_name(text)
            except LanguageError as error:
                yield error_at(place, error.message, error.hint)
    for predicate in proposal.predicates:
        try:
            require_predicate(predicate.predicate.name)
        except LanguageError as error:
            hint = "write its name behind the line, such as = water"
            yield error_at(Position(line=predicate.lines[0]), error.message, hint)
    classes = classes_of(world)
    if len(classes) + len(new_classes(proposal, classes)) > MOST_CLASSES:
        yield error_at(Position(line=1), f"a world has at most {MOST_CLASSES} classes")


def _unsaved(
    world: World, proposal: Proposal, known: KnownWorld, name: str
) -> list[Sequence[Editable]]:
    """Return the rows to store: classes, entities, predicates, productions, templates, and a task category."""
    ontology, _ = models.Ontology.objects.get_or_create(world=world)
    grammar, _ = models.Grammar.objects.get_or_create(world=world)
    category = grammar.task_categories.filter(name=name).first() or new_category(grammar, name)
    is_new = category.pk is None and bool(proposal.templates)
    return [
        [
            models.EntityClass.of(world, each, 0)
            for each in new_classes(proposal, classes_of(world))
        ],
        [
            models.Entity(
                ontology=ontology,
                entity_class=each.entity_class,
                text=each.text,
                aliases=list(each.aliases),
            )
            for each in new_entities(proposal, known)
        ],
        [
            models.Predicate(
                world=world,
                name=each.name,
                kind=str(each.kind),
                signatures=_signatures(each),
                gloss=each.gloss,
            )
            for each in new_predicates(proposal, known)
            if each.name not in known.predicates
        ],
        *_commands(category, proposal),
        [category] if is_new else [],
    ]


def _commands(
    category: models.TaskCategory, proposal: Proposal
) -> tuple[list[models.Production], list[models.SemanticTemplate]]:
    """Return the unsaved productions and templates of a task category."""
    own = split_entry(category.rule_sources[-1])[0]
    rows = models.Production.objects.filter(grammar=category.grammar_id)
    category_of_source = dict(rows.values_list("source", "task_category"))
    lines = [(own, category.name, *each) for each in new_productions(proposal)]
    for change in proposal.changes:
        for edit in change.edits:
            if edit.was is None:
                of_source = category_of_source.get(edit.source, "")
                added = edit.stored
                lines.append((edit.source, of_source, added["nonterminal"], added["expansion"]))
    productions = [
        models.Production(
            grammar=category.grammar,
            source=source,
            task_category=of_category,
            nonterminal=nonterminal,
            expansion=expansion,
        )
        for source, of_category, nonterminal, expansion in lines
    ]
    templates = [
        models.SemanticTemplate.for_category(
            category, pattern=each.pattern, form=each.form, status=TemplateStatus.READY
        )
        for each in proposal.templates
    ]
    return productions, templates


def _lengthened(world: World, edit: Edit) -> tuple[Editable, dict[str, str]]:
    """Return the row of a stored line and the fields that change. Raises NoExamples where it cannot be told."""
    if isinstance(edit.was, SemanticTemplate):
        templates = models.SemanticTemplate.objects.filter(grammar__world=world)
        pattern, form = edit.was.texts
        if row := templates.filter(source=edit.source, pattern=pattern, form=form).first():
            return row, edit.stored
    for production in models.Production.objects.filter(grammar__world=world, source=edit.source):
        line = f"${production.nonterminal} = {production.expansion}"
        if isinstance(edit.was, Production) and read_production(line) == edit.was:
            return production, edit.stored
    message = f"“{edit.before}” cannot be made longer"
    raise NoExamples(
        [error_at(Position(line=1), message, "refuse the change, or change it by hand")]
    )


def _signatures(predicate: Predicate) -> list[list[str]]:
    return [list(map(str, each.arguments)) for each in predicate.signatures]


def _keep_lines(
    world: World, upload: models.Upload, proposal: Proposal, known: KnownWorld, by: User
) -> int:
    """Store the lines as utterances, with their forms where ``by`` may say what they mean; return how many are new."""
    charts = [TemplateChart(categories_with(proposal, known))]
    charts += [known.chart] if known.chart else []
    anonymizer, forms = anonymizer_of(world), {}
    for each in proposal.examples if world.allows(by, Duty.MANAGE) else ():
        if form := _form_of(each, anonymizer, charts):
            forms[each.said] = form
    said = [each.said for each in proposal.examples]
    added = collect(world, said, by=by, upload=upload, forms=forms).added
    if not added:  # what came with it can be undone all the same
        upload.stored_at = timezone.now()
        upload.save()
    return added


def _form_of(example: Example, anonymizer: Anonymizer, charts: list[TemplateChart]) -> str:
    """Return the form of a line with class tokens, as a label has it; empty where the world does not read it so."""
    heard = [anonymizer.anonymize(text_of(parts)) for parts in clauses_of(example)]
    spans = [span.entity_class for each in heard for span in each.spans]
    whole = [span.entity_class for span in anonymizer.anonymize(example.said).spans]
    if spans != whole or not names_all(example):
        return ""
    parses = [
        [found for chart in charts for found in chart.parse(each.command, Budget(CHECK_STEPS))]
        for each in heard
    ]
    if not all(parses):
        return ""
    forms = [read_form(found[0].form_text) for found in parses]
    return canonical_text(forms[0] if len(forms) == 1 else Application(SEQUENCE, tuple(forms)))

"""What the lists of an annotated world may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

import django_filters
from django import forms
from django.db.models import QuerySet

from annotations.language.symbols import ENTITY_CLASSES
from annotations.lists.choices import (
    grammar_category_choices,
    grammar_file_choices,
    member_choices,
    predicate_choices,
    task_category_choices,
    template_file_choices,
)
from annotations.lists.filtering import EntitySearch, Head, Key, Mentions, PageFilters, Search
from annotations.models import Production, SemanticTemplate, TaskCategory
from annotations.models.corpus import (
    origin_choices,
    paraphrase_status_choices,
    utterance_status_choices,
)
from annotations.models.description import predicate_kind_choices, template_status_choices
from annotations.models.queueing import (
    AuditFindingQuerySet,
    WorkItemQuerySet,
    audit_reason_choices,
    finding_status_choices,
    work_kind_choices,
)
from annotations.models.splits import part_choices, source_choices
from annotations.rows.composition import split_entry

CHOICES_OF_FORMS = {
    "task_category": task_category_choices,
    "head": predicate_choices,
    "mentions": predicate_choices,
}


class EntityFilters(PageFilters):
    q = EntitySearch()
    entity_class = django_filters.ChoiceFilter(
        label="Class", choices=[(name, name) for name in ENTITY_CLASSES]
    )


class PredicateFilters(PageFilters):
    q = Search("name", "gloss")
    kind = django_filters.ChoiceFilter(label="Kind", choices=predicate_kind_choices)


class TemplateFilters(PageFilters):
    q = Search("pattern", "form")
    task_category = django_filters.ChoiceFilter(label="Task category")
    source = django_filters.ChoiceFilter(label="File")
    status = django_filters.ChoiceFilter(label="Status", choices=template_status_choices)
    problems = django_filters.ChoiceFilter(
        label="Problems",
        choices=[("yes", "with problems"), ("no", "without")],
        method="by_problems",
    )
    world_choices = {"task_category": grammar_category_choices, "source": template_file_choices}

    def by_problems(
        self, rows: QuerySet[SemanticTemplate], name: str, value: str
    ) -> QuerySet[SemanticTemplate]:
        return rows.with_problems() if value == "yes" else rows.filter(problems=[])


class CommandsOfLogicalFormFilters(PageFilters):
    q = Search("anonymized_text")
    task_category = django_filters.ChoiceFilter(label="Task category")
    world_choices = {"task_category": task_category_choices}


class CommandFilters(CommandsOfLogicalFormFilters):
    head = django_filters.ChoiceFilter("logical_form__head_predicate", label="Head predicate")
    mentions = Mentions("logical_form__text", label="Predicate")
    in_grammar = django_filters.ChoiceFilter(
        "is_in_grammar",
        label="Grammar",
        choices=[("True", "in the grammar"), ("False", "outside it")],
    )
    template = Key("template_id", label="Template", widget=forms.HiddenInput)
    world_choices = CHOICES_OF_FORMS


class LogicalFormFilters(PageFilters):
    q = Search("text")
    task_category = django_filters.ChoiceFilter(label="Task category")
    head = django_filters.ChoiceFilter("head_predicate", label="Head predicate")
    mentions = Mentions("text", label="Predicate")
    world_choices = CHOICES_OF_FORMS


class ParaphraseFilters(PageFilters):
    q = Search("utterance", "prompt")
    status = django_filters.ChoiceFilter(label="Status", choices=paraphrase_status_choices)
    head = Head("logical_form", label="Head predicate")
    world_choices = {"head": predicate_choices}


class UtteranceFilters(PageFilters):
    q = Search("text")
    status = django_filters.ChoiceFilter(label="Status", choices=utterance_status_choices)
    origin = django_filters.ChoiceFilter(label="Origin", choices=origin_choices)
    head = Head("logical_form", label="Head predicate")
    world_choices = {"head": predicate_choices}


class ExampleFilters(PageFilters):
    q = Search("utterance", "source_command")
    part = django_filters.ChoiceFilter(label="Part", choices=part_choices)
    source = django_filters.ChoiceFilter(label="Source", choices=source_choices)
    task_category = django_filters.ChoiceFilter(label="Task category")
    head = Head("logical_form", label="Head predicate")
    world_choices = {"task_category": task_category_choices, "head": predicate_choices}


class WorkItemFilters(PageFilters):
    """The items of the work queue; those that are done are hidden unless asked for."""

    q = Search("title", "reason")
    kind = django_filters.ChoiceFilter(label="Why", choices=work_kind_choices)
    state = django_filters.ChoiceFilter(
        label="State",
        choices=[("free", "free"), ("taken", "somebody has it"), ("done", "done")],
        method="by_state",
    )
    person = django_filters.ChoiceFilter(label="Person", method="by_person")
    world_choices = {"person": member_choices}

    @property
    def qs(self) -> WorkItemQuerySet:
        rows = super().qs
        is_asked = self.is_bound and self.form.is_valid() and self.form.cleaned_data["state"]
        return rows if is_asked else rows.open()

    def by_state(self, rows: WorkItemQuerySet, name: str, value: str) -> WorkItemQuerySet:
        if value == "done":
            return rows.filter(closed_at__isnull=False)
        return rows.free() if value == "free" else rows.taken()

    def by_person(self, rows: WorkItemQuerySet, name: str, value: str) -> WorkItemQuerySet:
        return rows.of_person(int(value))


class AuditFindingFilters(PageFilters):
    """The findings of label audits; those that are decided are hidden unless asked for."""

    q = Search("text", "source_command")
    status = django_filters.ChoiceFilter(
        label="Status",
        choices=finding_status_choices,
        empty_label="Status: open",
        method="by_status",
    )
    reason = django_filters.ChoiceFilter(
        label="Against it", choices=audit_reason_choices, method="by_reason"
    )

    @property
    def qs(self) -> AuditFindingQuerySet:
        rows = super().qs
        is_asked = self.is_bound and self.form.is_valid() and self.form.cleaned_data["status"]
        return rows if is_asked else rows.open()

    def by_status(self, rows: AuditFindingQuerySet, name: str, value: str) -> AuditFindingQuerySet:
        return rows.with_status(value)

    def by_reason(self, rows: AuditFindingQuerySet, name: str, value: str) -> AuditFindingQuerySet:
        return rows.with_reason(value)


class SplitFilters(PageFilters):
    q = Search("name")


class ProductionFilters(PageFilters):
    q = Search("nonterminal", "expansion")
    task_category = django_filters.ChoiceFilter(label="Task category", method="by_task_category")
    source = django_filters.ChoiceFilter(label="File")
    nonterminal = django_filters.CharFilter(label="Nonterminal", widget=forms.HiddenInput)
    world_choices = {"task_category": grammar_category_choices, "source": grammar_file_choices}

    def by_task_category(
        self, rows: QuerySet[Production], name: str, value: str
    ) -> QuerySet[Production]:
        """Return the productions that a task category is generated from, those of imported files too."""
        category = TaskCategory.objects.get(grammar__world=self.request.world, name=value)
        return rows.filter(source__in=[split_entry(entry)[0] for entry in category.rule_sources])

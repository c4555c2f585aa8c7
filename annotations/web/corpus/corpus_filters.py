"""What the lists of a world's corpus may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

import django_filters
from django import forms

from annotations.models.corpus import (
    origin_choices,
    paraphrase_status_choices,
    utterance_status_choices,
)
from annotations.showing.filtering import (
    Head,
    Key,
    Mentions,
    PageFilters,
    Search,
    predicate_choices,
    task_category_choices,
)

CHOICES_OF_FORMS = {
    "task_category": task_category_choices,
    "head": predicate_choices,
    "mentions": predicate_choices,
}


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
    upload = Key("upload_id", label="Upload", widget=forms.HiddenInput)
    world_choices = {"head": predicate_choices}

"""What the list of submissions may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

from typing import Any

import django_filters
from django import forms
from django.db.models import QuerySet, TextField
from django.db.models.functions import Cast

from annotations.campaigns.model_rewrites import NO_REWRITE
from annotations.language.corpus import FlagCode
from annotations.models.campaigns import (
    SubmissionKind,
    contributor_kind_choices,
    submission_status_choices,
)
from annotations.showing.filtering import Choices, Key, PageFilters, Search
from annotations.web.campaigns.campaign_forms import campaign_choices

# What a flag is called on pages.
FLAG_LABELS = {
    FlagCode.COPY: "copy",
    FlagCode.REPEAT: "repeat",
    FlagCode.TOO_FAST: "too fast",
    FlagCode.LOST_ENTITY: "lost entity",
    FlagCode.GIBBERISH: "gibberish or another language",
    FlagCode.CHECK_FAILED: "check failed",
    FlagCode.SPAM: "spam",
    FlagCode.PASTED: "pasted",
    FlagCode.LIKE_MODEL: "like a model's",
    FlagCode.OTHER_FORM: "reads as another form",
    NO_REWRITE: "no rewrite in the reply",
}
NO_FLAG = "none"


def flag_choices() -> Choices:
    return [(NO_FLAG, "no flag"), *((str(code), label) for code, label in FLAG_LABELS.items())]


class FlagFilter(django_filters.ChoiceFilter):
    """Submissions with a flag of a code, or without any."""

    def filter(self, rows: QuerySet[Any], value: str) -> QuerySet[Any]:
        if not value:
            return rows
        if value == NO_FLAG:
            return rows.filter(flags=[])
        written: QuerySet[Any] = rows.annotate(written_flags=Cast("flags", TextField()))
        return written.filter(written_flags__contains=f'"{value}"')


class SubmissionFilters(PageFilters):
    q = Search("text", "prompt__shown")
    status = django_filters.ChoiceFilter(label="Status", choices=submission_status_choices)
    flag = FlagFilter(label="Flag", choices=flag_choices())
    by = django_filters.ChoiceFilter(
        "contributor__kind", label="By", choices=contributor_kind_choices
    )
    kind = django_filters.ChoiceFilter(
        label="Kind",
        choices=[(SubmissionKind.REWRITE, "rewrite"), (SubmissionKind.FREE, "free command")],
    )
    campaign = django_filters.ChoiceFilter("contributor__campaign_id", label="Campaign")
    contributor = Key("contributor_id", label="Contributor", widget=forms.HiddenInput)
    world_choices = {"campaign": campaign_choices}

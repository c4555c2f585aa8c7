"""What the probes of a run may be filtered by."""

from __future__ import annotations

import django_filters
from django import forms
from django.db.models import F, QuerySet

from annotations.showing.filtering import PageFilters, Search
from parser_service.models import Probe
from parser_service.reviews.probe_kinds import PROBE_KINDS


class ProbeFilters(PageFilters):
    """``word`` is one that was taken out of an utterance."""

    q = Search("utterance", "base__utterance")
    kind = django_filters.ChoiceFilter(label="Kind", choices=list(PROBE_KINDS.items()))
    outcome = django_filters.ChoiceFilter(
        label="Answer",
        choices=[
            ("expected", "as expected"),
            ("unexpected", "not as expected"),
            ("changed", "another than before"),
        ],
        method="by_outcome",
    )
    word = django_filters.CharFilter("old", label="Word", widget=forms.HiddenInput)

    def by_outcome(self, rows: QuerySet[Probe], name: str, value: str) -> QuerySet[Probe]:
        if value == "changed":
            return rows.filter(base__isnull=False).exclude(answer__logical_form=F("before"))
        return rows.filter(answer__is_expected=value == "expected")

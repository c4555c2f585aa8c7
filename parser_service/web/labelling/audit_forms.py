"""The form that starts a label audit."""

from __future__ import annotations

from django import forms

from annotations.language.corpus import LEAST_FOLDS, MOST_FOLDS
from parser_service.labelling.out_of_fold import AUDITORS
from parser_service.parsers.registry import entry

MOST_QUEUED = 1_000


class AuditForm(forms.Form):
    """The parser that answers for held-out pairs, and how many labels people are asked about."""

    parser = forms.ChoiceField(choices=[(name, entry(name).title) for name in AUDITORS])
    folds = forms.IntegerField(
        min_value=LEAST_FOLDS,
        max_value=MOST_FOLDS,
        initial=5,
        help_text="Parts of the pairs; each is answered by a parser that learned from the others.",
    )
    to_queue = forms.IntegerField(
        label="Into the work queue",
        min_value=0,
        max_value=MOST_QUEUED,
        initial=50,
        help_text="The most suspect labels. The others wait on this page only.",
    )

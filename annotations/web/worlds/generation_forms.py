"""The form of the page that generates commands."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.language.templates import (
    LARGEST_SEED,
    MOST_SAMPLED,
    Balance,
    SampleNote,
    SampleRequest,
)

BALANCES = {
    Balance.NONE: "none",
    Balance.LINES: "by lines of the templates",
    Balance.FORMS: "by logical forms",
}


class GenerationForm(forms.Form):
    """How many commands to make of the templates, and which."""

    sample = forms.IntegerField(
        label="Sample of",
        required=False,
        min_value=0,
        max_value=MOST_SAMPLED,
        help_text="Commands to draw. Leave it empty to make all commands.",
    )
    seed = forms.IntegerField(
        label="Seed",
        required=False,
        min_value=0,
        max_value=LARGEST_SEED,
        help_text="The same templates and seed give the same sample. Empty is 0.",
    )
    balanced = forms.ChoiceField(
        label="Balance",
        required=False,
        choices=list(BALANCES.items()),
        help_text="None: every derivation is as likely as any other. By lines or forms: equally many commands "
        "of each; those that have too few give all.",
    )

    @staticmethod
    def initial_of(note: SampleNote | None) -> dict[str, Any]:
        """Return the values of the form that ask for the same sample again."""
        if note is None:
            return {}
        request = note.request
        return {"sample": request.size, "seed": request.seed, "balanced": request.balance}

    @property
    def request(self) -> SampleRequest:
        """What the valid form asks for."""
        values = self.cleaned_data
        balance = Balance(values["balanced"] or Balance.NONE)
        return SampleRequest(values["sample"] or 0, values["seed"] or 0, balance)

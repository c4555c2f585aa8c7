"""The form that lets a language model contribute to a campaign."""

from __future__ import annotations

from typing import Any

from django import forms
from django.core.exceptions import ValidationError

from annotations.campaigns.model_rewrites import ModelSettings
from annotations.language.corpus import INSTRUCTIONS, LONGEST_INSTRUCTIONS, check_instructions
from annotations.language.texts import Refusal
from parser_service.parsers.model_server.protocol import MOST_NAME

MOST_WORDINGS = 10
MOST_REQUESTS = 20_000
LARGEST_SEED = 2**31 - 1


class ModelForm(forms.Form):
    """What a language model is asked with: the fields of ``ModelSettings``."""

    model = forms.CharField(
        max_length=MOST_NAME,
        help_text="Its name as the server lists it.",
        widget=forms.TextInput(attrs={"autocomplete": "off", "spellcheck": "false"}),
    )
    wordings = forms.IntegerField(
        label="Rewrites a request",
        min_value=1,
        max_value=MOST_WORDINGS,
        initial=3,
        help_text="From elaborate to short, as the instructions say.",
    )
    budget = forms.IntegerField(
        label="Requests at most", min_value=1, max_value=MOST_REQUESTS, initial=500
    )
    temperature = forms.FloatField(
        min_value=0, max_value=2, initial=0.8, help_text="0 repeats itself; 1 and more wanders."
    )
    seed = forms.IntegerField(min_value=0, max_value=LARGEST_SEED, initial=0)
    instructions = forms.CharField(
        max_length=LONGEST_INSTRUCTIONS,
        initial=INSTRUCTIONS,
        strip=False,
        widget=forms.Textarea(attrs={"rows": 9, "class": "mono", "spellcheck": "false"}),
        help_text="{command}, {names} and {count} stand for what each request asks.",
    )

    def clean_instructions(self) -> str:
        instructions: str = self.cleaned_data["instructions"].replace("\r\n", "\n")
        try:
            check_instructions(instructions)
        except Refusal as refusal:
            raise ValidationError(refusal.message, refusal.code) from refusal
        return instructions

    def settings(self) -> ModelSettings:
        """Return what was chosen, once the form is valid."""
        chosen: dict[str, Any] = self.cleaned_data
        return ModelSettings(**chosen)

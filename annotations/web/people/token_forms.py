"""The form that makes a token."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.models import Scope, User
from annotations.models.people import scope_choices

MOST_TOKENS = 50
MOST_DAYS = 365


class TokenForm(forms.Form):
    """What a token is for, what it may be used for, and how long."""

    name = forms.CharField(
        label="What it is for",
        max_length=80,
        widget=forms.TextInput(attrs={"autocomplete": "off", "placeholder": "robot in the lab"}),
    )
    scope = forms.ChoiceField(choices=scope_choices, initial=Scope.READ)
    days = forms.IntegerField(
        label="Days", min_value=1, max_value=MOST_DAYS, initial=90, help_text="until it expires"
    )

    def __init__(self, user: User, *args: Any) -> None:
        super().__init__(*args)
        self.user = user

    def clean(self) -> dict[str, Any]:
        if self.user.api_tokens.count() >= MOST_TOKENS:
            raise forms.ValidationError(
                f"You have {MOST_TOKENS} tokens. Revoke one that you do not need."
            )
        return self.cleaned_data

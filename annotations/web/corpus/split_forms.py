"""The form that freezes a split."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.models.splits import criterion_choices


class SplitForm(forms.Form):
    """How to split the pairs. The shares are percentages that sum to 100."""

    SHARES = ("train", "validation", "test")

    name = forms.SlugField(
        max_length=80, help_text="Letters, digits, _ and -. Used in tables and URLs."
    )
    criterion = forms.ChoiceField(
        label="Keep apart by",
        choices=lambda: [(name, label.lower()) for name, label in criterion_choices()],
        help_text="No two parts share one. By logical form is the harder test.",
    )
    seed = forms.IntegerField(
        initial=0, min_value=0, max_value=2**32 - 1, help_text="The same seed gives the same split."
    )
    tests_on_models = forms.BooleanField(
        label="Test on what language models wrote too",
        required=False,
        help_text="Without it, what models wrote is only trained on.",
    )
    train = forms.FloatField(label="Train, %", initial=70, min_value=0, max_value=100)
    validation = forms.FloatField(label="Validation, %", initial=10, min_value=0, max_value=100)
    test = forms.FloatField(label="Test, %", initial=20, min_value=0, max_value=100)

    def clean(self) -> dict[str, Any]:
        """Refuse shares that do not sum to 100 %."""
        cleaned = self.cleaned_data
        shares = [cleaned[part] for part in self.SHARES if part in cleaned]
        if len(shares) == len(self.SHARES) and abs(sum(shares) - 100) > 1e-4:
            self.add_error(
                "test", f"The three shares sum to {sum(shares):g} %; they have to sum to 100 %."
            )
        return cleaned

    @property
    def what(self) -> list[forms.BoundField]:
        return [field for field in self if field.name not in self.SHARES]

    @property
    def shares(self) -> list[forms.BoundField]:
        return [self[name] for name in self.SHARES]

    @property
    def choice(self) -> dict[str, Any]:
        """Return the arguments of ``freeze_split`` and ``plan_split``, once the form is valid."""
        shares = [self.cleaned_data[part] / 100 for part in self.SHARES]
        chosen = {
            name: self.cleaned_data[name] for name in ("criterion", "seed", "tests_on_models")
        }
        return {**chosen, "proportions": shares}

"""The forms of the work queue."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django import forms

from annotations.labelling.enqueuing import DOUBLE_KINDS
from annotations.labelling.form_check import canonical_label
from annotations.language.texts import MAX_FORM, LanguageError
from annotations.models import Label, User, Verdict, World
from annotations.web.forms import choice_field, row_field

MOST_ASSIGNED = 100
LONGEST_QUESTION = 200  # characters that say what somebody is to look at


class AskForm(forms.Form):
    """What somebody is asked to look at, and why."""

    reason = forms.CharField(max_length=LONGEST_QUESTION)


class AssignForm(forms.Form):
    """The member who is to do an item."""

    person = forms.ModelChoiceField(User.objects.none(), empty_label=None)

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        members = User.objects.filter(memberships__world=world, is_active=True).distinct()
        row_field(self, "person").queryset = members.order_by("username")


class AssignManyForm(AssignForm):
    """The member who is to do the first items of a list, and how many."""

    count = forms.IntegerField(label="Items", min_value=1, max_value=MOST_ASSIGNED, initial=10)


class SharesForm(forms.Form):
    """The share of items of each kind that two people do independently of each other, in percent."""

    def __init__(self, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        for kind in DOUBLE_KINDS:
            self.fields[kind] = forms.IntegerField(
                label=f"{kind.label.capitalize()}, %", min_value=0, max_value=100
            )


class SettleForm(forms.Form):
    """One of two labels, or another answer; ``decision`` is what ``annotations.labelling.item_answers`` takes."""

    UNKNOWN, OTHER = "unknown", "other"

    choice = forms.ChoiceField(widget=forms.RadioSelect)
    form = forms.CharField(
        label="Another form",
        required=False,
        max_length=MAX_FORM,
        widget=forms.Textarea(attrs={"rows": 3}),
    )

    def __init__(self, labels: Sequence[Label], *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.labels = {str(label.pk): label for label in labels}
        taken = [(key, f"What {label.annotator} says") for key, label in self.labels.items()]
        others = [(self.UNKNOWN, "No form says this"), (self.OTHER, "Another form")]
        choice_field(self, "choice").choices = taken + others

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        if cleaned.get("choice") == self.OTHER:
            try:
                cleaned["form"] = canonical_label(cleaned.get("form", ""))
            except LanguageError as error:
                self.add_error("form", error.problem.message)
        return cleaned

    @property
    def decision(self) -> dict[str, Any]:
        choice = self.cleaned_data["choice"]
        if label := self.labels.get(choice):
            return {"verdict": label.verdict, "form": label.form, "reason": label.reason}
        if choice == self.UNKNOWN:
            return {"verdict": Verdict.UNKNOWN, "form": ""}
        return {"verdict": Verdict.FORM, "form": self.cleaned_data["form"]}

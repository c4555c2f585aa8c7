"""The forms of the pages about error categories."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.models import World
from annotations.web.forms import row_field
from parser_service.models import ErrorCategory


class CategoryForm(forms.ModelForm):  # type: ignore[type-arg]  # generic in the stubs alone
    """What an error category is called, what belongs in it, and which slice proposes it."""

    class Meta:
        model = ErrorCategory
        fields = ("name", "description", "slice")
        widgets = {"description": forms.Textarea(attrs={"rows": 2})}
        help_texts = {
            "description": "One sentence that tells reviewers what belongs here.",
            "slice": "Errors in this slice are proposed for the category, unless there is stronger evidence.",
        }

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        row_field(self, "slice").queryset = world.slices.all()
        row_field(self, "slice").empty_label = "none"


class DeletionForm(forms.Form):
    """The category that gets the reviews of a deleted one."""

    move_to = forms.ModelChoiceField(
        ErrorCategory.objects.none(),
        required=False,
        empty_label="choose a category",
        label="Move its reviews to",
    )

    def __init__(self, category: ErrorCategory, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        others = category.world.error_categories.exclude(pk=category.pk)
        row_field(self, "move_to").queryset = others

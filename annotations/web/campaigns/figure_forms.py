"""What figures of paraphrases may be filtered by, on pages and by REST."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.campaigns.paraphrase_figures import MOST_WANTED
from annotations.models import Campaign, World
from annotations.people.access import WorldRequest
from annotations.showing.filtering import task_category_choices
from annotations.web.campaigns.campaign_forms import campaign_choices
from annotations.web.forms import choice_field

SHORT, REACHED = "short", "reached"


class FigureFilters(forms.Form):
    """The paraphrases of all of a world, or those of a campaign. Each name is a parameter of the page's URL."""

    campaign = forms.ChoiceField(label="Campaign", required=False)

    def __init__(self, request: WorldRequest, world: World, *args: Any) -> None:
        super().__init__(*args)
        self.world = world
        choice_field(self, "campaign").choices = [
            ("", "Campaign: any"),
            *campaign_choices(request),
        ]

    @property
    def chosen(self) -> Campaign | None:
        """The campaign that was chosen; None: everything."""
        self.is_valid()  # what is not valid is ignored, and said
        key = self.cleaned_data.get("campaign")
        return self.world.campaigns.filter(pk=key).first() if key else None


class FormCountFilters(FigureFilters):
    """The forms of a world, or of a campaign, by what they lack of a target."""

    task_category = forms.ChoiceField(label="Task category", required=False)
    short = forms.ChoiceField(
        label="Target",
        required=False,
        choices=[("", "Target: any"), (SHORT, "still short"), (REACHED, "reached")],
    )
    target = forms.IntegerField(
        label="Paraphrases per form",
        required=False,
        min_value=1,
        max_value=MOST_WANTED,
        widget=forms.NumberInput(attrs={"placeholder": "per form"}),
    )

    def __init__(self, request: WorldRequest, world: World, *args: Any) -> None:
        super().__init__(request, world, *args)
        choice_field(self, "task_category").choices = [
            ("", "Task category: any"),
            *task_category_choices(request),
        ]

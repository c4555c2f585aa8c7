"""The form that launches a campaign, and what its lists may be filtered by."""

from __future__ import annotations

from datetime import UTC, date, datetime, time, timedelta
from typing import Any

import django_filters
from django import forms
from django.utils import timezone

from annotations.campaigns.addresses import BadAddress, origins_in, require_public_address
from annotations.campaigns.changing import ABOUT, CHANGEABLE, END, MARKET, TEXTS, has_consents
from annotations.campaigns.launching import PromptChoice
from annotations.generation.example_commands import example_rewordings
from annotations.language.texts import ENCODINGS
from annotations.models import Campaign, World
from annotations.models.campaigns import (
    LONGEST_CAMPAIGN_NAME,
    MOST_CHARACTERS_OF_TEXT,
    Balance,
    Wording,
    contributor_kind_choices,
    wording_choices,
)
from annotations.people.access import WorldRequest
from annotations.showing.filtering import (
    Choices,
    PageFilters,
    Search,
    task_categories_with_commands,
)
from annotations.web.forms import choice_field

MOST_PROMPTS_PER_FORM = 20
MOST_REWRITES, MOST_FREE_COMMANDS = 100, 20
MOST_SUBMISSIONS = 1_000_000
MOST_TASKS_PER_HOUR = 100_000
MOST_MINUTES = 1_000
TEN_TASKS = 10  # of a campaign that one button makes
PARAMETER = r"[A-Za-z][A-Za-z0-9_.-]{0,39}"  # of an address
INTRODUCTION = (
    "You will see commands that somebody could give to a robot. Say each of them in your own words: "
    "use other words or another order, but ask for the same. Write as you would speak."
)
EXAMPLES = 2  # commands of the world that are shown with another wording
CONSENT = (
    "What you write is used for research and may be published. Nobody asks for your name: you are known by a "
    "random number. You may stop at any time."
)
THANKS = "Everything is saved. You have helped robots to understand people."


def text_field(label: str, initial: str) -> forms.CharField:
    return forms.CharField(
        label=label,
        required=False,
        initial=initial,
        max_length=MOST_CHARACTERS_OF_TEXT,
        strip=False,
        widget=forms.Textarea(attrs={"rows": 4}),
    )


def line_field(label: str, most: int, help_text: str) -> forms.CharField:
    return forms.CharField(label=label, required=False, max_length=most, help_text=help_text)


def address_field(label: str, help_text: str) -> forms.URLField:
    return forms.URLField(
        label=label, required=False, max_length=500, assume_scheme="https", help_text=help_text
    )


def parameter_field(label: str, help_text: str) -> forms.RegexField:
    return forms.RegexField(
        rf"\A{PARAMETER}\Z",  # Django looks anywhere in the value
        label=label,
        required=False,
        max_length=40,
        help_text=help_text,
        error_messages={
            "invalid": "Write the name of a parameter, such as participant_id: letters, digits and _ . -"
        },
    )


def number_field(label: str, initial: int, most: int, help_text: str, least: int = 0) -> Any:
    return forms.IntegerField(
        label=label, initial=initial, min_value=least, max_value=most, help_text=help_text
    )


class CampaignForm(forms.Form):
    """What people are asked, how much of it, and in which words. Every field but the name may stay as it is."""

    name = forms.CharField(
        max_length=LONGEST_CAMPAIGN_NAME, help_text="Contributors do not see it."
    )
    task_categories = forms.MultipleChoiceField(
        label="Task categories",
        required=False,
        widget=forms.CheckboxSelectMultiple,
        help_text="None: all of them.",
    )
    wording = forms.ChoiceField(
        label="What is shown",
        choices=wording_choices,
        initial=Wording.COMMAND,
        help_text="The English of the form sounds odd, but puts fewer words into people's mouths.",
    )
    balance = forms.ChoiceField(
        label="Equally many of each",
        choices=[(Balance.FORMS, "form"), (Balance.LINES, "line of the templates")],
        initial=Balance.FORMS,
        help_text="A form may have many lines, and each line many wordings.",
    )
    target_per_form = number_field(
        "Paraphrases per form", 10, 1_000, "Forms that have as many are left out.", 1
    )
    prompts_per_form = number_field(
        "Prompts of each", 3, MOST_PROMPTS_PER_FORM, "Commands and entities, where they differ.", 1
    )
    task_size = number_field("Rewrites", 12, MOST_REWRITES, "in one task", 1)
    free_commands = number_field("Free commands", 2, MOST_FREE_COMMANDS, "of their own, at the end")
    check_every = number_field(
        "Check after every", 0, MOST_REWRITES, "rewrites; 0 plants no checks"
    )
    taboo_words = number_field(
        "Words to avoid", 0, 10, "the most used ones of a form; 0 shows none"
    )
    ends_at = forms.DateField(
        label="Last day",
        required=False,
        widget=forms.DateInput(attrs={"type": "date"}),
        help_text="Empty: until you close it.",
    )
    most_submissions = forms.IntegerField(
        label="Submissions at most",
        required=False,
        min_value=1,
        max_value=MOST_SUBMISSIONS,
        help_text="Empty: as many as come.",
    )
    most_per_hour = number_field(
        "Tasks an hour", 1_000, MOST_TASKS_PER_HOUR, "begun by the link, at most", 1
    )
    price = forms.DecimalField(
        label="Price of a task",
        required=False,
        min_value=0,
        max_digits=7,
        decimal_places=2,
        help_text="Empty: people are not paid.",
    )
    currency = forms.CharField(required=False, max_length=8, initial="EUR")
    run_by = line_field("Who runs it", 200, "Stands beside the consent.")
    contact = line_field("Whom to write to", 200, "A mail address, for questions and complaints.")
    minutes = forms.IntegerField(
        label="Minutes",
        required=False,
        min_value=1,
        max_value=MOST_MINUTES,
        help_text="of one task. Empty: half a minute for each command.",
    )
    completion_code = line_field("Completion code", 40, "Shown at the end.")
    return_url = address_field("Link back", "Where the crowd market wants people back.")
    worker_parameter = parameter_field(
        "Parameter with who comes", "Empty: PROLIFIC_PID or workerId."
    )
    assignment_parameter = parameter_field(
        "Parameter with the assignment", "Empty: assignmentId or SESSION_ID."
    )
    frame_origins = line_field(
        "Sites that may frame it",
        500,
        "Such as https://worker.mturk.com https://workersandbox.mturk.com; empty: none.",
    )
    screening_question = line_field(
        "Question before the task", 300, "Who answers no gets no task. Empty: none is asked."
    )
    screened_out_code = line_field("Code for who is not taken", 40, "Shown to who answers no.")
    screened_out_url = address_field("Link back for who is not taken", "Empty: none.")
    allows_model_help = forms.BooleanField(label="People may use a language model", required=False)
    allows_retake = forms.BooleanField(label="People may do more than one task", required=False)
    seed = number_field("Seed", 0, 2**31 - 1, "The same seed draws the same prompts.")
    introduction = text_field("Introduction", INTRODUCTION)
    examples = text_field("Examples", "")
    consent = text_field("Consent", CONSENT)
    thanks = text_field("Thanks", THANKS)

    OF_CHOICE = (
        *("task_categories", "prompts_per_form", "target_per_form"),
        *("wording", "balance", "seed"),
    )
    TASK = ("task_size", "free_commands", "target_per_form")
    WHAT = ("balance", "prompts_per_form", "wording", "taboo_words", "check_every", "seed")
    MAY = ("allows_model_help", "allows_retake")

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        choice_field(self, "task_categories").choices = task_categories_with_commands(world)
        self.fields["examples"].initial = examples_of(world)

    def clean_ends_at(self) -> datetime | None:
        """Return the end of the last day, which must lie ahead. The time zone is that of the person; over REST it
        is UTC."""
        day: date | None = self.cleaned_data["ends_at"]
        if day is None:
            return None
        try:
            here = timezone.get_current_timezone()
            end = datetime.combine(day + timedelta(days=1), time.min, here).astimezone(UTC)
        except OverflowError:
            raise forms.ValidationError("Choose an earlier day.") from None
        if end <= timezone.now():
            raise forms.ValidationError("This day is over. Choose a later one.")
        return end

    def clean_return_url(self) -> str:
        return public_address(self.cleaned_data["return_url"])

    def clean_screened_out_url(self) -> str:
        return public_address(self.cleaned_data["screened_out_url"])

    def clean_frame_origins(self) -> str:
        try:
            return origins_in(self.cleaned_data["frame_origins"])
        except BadAddress as error:
            raise forms.ValidationError(error.message) from None

    @property
    def choice(self) -> PromptChoice:
        """Return which prompts are drawn, once the form is valid."""
        chosen = {name: self.cleaned_data[name] for name in self.OF_CHOICE}
        return PromptChoice(**{**chosen, "task_categories": tuple(chosen["task_categories"])})

    @property
    def values(self) -> dict[str, Any]:
        """Return the columns of the campaign that a valid form describes."""
        others = ("task_categories", "prompts_per_form")
        return {name: value for name, value in self.cleaned_data.items() if name not in others}

    @classmethod
    def of_ten_tasks(cls, world: World, name: str) -> CampaignForm:
        """Return the form as it is, filled in, for a campaign that ends by itself with ``TEN_TASKS``."""
        values = {key: field.initial for key, field in cls.base_fields.items()}
        task = cls.base_fields["task_size"].initial + cls.base_fields["free_commands"].initial
        return cls(
            world,
            {
                **values,
                "name": name,
                "most_submissions": TEN_TASKS * task,
                "examples": examples_of(world),
            },
        )

    def group(self, names: tuple[str, ...]) -> list[forms.BoundField]:
        return [self[name] for name in names]

    @property
    def what(self) -> list[forms.BoundField]:
        return self.group(self.WHAT)

    @property
    def task(self) -> list[forms.BoundField]:
        return self.group(self.TASK)

    @property
    def end(self) -> list[forms.BoundField]:
        return self.group((*END, *ABOUT))

    @property
    def market(self) -> list[forms.BoundField]:
        return self.group(MARKET)

    @property
    def may(self) -> list[forms.BoundField]:
        return self.group(self.MAY)

    @property
    def texts(self) -> list[forms.BoundField]:
        return self.group(TEXTS)


def examples_of(world: World) -> str:
    """Return examples for contributors: commands of the world in two wordings; nothing where none has two."""
    pairs = example_rewordings(world, EXAMPLES)
    return "".join(f"- *{command}* → **{other}**\n" for command, other in pairs)


def public_address(address: str) -> str:
    """Return an address that people may be sent to, or none. Raises ValidationError."""
    try:
        if address:
            require_public_address(address)
    except BadAddress as error:
        raise forms.ValidationError(error.message) from None
    return address


class CampaignChangeForm(CampaignForm):
    """What may still be changed of a campaign that was launched."""

    version = forms.IntegerField(widget=forms.HiddenInput)

    def __init__(self, campaign: Campaign, *args: Any, **kwargs: Any):
        self.campaign = campaign
        super().__init__(campaign.world, *args, initial=values_of(campaign), **kwargs)
        for name in self.fields.keys() - {*CHANGEABLE, "version"}:
            del self.fields[name]
        consent = self.fields["consent"]
        if has_consents(campaign):
            consent.widget.attrs["readonly"] = True
            consent.help_text = "Somebody has agreed to it, so it stays as it is."
        else:
            consent.help_text = "It can be changed until somebody has agreed to it."

    def clean_ends_at(self) -> datetime | None:
        """Return as ``CampaignForm`` does; the day that it has may be over."""
        if self.cleaned_data["ends_at"] == last_day_of(self.campaign):
            return self.campaign.ends_at
        return super().clean_ends_at()

    @property
    def values(self) -> dict[str, Any]:
        """Return the values of a valid form, without its version."""
        return {name: self.cleaned_data[name] for name in CHANGEABLE}


def values_of(campaign: Campaign) -> dict[str, Any]:
    """Return what the fields of ``CampaignChangeForm`` show."""
    values = {name: getattr(campaign, name) for name in CHANGEABLE}
    return {**values, "ends_at": last_day_of(campaign), "version": campaign.version}


def last_day_of(campaign: Campaign) -> date | None:
    """Return the last day of a campaign, as the reader counts days; None where it has no end."""
    if campaign.ends_at is None:
        return None
    return timezone.localdate(campaign.ends_at - timedelta(microseconds=1))


class ResultsForm(forms.Form):
    """Results of a crowd market, and the campaign that they are of; without one they get a campaign of their own."""

    file = forms.FileField(
        help_text="A table (CSV) with WorkerId, Input.command1, Answer.utterance1 and so on, or a zip archive "
        "with one.",
    )
    campaign = forms.ChoiceField(
        label="Prompts of",
        required=False,
        help_text="The campaign whose task file it was. A new one is made of the prompts in the file, and is closed.",
    )
    name = forms.CharField(
        label="Name of the new campaign", required=False, max_length=LONGEST_CAMPAIGN_NAME
    )
    encoding = forms.ChoiceField(
        required=False, choices=[("", "as recognised"), *ENCODINGS.items()]
    )

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        rows = [(str(key), name) for key, name in world.campaigns.values_list("pk", "name")]
        choice_field(self, "campaign").choices = [("", "a new campaign"), *rows]
        self._world = world

    def clean(self) -> None:
        super().clean()
        if "campaign" in self.cleaned_data and "name" in self.cleaned_data:
            if self.cleaned_data["campaign"] and self.cleaned_data["name"]:
                self.add_error("name", "Leave it empty: you have chosen a campaign.")
            elif not (self.cleaned_data["campaign"] or self.cleaned_data["name"]):
                self.add_error("name", "Name the new campaign, or choose one that is here.")

    @property
    def chosen(self) -> Campaign | None:
        """Return the campaign that a valid form names; None for a new one."""
        key = self.cleaned_data["campaign"]
        return self._world.campaigns.get(pk=key) if key else None


def campaign_choices(request: WorldRequest) -> Choices:
    """Return the campaigns of the world."""
    return [(str(key), name) for key, name in request.world.campaigns.values_list("pk", "name")]


class CampaignFilters(PageFilters):
    q = Search("name")


class ContributorFilters(PageFilters):
    q = Search("pseudonym")
    kind = django_filters.ChoiceFilter(label="Kind", choices=contributor_kind_choices)


class ContributorQuery(ContributorFilters):
    """Those of REST, which lists the contributors of all campaigns."""

    campaign = django_filters.ChoiceFilter(label="Campaign")
    world_choices = {"campaign": campaign_choices}

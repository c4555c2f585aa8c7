"""The form that starts a run: its fields are the parser's hyperparameters."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.language.texts import Refusal
from annotations.models import Split, World
from annotations.web.forms import choice_field, row_field
from parser_service.parsers.conditions import (
    PAPERS_SOURCES,
    TRAIN_SOURCES,
    Protocol,
    sources_of,
)
from parser_service.parsers.hyperparameters.fields import ConfigField
from parser_service.parsers.pretrained_files import missing_weights
from parser_service.parsers.registry import config_fields, entry, make_config
from parser_service.runs.recommended import train_sources
from parser_service.runs.run_requests import LARGEST_SEED, LEAST_SHARE, MOST_SEEDS, seeds_from

PROTOCOL_LABELS = {
    Protocol.STRICT: "strict: training pairs only",
    Protocol.DOMAIN: "domain: also predicates and ontology",
    Protocol.GRAMMAR: "grammar: also the annotated grammar",
}
# The fields of every parser.
GENERAL = ("split", "train_sources", "protocol", "seed", "seeds", "share")
PREFIX = "config-"  # before the names of hyperparameters
LABELS = {"least_overlap": "Minimum overlap"}  # of hyperparameters whose name says less


class RunForm(forms.Form):
    """What to train, on what. ``config`` holds the hyperparameters, and ``asked_seeds`` the seeds,
    once the form is valid."""

    split = forms.ModelChoiceField(Split.objects.none(), empty_label=None)
    train_sources = forms.ChoiceField(label="Train on", initial="gen")
    protocol = forms.ChoiceField(help_text="What training may know besides its pairs.")
    seed = forms.IntegerField(min_value=0, max_value=LARGEST_SEED, initial=0)
    seeds = forms.IntegerField(
        min_value=1,
        max_value=MOST_SEEDS,
        initial=1,
        help_text="One run per seed, counting up. Results show mean and spread.",
    )
    share = forms.FloatField(
        label="Share of the training pairs, %",
        required=False,
        min_value=100 * LEAST_SHARE,
        max_value=100,
        initial=100,
        widget=forms.NumberInput(attrs={"step": "any"}),
        help_text="Below 100 for learning curves; such runs are left out of the results table.",
    )

    def __init__(self, world: World, parser: str, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.parser = parser
        row_field(self, "split").queryset = world.splits.all()
        choice_field(self, "protocol").choices = [
            (name, PROTOCOL_LABELS[Protocol(name)]) for name in entry(parser).protocols
        ]
        self.fields["protocol"].initial = entry(parser).protocols[0]
        choice_field(self, "train_sources").choices = [
            (each, ", ".join(sources_of(each))) for each in offered_sources(world)
        ]
        for declared in config_fields(parser):
            self.fields[PREFIX + declared.name] = field_for(declared)

    @property
    def general(self) -> list[forms.BoundField]:
        """The fields that every parser has."""
        return [self[name] for name in GENERAL]

    @property
    def named(self) -> list[forms.BoundField]:
        """The hyperparameters that have no default and have to be given."""
        return [self[PREFIX + each.name] for each in config_fields(self.parser) if each.is_required]

    @property
    def hyperparameters(self) -> list[forms.BoundField]:
        """Those that may stay at their defaults."""
        optional = [each for each in config_fields(self.parser) if not each.is_required]
        return [self[PREFIX + each.name] for each in optional]

    @property
    def changed(self) -> list[str]:
        """The labels of the hyperparameters that are not at their default as the form stands."""
        declared = {PREFIX + each.name: each for each in config_fields(self.parser)}
        return [
            str(field.label)
            for field in self.hyperparameters
            if str(field.value() or "") != str(declared[field.name].default or "")
        ]

    @property
    def has_faulty_hyperparameter(self) -> bool:
        return any(name.startswith(PREFIX) for name in self.errors)

    @property
    def missing(self) -> str | None:
        """Which pretrained weights, or server, the parser lacks as the form stands, and where to put them."""
        names = {
            each.name: named
            for each in config_fields(self.parser)
            if each.type is str and not each.choices
            if (named := str(self[PREFIX + each.name].value() or "").strip())
        }
        return missing_weights(make_config(self.parser, names), anywhere=False)

    @property
    def asked(self) -> dict[str, Any]:
        """The arguments of ``start_runs``, once the form is valid."""
        names = ("split", "protocol", "train_sources")
        return {
            **{name: self.cleaned_data[name] for name in names},
            "parser": self.parser,
            "config": self.config,
            "seeds": self.asked_seeds,
            "train_share": self.cleaned_data["share"] / 100,
        }

    def clean_share(self) -> float:
        """Return the percentage; all pairs where the field is empty."""
        share = self.cleaned_data["share"]
        return 100.0 if share is None else share

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        self.config = {
            name.removeprefix(PREFIX): value
            for name, value in cleaned.items()
            if name.startswith(PREFIX)
        }
        if self.errors:
            return cleaned
        try:
            make_config(self.parser, self.config)
        except Refusal as error:
            # A complaint that begins with the name of a hyperparameter is shown beside its field.
            field = PREFIX + error.message.partition(" ")[0]
            self.add_error(field if field in self.fields else None, error.message)
        try:
            self.asked_seeds = seeds_from(cleaned["seed"], cleaned["seeds"])
        except Refusal as error:
            self.add_error("seeds", error.message)
        return cleaned


def offered_sources(world: World) -> list[str]:
    """Return what runs of ``world`` can be trained on: what the paper has, and whatever its splits can give."""
    there = set[str]().union(*map(train_sources, world.splits.all()))
    return [
        each
        for each in TRAIN_SOURCES
        if each in PAPERS_SOURCES or there.issuperset(sources_of(each))
    ]


def say_default(declared: ConfigField) -> str:
    """Return the default of a hyperparameter as a sentence, such as ``Default 0.1.``; nothing where it has
    to be given."""
    if declared.is_required:
        return ""
    if declared.type is bool:
        return f"Default {'on' if declared.default else 'off'}."
    if declared.type is float:
        return f"Default {declared.default:g}."
    return f"Default {declared.default}." if declared.default != "" else "Default: none."


def field_for(declared: ConfigField) -> forms.Field:
    """Return a form field for one hyperparameter, with its default and its bounds."""
    common: dict[str, Any] = {
        "label": LABELS.get(declared.name, declared.name.replace("_", " ").capitalize()),
        "initial": declared.default,
        "help_text": f"{declared.description} {say_default(declared)}".rstrip(),
    }
    if declared.type is bool:
        return forms.BooleanField(required=False, **common)
    if declared.choices:
        return forms.ChoiceField(choices=[(name, name) for name in declared.choices], **common)
    if declared.type is str:
        # A text that names something by default is never left empty: it would name nothing.
        required = bool(declared.default) or declared.is_required
        return forms.CharField(required=required, max_length=declared.longest, **common)
    bounds: dict[str, Any] = {"min_value": declared.minimum, "max_value": declared.maximum}
    if declared.type is int:
        return forms.IntegerField(**common, **bounds)
    return forms.FloatField(widget=forms.NumberInput(attrs={"step": "any"}), **common, **bounds)

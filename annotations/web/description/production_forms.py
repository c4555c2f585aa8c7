"""The form of a production."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.editing.once_keys import new_key
from annotations.generation.production_check import (
    EXPANSION_FIELD,
    CheckedProduction,
    ProductionEdit,
    check_production,
)
from annotations.language.corpus import require_nonterminal
from annotations.language.texts import MAX_NONTERMINAL, MAX_PATTERN, LanguageError, Problem
from annotations.models import Editable, Production, TaskCategory, World
from annotations.rows.composition import own_category, split_entry
from annotations.web.forms import choice_field, sentence_of


def sources_of(world: World) -> list[str]:
    """Return the names of the files that the world's grammar comes from."""
    categories = TaskCategory.objects.filter(grammar__world=world)
    entries = (entry for category in categories for entry in category.rule_sources)
    return list(dict.fromkeys(split_entry(entry)[0] for entry in entries))


class ProductionForm(forms.Form):
    """A line of the grammar. The nonterminal of a stored one changes only by renaming.

    ``checked`` is what the checker says, once the form has been validated.
    """

    nonterminal = forms.CharField(
        max_length=MAX_NONTERMINAL, help_text="Without the dollar sign, such as vbfind."
    )
    expansion = forms.CharField(
        max_length=MAX_PATTERN,
        widget=forms.Textarea(
            attrs={"rows": 2, "data-editor": "pattern", "placeholder": "go to the {room}"}
        ),
    )
    source = forms.ChoiceField(label="File")
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(self, world: World, row: Production | None, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.world = world
        self.row = row
        self.checked: CheckedProduction | None = None
        sources = sources_of(world)
        if row and row.source not in sources:
            sources.append(row.source)
        choice_field(self, "source").choices = [(name, name) for name in sources]
        for name in ("nonterminal", "source"):
            self.fields[name].disabled = row is not None

    def clean_nonterminal(self) -> str:
        name = str(self.cleaned_data["nonterminal"]).removeprefix("$")
        if self.row is None:
            try:
                require_nonterminal(name)
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
        return name

    def clean_expansion(self) -> str:
        return " ".join(self.cleaned_data["expansion"].split())

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        if self.errors:
            return cleaned
        self.checked = check_production(self.edit)
        for problem in filter(lambda each: each.is_error, self.checked.problems):
            self.add_error(
                EXPANSION_FIELD, sentence_of(LanguageError(problem.message, hint=problem.hint))
            )
        return cleaned

    @property
    def remarks(self) -> tuple[Problem, ...]:
        """What the checker says; nothing before the form has been validated."""
        return tuple(self.checked.problems) if self.checked else ()

    @property
    def edit(self) -> ProductionEdit:
        """What saving the form would change, once its fields are valid."""
        sent = self.cleaned_data
        return ProductionEdit(
            self.world, sent["source"], sent["nonterminal"], sent["expansion"], self.row
        )


def unsaved_production(world: World, form: ProductionForm) -> Production:
    """Return the production that a valid form describes."""
    source = form.cleaned_data["source"]
    return Production(
        grammar=world.grammar,
        source=source,
        nonterminal=form.cleaned_data["nonterminal"],
        expansion=form.cleaned_data["expansion"],
        task_category=own_category(world.grammar.task_categories.all(), source),
    )


def initial_values(row: Editable) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    names = ("nonterminal", "expansion", "source", "version")
    return {name: getattr(row, name) for name in names}

"""The form of a production."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.generation.production_check import (
    EXPANSION_FIELD,
    CheckedProduction,
    ProductionEdit,
    check_production,
)
from annotations.language.corpus import require_nonterminal
from annotations.language.texts import MAX_NONTERMINAL, MAX_PATTERN, LanguageError, Problem
from annotations.models import Production, TaskCategory, World
from annotations.rows.composition import own_category, split_entry
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import choice_field, sentence_of


def sources_of(world: World) -> list[str]:
    """Return the names of the files that the world's grammar comes from."""
    categories = TaskCategory.objects.filter(grammar__world=world)
    entries = (entry for category in categories for entry in category.rule_sources)
    return list(dict.fromkeys(split_entry(entry)[0] for entry in entries))


class ProductionForm(NounForm):
    """A line of the grammar. The nonterminal of a stored one changes only by renaming.

    ``checked`` is what the checker says, once the form has been validated.
    """

    model = Production
    fixed = ("nonterminal", "source")
    edited = ("expansion",)
    key = "nonterminal"

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

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(world, *args, **options)
        self.checked: CheckedProduction | None = None
        sources = sources_of(world)
        if self.row and self.row.source not in sources:
            sources.append(self.row.source)
        choice_field(self, "source").choices = [(name, name) for name in sources]

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

    def unsaved(self) -> Production:
        sent, grammar = self.cleaned_data, self.world.grammar
        return Production(
            grammar=grammar,
            **{name: sent[name] for name in (*self.fixed, *self.edited)},
            task_category=own_category(grammar.task_categories.all(), sent["source"]),
        )

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

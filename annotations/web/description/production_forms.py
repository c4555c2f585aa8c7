"""The form of a production."""

from __future__ import annotations

from typing import Any

from django import forms
from django.db import transaction

from annotations.editing.task_categories import begin_grammar
from annotations.generation.production_check import (
    EXPANSION_FIELD,
    CheckedProduction,
    ProductionEdit,
    check_production,
)
from annotations.language.corpus import require_nonterminal
from annotations.language.texts import MAX_NONTERMINAL, MAX_PATTERN, LanguageError, Problem
from annotations.models import Editable, Grammar, Production, User, World
from annotations.rows.composition import (
    RULES,
    categories_to_write_for,
    new_category,
    own_category,
    plain_name,
    require_set_name,
    rule_files,
    set_called,
    split_entry,
)
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import sentence_of

MAX_SOURCE = 200


class ProductionForm(NounForm):
    """A line of the grammar. The nonterminal of a stored one changes only by renaming.

    ``checked`` is what the checker says, once the form has been validated.
    """

    model = Production
    fixed = ("nonterminal", "source")
    edited = ("expansion",)
    key = "nonterminal"

    nonterminal = forms.CharField(max_length=MAX_NONTERMINAL, help_text="Without the dollar sign.")
    expansion = forms.CharField(
        max_length=MAX_PATTERN,
        widget=forms.Textarea(attrs={"rows": 2, "data-editor": "pattern"}),
    )
    source = forms.CharField(label="Set", max_length=MAX_SOURCE, required=False)

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(world, *args, **options)
        self.checked: CheckedProduction | None = None
        if first := world.entity_classes.first():
            self.fields["expansion"].widget.attrs["placeholder"] = f"go to the {{{first.token}}}"
        self.categories = categories_to_write_for(world)
        self.sets = rule_files(self.categories)
        if self.row and self.row.source not in self.sets:
            self.sets.append(self.row.source)
        several = forms.Select(choices=[(name, plain_name(name)) for name in self.sets])
        self.fields["source"].widget = several if len(self.sets) > 1 else forms.HiddenInput()

    def clean_nonterminal(self) -> str:
        name = str(self.cleaned_data["nonterminal"]).removeprefix("$")
        if self.row is None:
            try:
                require_nonterminal(name)
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
        return name

    def clean_source(self) -> str:
        """Return the set: that of the only task category where none is sent, the name of the first in a new world."""
        source = set_called(str(self.cleaned_data["source"]).strip(), RULES, self.sets)
        is_named = source != RULES
        if self.row is not None or source in self.sets:
            return source
        if not is_named and len(self.categories) == 1:
            return split_entry(self.categories[0].rule_sources[-1])[0]
        if is_named and self.begins_grammar:
            try:
                require_set_name(plain_name(source))
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
            self.categories = [new_category(None, plain_name(source))]
            return source
        said = f"There is no set “{plain_name(source)}”." if is_named else "There are several sets."
        names = ", ".join(map(plain_name, self.sets))
        raise forms.ValidationError(
            f"{said} Choose of: {names}. A new task category begins a new set."
        )

    @property
    def begins_grammar(self) -> bool:
        """Whether the world has no task category yet, so that its first production makes one."""
        return self.categories[0].pk is None

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

    def store(self, by: User, once: str = "") -> Editable:
        with transaction.atomic():
            begin_grammar(self.world, self.categories[0].name, by)
            return super().store(by, once)

    def unsaved(self) -> Production:
        sent, grammar = self.cleaned_data, Grammar.objects.get(world=self.world)
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

"""The form of a task category."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django import forms

from annotations.generation.category_uses import require_finite
from annotations.language.corpus import require_nonterminal
from annotations.language.texts import LanguageError
from annotations.models import Grammar, TaskCategory, World
from annotations.rows.composition import (
    RULES,
    TEMPLATES,
    new_category,
    plain_name,
    require_set_name,
    set_called,
    split_entry,
)
from annotations.rows.row_kinds import as_text
from annotations.web.description.entity_forms import LinesField
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import sentence_of

MOST_CHARACTERS_OF_SETS = 5_000
MOST_CHARACTERS_OF_SET = 100


class TaskCategoryForm(NounForm):
    """A task category. The name of a stored one changes by renaming. Without sets it has its own alone."""

    model = TaskCategory
    fixed = ("name",)
    edited = ("rule_sources", "template_sources")
    key = "name"

    name = forms.CharField(
        max_length=60, help_text="What these commands have in common, such as watering."
    )
    rule_sources = LinesField(
        label="Sets of productions",
        max_length=MOST_CHARACTERS_OF_SETS,
        help_text="One a line, its own last: new productions go there. A new name begins a new set.",
    )
    template_sources = LinesField(
        label="Sets of templates",
        max_length=MOST_CHARACTERS_OF_SETS,
        help_text="One a line, its own last: new templates go there. Where two give a command different forms, "
        "the later set wins.",
    )

    @classmethod
    def shown(cls, row: Any) -> dict[str, Any]:
        return {name: as_text(value) for name, value in super().shown(row).items()}

    @classmethod
    def typed(cls, sent: Mapping[str, Any]) -> dict[str, Any]:
        return {name: as_text(value) for name, value in sent.items()}

    def clean_name(self) -> str:
        name = " ".join(self.cleaned_data["name"].split())
        if self.row is None:
            try:
                require_set_name(name)
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
        return name

    def clean_rule_sources(self) -> list[str]:
        return self._sets("rule_sources", RULES)

    def clean_template_sources(self) -> list[str]:
        return self._sets("template_sources", TEMPLATES)

    def _sets(self, name: str, ending: str) -> list[str]:
        """Return the sets of a field, its own where none is sent. Those that are stored need no check."""
        entries_there = [each for row in categories_of(self.world) for each in getattr(row, name)]
        files = [split_entry(each)[0] for each in entries_there]
        entries = []
        for text in self.cleaned_data[name]:
            called, alias = split_entry(text)
            source = set_called(called, ending, files)
            entry = f"{source} as ${alias}" if alias else source
            try:
                if source not in files:
                    require_set_name(plain_name(source))
                if alias:
                    require_nonterminal(alias)
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
            if len(entry) > MOST_CHARACTERS_OF_SET:
                raise forms.ValidationError(
                    f"“{called[:60]}…” is too long; {MOST_CHARACTERS_OF_SET} characters are the limit."
                )
            entries.append(entry)
        if entries:
            return entries
        own: list[str] = getattr(
            self.row or new_category(None, self.cleaned_data.get("name", "")), name
        )
        return own

    def clean(self) -> dict[str, Any]:
        if not self.errors:
            name = self.row.name if self.row else self.cleaned_data["name"]
            try:
                require_finite(self.world, TaskCategory(name=name, **self.values))
            except LanguageError as error:
                self.add_error("rule_sources", sentence_of(error))
        return self.cleaned_data

    @property
    def repeated(self) -> str:
        name = self.cleaned_data["name"]
        if not categories_of(self.world).filter(name__iexact=name).exists():
            return ""
        return (
            f"There is a task category “{name}” already. Change that one, or choose another name."
        )

    def unsaved(self) -> TaskCategory:
        return TaskCategory(
            grammar=Grammar.objects.get_or_create(world=self.world)[0],
            name=self.cleaned_data["name"],
            **self.values,
        )


def categories_of(world: World) -> Any:
    return TaskCategory.objects.filter(grammar__world=world)

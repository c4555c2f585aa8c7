"""The form that gives a row another name."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.editing.world_rename import TouchedRows, touched_by
from annotations.language.texts import MAX_ENTITY, LanguageError
from annotations.models import Editable, Entity, Primitive, Production, TaskCategory
from annotations.web.forms import choice_field, sentence_of


def names_of(row: Editable) -> list[str]:
    """Return what ``row`` is called: one name, or the text and the aliases of an entity."""
    if isinstance(row, Entity):
        return [row.text, *row.aliases]
    if isinstance(row, Primitive | TaskCategory):
        return [row.name]
    return [row.nonterminal if isinstance(row, Production) else str(row)]


class RenameForm(forms.Form):
    """A new name for a row. ``touched`` holds the rows that change with it, once the form is valid."""

    old = forms.ChoiceField(label="Name")
    new = forms.CharField(label="New name", max_length=MAX_ENTITY)
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)

    def __init__(self, row: Editable, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.row = row
        self.touched: tuple[TouchedRows, ...] = ()
        names = names_of(row)
        choice_field(self, "old").choices = [(name, name) for name in names]
        if len(names) == 1:
            self.fields["old"].widget = forms.HiddenInput()
        self.initial = {"old": names[0], "new": names[0], "version": row.version, **self.initial}

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        if not self.errors:
            try:
                self.touched = touched_by(self.row, cleaned["old"], cleaned["new"])
            except LanguageError as error:
                self.add_error("new", sentence_of(error))
        return cleaned

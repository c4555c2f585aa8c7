"""What the forms of all rows that people edit have in common."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from django import forms

from annotations.editing.edits import add
from annotations.editing.once_keys import new_key
from annotations.language.texts import Problem
from annotations.models import Editable, User, World


class NounForm(forms.Form):
    """A row as a person writes it, or a program sends it.

    Args:
        row: the stored one that is edited; None for a new one.
        data: what was sent.
    """

    model: ClassVar[type[Editable]]
    fixed: ClassVar[Sequence[str]] = ()  # columns that a stored row keeps, or changes by renaming
    edited: ClassVar[Sequence[str]] = ()  # the other columns that the fields fill
    key: ClassVar[str]  # the field that tells of a row that is there already

    version = forms.IntegerField(widget=forms.HiddenInput, required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(
        self,
        world: World,
        row: Any | None = None,
        data: Mapping[str, Any] | None = None,
        **options: Any,
    ):
        if row is not None:
            options.setdefault("initial", self.shown(row))
        super().__init__(data, **options)
        self.world = world
        self.row = row
        for name in self.fixed:
            self.fields[name].disabled = row is not None

    @classmethod
    def shown(cls, row: Any) -> dict[str, Any]:
        """Return what the fields show for ``row``."""
        return {name: getattr(row, name) for name in (*cls.fixed, *cls.edited, "version")}

    @classmethod
    def typed(cls, sent: Mapping[str, Any]) -> dict[str, Any]:
        """Return what a person would type for the JSON that a program sends."""
        return dict(sent)

    @property
    def values(self) -> Mapping[str, Any]:
        """The values of the columns that change, once the form is valid."""
        return {name: self.cleaned_data[name] for name in self.edited}

    def unsaved(self) -> Editable:
        """Return the new row that the valid form describes."""
        fixed = {name: self.cleaned_data[name] for name in self.fixed}
        model: Any = self.model
        row: Editable = model(world=self.world, **fixed, **self.values)
        return row

    def store(self, by: User, once: str = "") -> Editable:
        """Store the new row that the valid form describes, as ``add`` does."""
        return add(self.unsaved(), by, once)

    @property
    def repeated(self) -> str:
        """The sentence for a new row that is there already; empty where it is not."""
        return ""

    @property
    def remarks(self) -> Sequence[Problem]:
        """What the checker says of what the valid form holds, beside its errors."""
        return ()

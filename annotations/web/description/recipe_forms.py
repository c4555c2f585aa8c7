"""The forms of a recipe book: of one row, and of the whole."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.editing.once_keys import new_key
from annotations.generation.recipe_check import BookRow, CheckedRow, RowModel, check_row
from annotations.language.plans import MAX_ROW, RecipeBook, read_book, shipped_books
from annotations.language.texts import LanguageError, Problem
from annotations.models import Primitive, World

MOST_OF_A_BOOK = 100_000  # characters of all its primitives, or recipes


class BookRowForm(forms.Form):
    """A primitive or a recipe, as text. The name of a stored primitive changes only by renaming."""

    text = forms.CharField(
        max_length=MAX_ROW,
        widget=forms.Textarea(attrs={"rows": 5, "class": "mono", "spellcheck": "false"}),
    )
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(
        self, world: World, model: RowModel, row: BookRow | None, *args: Any, **kwargs: Any
    ):
        # A comment below has a text, too.
        super().__init__(*args, **{**kwargs, "auto_id": "row_%s"})
        self.world = world
        self.model = model
        self.row = row
        self.checked = CheckedRow(())
        self.values: dict[str, str] = {}
        is_primitive = model is Primitive
        self.fields["text"].label = "Primitive" if is_primitive else "Recipe"

    def clean_text(self) -> str:
        # A row is one line; each character keeps its place for what the checker says of it.
        text = str(self.cleaned_data["text"]).replace("\r\n", "\n").replace("\n", " ")
        self.checked = check_row(self.world, self.model, text, self.row)
        if error := self.checked.error:
            raise forms.ValidationError(_say(error))
        try:
            self.values = self.model.columns_of(text)
        except LanguageError as refused:
            raise forms.ValidationError(_say(refused.problem)) from refused
        if isinstance(self.row, Primitive) and self.values["name"] != self.row.name:
            said = f"This primitive is called {self.row.name}. “Rename” changes its name in all recipes."
            raise forms.ValidationError(said)
        return text


class RecipeBookForm(forms.Form):
    """A whole book: one that ships by its name, or the rows of another, one a line.

    Without rows the world has no book of its own.
    """

    shipped = forms.ChoiceField(required=False)
    primitives = forms.CharField(required=False, max_length=MOST_OF_A_BOOK)
    recipes = forms.CharField(required=False, max_length=MOST_OF_A_BOOK)
    version = forms.CharField(required=False, max_length=40)

    def __init__(self, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        field = self.fields["shipped"]
        assert isinstance(field, forms.ChoiceField)
        field.choices = [(name, each.title) for name, each in shipped_books().items()]
        self.problems: tuple[Problem, ...] = ()

    def clean(self) -> dict[str, Any]:
        sent = self.cleaned_data
        if not self.errors and not sent["shipped"]:
            self.book, self.problems = read_book(sent["primitives"], sent["recipes"])
            if error := next((each for each in self.problems if each.is_error), None):
                raise forms.ValidationError(f"{error.position}: {_say(error)}")
            if self.book.primitives and not self.book.recipes:
                raise forms.ValidationError("The book has primitives, but no recipe.")
        elif not self.errors:
            self.book = shipped_books()[sent["shipped"]].book
        return sent

    book: RecipeBook


def initial_values(row: Any) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    return {"text": row.text, "version": row.version}


def _say(problem: Problem) -> str:
    hint = f" {problem.hint[:1].upper()}{problem.hint[1:]}." if problem.hint else ""
    return f"{problem.message[:1].upper()}{problem.message[1:]}.{hint}"

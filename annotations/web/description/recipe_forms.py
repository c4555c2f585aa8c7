"""The forms of a recipe book: of one row, and of the whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

from django import forms

from annotations.generation.recipe_check import CheckedRow, RowModel, check_row
from annotations.language.plans import RecipeBook, read_book, shipped_books
from annotations.language.texts import MAX_ROW, LanguageError, Problem
from annotations.models import Primitive, Recipe
from annotations.web.editing.noun_forms import NounForm

MOST_OF_A_BOOK = 100_000  # characters of all its primitives, or recipes


class BookRowForm(NounForm):
    """A primitive or a recipe, as text."""

    model: ClassVar[RowModel]
    edited = ("text",)
    key = "text"

    text = forms.CharField(
        max_length=MAX_ROW,
        widget=forms.Textarea(attrs={"rows": 5, "class": "mono", "spellcheck": "false"}),
    )

    def __init__(self, *args: Any, **options: Any):
        super().__init__(*args, auto_id="row_%s", **options)  # a comment below has a text, too
        self.checked = CheckedRow(())
        self.columns: Mapping[str, str] = {}
        self.fields["text"].label = str(self.model._meta.verbose_name).capitalize()

    def clean_text(self) -> str:
        # A row is one line; each character keeps its place for what the checker says of it.
        text = str(self.cleaned_data["text"]).replace("\r\n", "\n").replace("\n", " ")
        self.checked = check_row(self.world, self.model, text, self.row)
        if error := self.checked.error:
            raise forms.ValidationError(_say(error))
        try:
            self.columns = self.model.columns_of(text)
        except LanguageError as refused:
            raise forms.ValidationError(_say(refused.problem)) from refused
        return text

    @property
    def values(self) -> Mapping[str, str]:
        return self.columns

    @property
    def remarks(self) -> Sequence[Problem]:
        return self.checked.problems


class RecipeForm(BookRowForm):
    model = Recipe


class PrimitiveForm(BookRowForm):
    """The name of a stored primitive changes only by renaming."""

    model = Primitive

    def clean_text(self) -> str:
        text = super().clean_text()
        if self.row and self.columns["name"] != self.row.name:
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


def _say(problem: Problem) -> str:
    hint = f" {problem.hint[:1].upper()}{problem.hint[1:]}." if problem.hint else ""
    return f"{problem.message[:1].upper()}{problem.message[1:]}.{hint}"

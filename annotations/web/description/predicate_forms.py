"""The form of a predicate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django import forms

from annotations.language.corpus import require_predicate
from annotations.language.texts import MAX_GLOSS, MAX_PREDICATE, LanguageError
from annotations.language.world import (
    Predicate,
    PredicateKind,
    Signature,
    known_kinds,
    print_signatures,
    read_signatures,
)
from annotations.models import Predicate as StoredPredicate
from annotations.models import World
from annotations.models.description import predicate_kind_choices
from annotations.rows.from_rows import classes_of, predicate_of
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import sentence_of


class PredicateForm(NounForm):
    """A predicate. The name of a stored one changes only by renaming."""

    model = StoredPredicate
    fixed = ("name",)
    key = "name"

    name = forms.CharField(max_length=MAX_PREDICATE, help_text="Such as is_near.")
    kind = forms.ChoiceField(
        choices=predicate_kind_choices,
        help_text="An action is something to do; a description says something about a variable.",
    )
    signatures = forms.CharField(
        label="Arguments",
        max_length=5_000,
        widget=forms.Textarea(attrs={"rows": 3}),
    )
    gloss = forms.CharField(
        label="English",
        max_length=MAX_GLOSS,
        required=False,
        help_text="{1} is the first argument, _ what a description describes; | separates "
        "alternatives. Empty: made from the name.",
    )

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(world, *args, **options)
        self.classes = classes_of(world)
        if len(first_two := self.classes.tokens[:2]) == 2:
            self.fields["signatures"].widget.attrs["placeholder"] = "({}, {}?)".format(*first_two)
        self.fields["signatures"].help_text = (
            "One way to use it a line; ? marks arguments at the end that may be missing. "
            f"Kinds: {', '.join(known_kinds(self.classes))}."
        )

    def clean_name(self) -> str:
        name = str(self.cleaned_data["name"])
        if self.row is None:
            try:
                require_predicate(name)
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
        return name

    def clean_signatures(self) -> tuple[Signature, ...]:
        try:
            return read_signatures(self.cleaned_data["signatures"], self.classes)
        except LanguageError as error:
            raise forms.ValidationError(sentence_of(error)) from error

    @classmethod
    def shown(cls, row: Any) -> dict[str, Any]:
        names = ("name", "kind", "gloss", "version")
        signatures = print_signatures(predicate_of(row).signatures)
        return {**{name: getattr(row, name) for name in names}, "signatures": signatures}

    @classmethod
    def typed(cls, sent: Mapping[str, Any]) -> dict[str, Any]:
        lines = [f"({', '.join(each)})" for each in sent.get("signatures", ())]
        return {**sent, "signatures": "\n".join(lines)} if "signatures" in sent else dict(sent)

    @property
    def repeated(self) -> str:
        is_there = self.world.predicates.filter(name=self.cleaned_data["name"]).exists()
        return "There is a predicate of this name already. Change that one." if is_there else ""

    @property
    def predicate(self) -> Predicate:
        """The predicate as it is typed, once the form is valid."""
        sent = self.cleaned_data
        kind = PredicateKind(sent["kind"])
        return Predicate(sent["name"], kind, sent["signatures"], sent["gloss"])

    @property
    def values(self) -> dict[str, Any]:
        """The values to store beside the name."""
        typed = self.predicate
        signatures = [list(map(str, each.arguments)) for each in typed.signatures]
        return {"kind": str(typed.kind), "signatures": signatures, "gloss": typed.gloss}

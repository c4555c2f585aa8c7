"""The form of a class of entities."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.language.forms import (
    HUES,
    MAX_CLASS_WORDS,
    MAX_TOKEN,
    MOST_CLASSES,
    new_hue,
    require_token,
)
from annotations.language.texts import LanguageError, Position, plural, require_writable
from annotations.models import EntityClass
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import sentence_of


class EntityClassForm(NounForm):
    """A class of entities. The token of a stored one does not change: templates, forms and commands have it."""

    model = EntityClass
    fixed = ("token",)
    edited = ("singular", "plural", "said", "hue", "is_closed")
    key = "token"

    token = forms.CharField(
        max_length=MAX_TOKEN,
        help_text="The word of its wildcard and its class token: pose for {pose} and <pose>.",
    )
    singular = forms.CharField(
        max_length=MAX_CLASS_WORDS,
        required=False,
        help_text="One of them: pose. Empty: as the token says.",
    )
    plural = forms.CharField(
        max_length=MAX_CLASS_WORDS,
        required=False,
        help_text="Several: poses. Empty: made from the word for one.",
    )
    said = forms.CharField(
        label="Said",
        max_length=MAX_CLASS_WORDS,
        required=False,
        help_text="The noun for one that a form leaves open, without an article. Empty: the word for one.",
    )
    hue = forms.IntegerField(
        min_value=0,
        max_value=HUES - 1,
        required=False,
        help_text="The angle of its colour: 30 is orange, 145 green. Empty: unlike the others.",
    )
    is_closed = forms.BooleanField(
        label="Closed",
        required=False,
        help_text="All members are listed, and each is a description or a sentence, such as “waving”. "
        "Members of other classes are nouns, which also come in the plural.",
    )

    def clean_token(self) -> str:
        token = str(self.cleaned_data["token"])
        if self.row is None:
            try:
                require_token(token)
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
            if self.world.entity_classes.count() >= MOST_CLASSES:
                raise forms.ValidationError(f"A world has at most {MOST_CLASSES} classes.")
        return token

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        for name in ("singular", "plural", "said"):
            words = " ".join(cleaned.get(name, "").split())
            try:
                require_writable(words, Position())
            except LanguageError as error:
                self.add_error(name, sentence_of(error))
            if name in cleaned:
                cleaned[name] = words
        if not self.errors:
            one = cleaned["singular"] = cleaned["singular"] or cleaned["token"].replace("_", " ")
            cleaned["plural"] = cleaned["plural"] or plural(one)[:MAX_CLASS_WORDS]
            cleaned["said"] = cleaned["said"] or one
            if cleaned["hue"] is None:
                cleaned["hue"] = new_hue(self.world.entity_classes.all().as_value())
        return cleaned

    @property
    def repeated(self) -> str:
        is_there = self.world.entity_classes.filter(token=self.cleaned_data["token"]).exists()
        return "There is a class of this token already. Change that one." if is_there else ""

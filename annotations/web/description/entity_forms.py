"""The forms of entities: one, and many at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

from django import forms

from annotations.editing.once_keys import new_key
from annotations.language.corpus import require_entity_name
from annotations.language.texts import (
    MAX_ENTITY,
    LanguageError,
    Position,
    Problem,
    require_writable,
)
from annotations.language.world import Additions, additions_to, read_entities
from annotations.language.world import Entity as EntityValue
from annotations.models import Entity, Ontology, World
from annotations.rows.from_rows import classes_of, ontology_of
from annotations.rows.row_kinds import as_text
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import sentence_of


def class_field(world: World) -> forms.ChoiceField:
    """Return the field for the class of an entity, with those that the world has."""
    tokens = classes_of(world).tokens
    there = f"there are {', '.join(tokens)}" if tokens else "there is none yet"
    said = f"There is no class “%(value)s”; {there}. Add it to the classes of entities first."
    choices = [(name, name) for name in tokens]
    return forms.ChoiceField(
        label="Class", choices=choices, error_messages={"invalid_choice": said}
    )


ATTRIBUTE_LINES = "One a line: a name, a colon, a value."


class LinesField(forms.CharField):
    """A text area whose value is the list of its lines, without empty and repeated ones."""

    def __init__(self, **kwargs: Any):
        super().__init__(widget=forms.Textarea(attrs={"rows": 3}), required=False, **kwargs)

    def clean(self, value: Any) -> list[str]:
        lines = (" ".join(line.split()) for line in super().clean(value).splitlines())
        return list(dict.fromkeys(filter(None, lines)))


class AttributeLinesField(forms.CharField):
    """A text area with ``name: value``, one a line; its value is a dictionary."""

    def __init__(self, **kwargs: Any):
        super().__init__(widget=forms.Textarea(attrs={"rows": 3}), required=False, **kwargs)

    def clean(self, value: Any) -> dict[str, str]:
        attributes: dict[str, str] = {}
        for line in filter(str.strip, super().clean(value).splitlines()):
            name, colon, text = (part.strip() for part in line.partition(":"))
            if not (name and colon and name.replace("_", "").replace("-", "").isalnum()):
                raise forms.ValidationError(f"Write name: value in the line “{line.strip()[:60]}”.")
            try:
                require_writable(line, Position())
            except LanguageError as error:
                raise forms.ValidationError(sentence_of(error)) from error
            attributes[name] = text
        return attributes


class EntityForm(NounForm):
    """One entity. The name of a stored one changes only by renaming."""

    model = Entity
    fixed = ("text",)
    edited = ("entity_class", "aliases", "attributes")
    key = "text"

    entity_class = forms.ChoiceField(label="Class")
    text = forms.CharField(label="Name", max_length=MAX_ENTITY)
    aliases = LinesField(
        max_length=20_000, help_text="Other names that people use for it, one a line."
    )
    attributes = AttributeLinesField(max_length=20_000, help_text=ATTRIBUTE_LINES)

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(world, *args, **options)
        if self.row is None and not self.is_bound:
            self.fields["text"].widget.attrs["autofocus"] = True
        self.fields["entity_class"] = class_field(world)

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        names = [("aliases", alias) for alias in cleaned.get("aliases", ())]
        if self.row is None and "text" in cleaned:
            cleaned["text"] = " ".join(cleaned["text"].split())
            names.append(("text", cleaned["text"]))
        for field, name in names:
            try:
                require_entity_name(name)
            except LanguageError as error:
                self.add_error(field, sentence_of(error))
        return cleaned

    @classmethod
    def shown(cls, row: Any) -> dict[str, Any]:
        return {name: as_text(value) for name, value in super().shown(row).items()}

    @classmethod
    def typed(cls, sent: Mapping[str, Any]) -> dict[str, Any]:
        return {name: as_text(value) for name, value in sent.items()}

    def unsaved(self) -> Entity:
        text = self.cleaned_data["text"]
        return Entity(ontology=ontology_in(self.world), text=text, **self.values)

    @property
    def repeated(self) -> str:
        return "This entity is there already." if self.additions.duplicates else ""

    @property
    def remarks(self) -> Sequence[Problem]:
        return self.additions.problems

    @cached_property
    def additions(self) -> Additions:
        """What the checker says of the ontology with this entity, once the fields are valid."""
        rest = Entity.objects.filter(ontology__world=self.world)
        sent = self.cleaned_data
        value = EntityValue(
            sent["entity_class"], sent["text"], tuple(sent["aliases"]), sent["attributes"]
        )
        rows = rest.exclude(pk=self.row.pk) if self.row else rest
        return additions_to(ontology_of(self.world, rows), [value])


class EntitiesForm(forms.Form):
    """Many entities of one class, one a line."""

    entity_class = forms.ChoiceField(label="Class")
    lines = forms.CharField(
        label="Entities",
        max_length=200_000,
        widget=forms.Textarea(attrs={"rows": 10, "placeholder": "name | other name, third name"}),
        help_text="One a line: the name, and after | its other names with commas between them.",
    )
    attributes = AttributeLinesField(
        max_length=20_000,
        label="Attributes of all of them",
        help_text=ATTRIBUTE_LINES,
    )
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.world = world
        self.fields["entity_class"] = class_field(world)

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        if self.errors:
            return cleaned
        entities = read_entities(cleaned["lines"], cleaned["entity_class"], cleaned["attributes"])
        for entity in entities:
            for name in (entity.text, *entity.aliases):
                try:
                    require_entity_name(name)
                except LanguageError as error:
                    self.add_error("lines", f"Line {entity.position.line}: {sentence_of(error)}")
        self.additions = additions_to(ontology_of(self.world), entities)
        return cleaned


def ontology_in(world: World) -> Ontology:
    return Ontology.objects.get_or_create(world=world)[0]

"""The forms of entities: one, and many at a time."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.editing.once_keys import new_key
from annotations.language.corpus import require_entity_name
from annotations.language.texts import MAX_ENTITY, LanguageError, Position, require_writable
from annotations.language.world import Additions, additions_to, read_entities
from annotations.language.world import Entity as EntityValue
from annotations.models import Editable, Entity, Ontology, World
from annotations.rows.from_rows import classes_of, ontology_of
from annotations.rows.row_kinds import as_text
from annotations.web.forms import sentence_of


def class_field(world: World) -> forms.ChoiceField:
    """Return the field for the class of an entity, with those that the world has."""
    choices = [(name, name) for name in classes_of(world).tokens]
    return forms.ChoiceField(label="Class", choices=choices)


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


class EntityForm(forms.Form):
    """One entity. The name of a stored one changes only by renaming."""

    entity_class = forms.ChoiceField(label="Class")
    text = forms.CharField(label="Name", max_length=MAX_ENTITY)
    aliases = LinesField(
        max_length=20_000, help_text="Other names that people use for it, one a line."
    )
    attributes = AttributeLinesField(
        max_length=20_000, help_text="One a line, such as category: drinks or room: kitchen."
    )
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(self, world: World, row: Entity | None, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.world = world
        self.row = row
        self.fields["text"].disabled = row is not None
        if row is None and not self.is_bound:
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

    @property
    def values(self) -> dict[str, Any]:
        names = ("entity_class", "aliases", "attributes", *(() if self.row else ("text",)))
        return {name: self.cleaned_data[name] for name in names}

    @property
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
        widget=forms.Textarea(
            attrs={"rows": 10, "placeholder": "coke | coca cola, soda\ngreen tea"}
        ),
        help_text="One a line: the name, and after | its other names with commas between them.",
    )
    attributes = AttributeLinesField(
        max_length=20_000,
        label="Attributes of all of them",
        help_text="One a line, such as category: drinks or room: kitchen.",
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


def initial_values(row: Editable) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    names = ("entity_class", "text", "aliases", "attributes", "version")
    return {name: as_text(getattr(row, name)) for name in names}

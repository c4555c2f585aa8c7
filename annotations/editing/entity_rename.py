"""Which rows name an entity, and what they say once it has another name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from django.db.models import Model, Q

from annotations.language.corpus import (
    EntityName,
    distance,
    rename_in_attributes,
    rename_in_conditions,
    rename_in_grounded_form,
    rename_in_template,
    rename_in_utterance,
    require_entity_name,
)
from annotations.language.grounding import Anonymizer
from annotations.language.texts import LanguageError
from annotations.models import Entity, Paraphrase, Production, SemanticTemplate, Utterance
from annotations.rows.from_rows import ontology_of

MOST_PARAPHRASES = 20_000  # that a request renames an entity in
RenamedRows = list[tuple[Model, dict[str, Any]]]


class EntityRename:
    """Renames an entity by its text, or an alias of it.

    Rows of one class with the same text are one name, such as a sink in two rooms: they keep one.
    An alias stands in what people say, and nowhere else.
    """

    def __init__(self, row: Entity, old: str) -> None:
        self.row = row
        self.name = EntityName(row.entity_class, old)
        self.is_alias = old != row.text
        self.world = row.ontology.world
        same = row.ontology.entities.filter(entity_class=row.entity_class)
        self.rows = [row] if self.is_alias else list(same.filter(text=row.text))

    def require_free(self, new: str) -> None:
        require_entity_name(new)
        if self.name.text not in (self.row.text, *self.row.aliases):
            raise LanguageError(f"{self.row.text} is not called {self.name.text} any more")
        mine = {row.pk for row in self.rows}
        others = self.row.ontology.entities.filter(entity_class=self.row.entity_class)
        wanted = EntityName(self.row.entity_class, new)
        for other in others.exclude(pk__in=mine):
            if any(wanted.is_written(name) for name in (other.text, *other.aliases)):
                sentence = f"another {self.row.entity_class} is called {new} already"
                raise LanguageError(sentence, hint="choose another name")
        if new == self.name.text:
            raise LanguageError("this is its name already", hint="write another one")

    def changes(self, new: str) -> Iterator[tuple[str, RenamedRows]]:
        yield "entity", self._entities(new)
        if not self.is_alias:
            productions = Production.objects.filter(grammar__world=self.world)
            yield (
                "production",
                differing(
                    (row, {"expansion": rename_in_conditions(row.expansion, self.name, new)})
                    for row in productions.filter(expansion__icontains=self.name.text)
                ),
            )
            templates = SemanticTemplate.objects.filter(grammar__world=self.world)
            yield (
                "template",
                differing(
                    (row, self._template(row, new))
                    for row in templates.filter(
                        Q(pattern__icontains=self.name.text) | Q(form__icontains=self.name.text)
                    )
                ),
            )
            # What people said stays as it is; its spans say which entity it names.
            utterances = Utterance.objects.filter(world=self.world, text__icontains=self.name.text)
            yield (
                "utterance",
                differing((row, {"spans": self._spans(row, new)}) for row in utterances),
            )
        text = self.name.text
        paraphrases = Paraphrase.objects.filter(world=self.world).filter(
            Q(prompt__icontains=text)
            | Q(utterance__icontains=text)
            | Q(grounded_form__icontains=text)
        )
        if paraphrases.count() > MOST_PARAPHRASES:
            raise LanguageError(
                f"more than {MOST_PARAPHRASES:,} paraphrases name it",
                hint="download the world, rename there and import it",
            )
        anonymizer = Anonymizer(ontology_of(self.world))
        yield (
            "paraphrase",
            differing(
                (row, self._paraphrase(row, new, anonymizer)) for row in paraphrases.iterator()
            ),
        )

    def _entities(self, new: str) -> RenamedRows:
        """Return the entity itself, and others whose attributes name it."""
        if self.is_alias:
            aliases = [new if alias == self.name.text else alias for alias in self.row.aliases]
            return [(self.row, {"aliases": list(dict.fromkeys(aliases))})]
        others = self.row.ontology.entities.exclude(pk__in=[row.pk for row in self.rows])
        return [
            *(
                (row, {"text": new, "aliases": [each for each in row.aliases if each != new]})
                for row in self.rows
            ),
            *differing(
                (row, {"attributes": rename_in_attributes(row.attributes, self.name, new)})
                for row in others
            ),
        ]

    def _template(self, row: SemanticTemplate, new: str) -> dict[str, Any]:
        pattern = rename_in_conditions(row.pattern, self.name, new)
        form = row.form
        # Where an entity of another class has the same text, a text in a form may mean that one.
        rows = self.row.ontology.entities.filter(text=self.row.text)
        if not rows.exclude(entity_class=self.row.entity_class).exists():
            pattern, form = rename_in_template(pattern, form, self.name.text, new)
        return {"pattern": pattern, "form": form}

    def _spans(self, row: Utterance, new: str) -> list[list[Any]]:
        mine = [self.name.entity_class, self.name.text]
        return [
            [start, end, *([mine[0], new] if entity == mine else entity)]
            for start, end, *entity in row.spans
        ]

    def _paraphrase(self, row: Paraphrase, new: str, anonymizer: Anonymizer) -> dict[str, Any]:
        prompt, utterance = (
            rename_in_utterance(text, self.name, new, anonymizer)
            for text in (row.prompt, row.utterance)
        )
        values: dict[str, Any] = {"prompt": prompt, "utterance": utterance}
        if (prompt, utterance) != (row.prompt, row.utterance):
            apart = distance(utterance, prompt)
            values |= {"edit_distance": apart.edit, "jaccard_distance": apart.jaccard}
        if self.is_alias:
            return values
        form = rename_in_grounded_form(row.grounded_form, row.logical_form, self.name, new)
        return {**values, "grounded_form": form}


def differing(changes: Iterable[tuple[Model, dict[str, Any]]]) -> RenamedRows:
    """Leave out what stays as it is."""
    return [
        (row, values)
        for row, values in changes
        if any(getattr(row, name) != value for name, value in values.items())
    ]

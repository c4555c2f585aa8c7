"""Where a thing of a world occurs elsewhere in it: what the pages of single rows link to."""

from __future__ import annotations

from dataclasses import dataclass

from django.db.models import Q, QuerySet

from annotations.models import Command, Entity, Example, LogicalForm, Paraphrase, SemanticTemplate

MOST_SHOWN = 20


@dataclass(frozen=True, slots=True)
class EntityOccurrences:
    """What names an entity: some rows of each kind, and the other entities of the same name."""

    namesakes: QuerySet[Entity]
    templates: QuerySet[SemanticTemplate]
    paraphrases: QuerySet[Paraphrase]
    n_commands: int


def occurrences_of(entity: Entity) -> EntityOccurrences:
    """Find the rows of the entity's world that name it, and count the commands of its class."""
    world = entity.ontology.world
    templates = SemanticTemplate.objects.filter(grammar__world=world)
    said = Q(utterance__icontains=entity.text) | Q(prompt__icontains=entity.text)
    token = f"<{entity.entity_class}"
    return EntityOccurrences(
        namesakes=entity.ontology.entities.filter(text=entity.text).exclude(pk=entity.pk),
        templates=templates.filter(
            Q(pattern__icontains=entity.text) | Q(form__icontains=entity.text)
        ),
        paraphrases=world.paraphrases.filter(said),
        n_commands=world.commands.filter(anonymized_text__contains=token).count(),
    )


def examples_of_pair(world_id: int, utterance: str, form: str) -> QuerySet[Example]:
    """Return the examples of splits that were copied from a paraphrase or an utterance with this form."""
    return Example.objects.filter(
        split__world=world_id, utterance=utterance, logical_form=form
    ).select_related("split")


def command_of_example(example: Example) -> Command | None:
    """Return the command that ``example`` was copied from or rewrites, if the world still has it."""
    text = example.source_command or example.utterance
    return example.split.world.commands.filter(anonymized_text=text).first()


def paraphrase_of_example(example: Example) -> Paraphrase | None:
    """Return the paraphrase that ``example`` was copied from, if the world still has it."""
    return example.split.world.paraphrases.filter(
        utterance=example.utterance, logical_form=example.logical_form
    ).first()


def logical_form_of(world_id: int, text: str) -> LogicalForm | None:
    """Return the logical form that is written ``text``, if commands of the world have it."""
    return LogicalForm.objects.filter(world=world_id, text=text).first()

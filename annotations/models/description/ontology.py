"""The things a world is about."""

from __future__ import annotations

from django.db import models

from annotations.language.symbols import ENTITY_CLASSES
from annotations.models.editing import Editable
from annotations.models.worlds import World


def entity_class_choices() -> list[tuple[str, str]]:
    return [(name, name) for name in ENTITY_CLASSES]


class Ontology(models.Model):
    world = models.OneToOneField(World, on_delete=models.CASCADE, related_name="ontology")

    def __str__(self) -> str:
        return f"ontology of {self.world}"


class EntityQuerySet(models.QuerySet["Entity"]):
    def count_by_class(self) -> dict[str, int]:
        """Return how many entities each class has, in the order of the classes; those that have none are left out."""
        counted = self.order_by().values_list("entity_class").annotate(models.Count("pk"))
        counts = dict(counted)
        return {name: counts[name] for name in ENTITY_CLASSES if name in counts}


class Entity(Editable):
    """One row of an ontology file. Rows may repeat a text (a name of either gender, a sink in two rooms)."""

    world_path = "ontology__world"
    edited_fields = ("entity_class", "text", "aliases", "attributes")

    ontology = models.ForeignKey(Ontology, on_delete=models.CASCADE, related_name="entities")
    entity_class = models.CharField(max_length=20, choices=entity_class_choices)
    text = models.TextField()
    aliases = models.JSONField(default=list, blank=True)
    attributes = models.JSONField(default=dict, blank=True)
    source = models.CharField(max_length=200, blank=True)
    line = models.PositiveIntegerField(default=0)
    position = models.PositiveIntegerField()

    objects = EntityQuerySet.as_manager()

    class Meta:
        ordering = ["position"]
        constraints = [
            models.UniqueConstraint(fields=["ontology", "position"], name="entity_position")
        ]
        indexes = [models.Index(fields=["ontology", "entity_class", "text"])]

    def __str__(self) -> str:
        return f"{self.text} ({self.entity_class})"

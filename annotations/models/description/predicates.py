"""The predicates of a world's logical forms."""

from __future__ import annotations

from django.db import models

from annotations.models.editing import Editable
from annotations.models.people import User
from annotations.models.worlds import World


def predicate_kind_choices() -> list[tuple[str, str]]:
    return [("action", "action"), ("sequence", "sequence"), ("description", "description")]


class Predicate(Editable):
    """A name with its signatures (a list of lists of argument kinds) and its English gloss.

    ``is_edited`` says that a person has changed it: from then on an import leaves it alone.
    """

    edited_fields = ("name", "kind", "signatures", "gloss")
    bears_on_commands = True  # templates are checked against it

    world = models.ForeignKey(World, on_delete=models.CASCADE, related_name="predicates")
    name = models.CharField(max_length=80)
    kind = models.CharField(max_length=20, choices=predicate_kind_choices)
    signatures = models.JSONField(default=list)
    gloss = models.CharField(max_length=200, blank=True)
    is_edited = models.BooleanField(default=False)

    class Meta:
        ordering = ["name"]
        constraints = [models.UniqueConstraint(fields=["world", "name"], name="predicate_name")]

    def __str__(self) -> str:
        return self.name

    def note_editor(self, by: User) -> None:
        self.is_edited = True

"""What all rows that people edit have in common: a version, and a history of what they were."""

from __future__ import annotations

from typing import Any, ClassVar

from django.db import models
from django.db.models.signals import post_delete, post_save, pre_delete
from simple_history.models import HistoricalRecords

from annotations.models.people import User
from annotations.models.worlds import World


class Records(HistoricalRecords):
    """The table of a model's history. ``annotations.rows.history`` writes it.

    The signals of django-simple-history are disconnected: they would write a row for each row of a
    world that is deleted, none for bulk writes, and guess the author.
    """

    def finalize(self, sender: type[models.Model], **kwargs: Any) -> None:
        super().finalize(sender, **kwargs)
        post_save.disconnect(self.post_save, sender=sender)
        post_delete.disconnect(self.post_delete, sender=sender)
        pre_delete.disconnect(self.pre_delete, sender=sender)


class Editable(models.Model):
    """A row that people edit. ``annotations.editing`` adds, changes, deletes and restores it.

    ``version`` counts from 1; whoever saves says which version they edited.

    ``world_path`` leads from the row to its world, as in a query. ``edited_fields`` are what people
    write, in the order of the page; ``fields_beside`` what is stored with them. A row that
    ``bears_on_commands`` is of a kind from which commands are generated, or their templates checked.
    """

    world_path: ClassVar[str] = "world"
    edited_fields: ClassVar[tuple[str, ...]] = ()
    fields_beside: ClassVar[tuple[str, ...]] = ()
    bears_on_commands: ClassVar[bool] = False

    version = models.PositiveIntegerField(default=1)
    history = Records(inherit=True)

    class Meta:
        abstract = True

    @property
    def owner(self) -> models.Model:
        """The world, or the grammar or ontology in it, that the row belongs to."""
        return getattr(self, self.world_path.split("__")[0])

    @property
    def owning_world(self) -> World:
        return self.owner if isinstance(self.owner, World) else self.owner.world

    @property
    def makes_commands(self) -> bool:
        """Whether commands are generated from the row as it is, or their templates checked against it."""
        return self.bears_on_commands

    def note_editor(self, by: User) -> None:
        """Take down in the row itself, where it has a field for it, that ``by`` edits it."""

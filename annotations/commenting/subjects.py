"""What comments can be about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.db import models
from django.http import Http404
from django.urls import reverse

from annotations.models import Comment, LogicalForm, World
from annotations.rows.kinds import KINDS


@dataclass(frozen=True, slots=True)
class Subject:
    """A kind of row with the ``name`` that stands in addresses.

    ``page`` is the route of one row, with its key, that shows its comments; empty where only the
    page of comments does. A row ``is_known_by_text`` where it is generated anew under other keys.
    """

    name: str
    model: type[models.Model]
    world_path: str
    page: str = ""
    is_known_by_text: bool = False

    def row(self, world: World, pk: int) -> models.Model:
        """Return a row of ``world``. Raises Http404."""
        rows = self.model._default_manager.filter(**{self.world_path: world})
        if row := rows.filter(pk=pk).first():
            return row
        raise Http404(f"There is no such {self.name}.")

    def address(self, world: World, pk: int) -> str:
        """Return the page that shows a row with its comments."""
        if self.page:
            return reverse(self.page, kwargs={"world": world.name, "pk": pk}) + "#comments"
        return reverse("comments", kwargs={"world": world.name, "kind": self.name, "pk": pk})

    def current_key(self, comment: Comment) -> int | None:
        """Return the key of what ``comment`` is about; None where it is gone."""
        rows = self.model._default_manager.filter(**{self.world_path: comment.world_id})
        named: dict[str, Any] = {"pk": comment.subject}
        if self.is_known_by_text:
            named = {"text": comment.about}
        return rows.filter(**named).values_list("pk", flat=True).first()


SUBJECTS = {
    subject.name: subject
    for subject in (
        *(
            Subject(kind.name, kind.model, kind.model.world_path, kind.page)
            for kind in KINDS.values()
        ),
        Subject("form", LogicalForm, "world", "logical_form", is_known_by_text=True),
    )
}

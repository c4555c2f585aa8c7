"""The classes of the entities."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.generation.class_uses import count_uses
from annotations.models import World
from annotations.people.access import WorldRequest
from annotations.web.description.class_forms import EntityClassForm
from annotations.web.editing.nouns import Noun


class EntityClassNoun(Noun):
    form = EntityClassForm
    template = "annotations/description/entity_class.html"

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: EntityClassForm
    ) -> Mapping[str, Any]:
        return {"uses": count_uses(row)} if row else {}


ENTITY_CLASSES = EntityClassNoun()

"""Predicates, each with its English sentence and the templates that it would break."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.generation.predicate_check import check_predicate
from annotations.models import World
from annotations.people.access import WorldRequest
from annotations.rows.from_rows import predicate_of
from annotations.showing.listing import Sort
from annotations.web.description.description_filters import PredicateFilters
from annotations.web.description.predicate_forms import PredicateForm
from annotations.web.editing.nouns import Noun


class PredicateNoun(Noun):
    form = PredicateForm
    template = "annotations/description/predicate.html"
    preview_template = "annotations/description/_predicate_preview.html"
    list_template = "annotations/description/predicates.html"
    filters = PredicateFilters
    sorts = {"name": Sort("Predicate", "name"), "kind": Sort("Kind", "kind")}

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: PredicateForm
    ) -> Mapping[str, Any]:
        return {"checked": check_predicate(world, predicate_of(row))} if row else {}

    def preview(
        self, request: WorldRequest, world: World, form: PredicateForm
    ) -> Mapping[str, Any]:
        if form.is_valid():
            return {"checked": check_predicate(world, form.predicate)}
        wrong = form.errors.get("signatures")
        return {"trouble": wrong[0]} if wrong else {}


PREDICATES = PredicateNoun()

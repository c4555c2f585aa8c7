"""The lines of the command grammar, checked as one types, with what saving would do."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby
from typing import Any

from django.urls import reverse

from annotations.generation.production_check import (
    ProductionEdit,
    check_production,
    consequences_of_production,
)
from annotations.language.grammar import ROOT
from annotations.language.texts import MAX_PATTERN
from annotations.models import Production, SemanticTemplate, World
from annotations.models.description import ProblemSubject
from annotations.people.access import WorldRequest
from annotations.showing.listing import Listing, Sort
from annotations.web.description.description_filters import ProductionFilters
from annotations.web.description.production_forms import ProductionForm
from annotations.web.editing.consequence_presentation import groups_of
from annotations.web.editing.nouns import Noun


class ProductionNoun(Noun):
    form = ProductionForm
    template = "annotations/description/production.html"
    preview_template = "annotations/description/_production_preview.html"
    list_template = "annotations/description/grammar.html"
    filters = ProductionFilters
    page_size = 50
    sorts = {
        "position": Sort("File and line", "position"),
        "nonterminal": Sort("Nonterminal", "nonterminal"),
    }

    def list_context(self, world: World, listing: Listing) -> Mapping[str, Any]:
        """Return the productions by nonterminal, with the checker's problems."""
        grouped = groupby(listing.rows, key=lambda row: (row.source, row.nonterminal))
        return {
            "groups": [(*key, list(lines)) for key, lines in grouped],
            "problems": world.problems.filter(subject=ProblemSubject.GRAMMAR),
        }

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: ProductionForm
    ) -> Mapping[str, Any]:
        if row is None:
            source = form["source"].value() or form.sets[-1]
            is_first = not Production.objects.filter(grammar__world=world).exists()
            return {"checked": form.checked, "is_first": is_first, **_completion(world, source)}
        lines = Production.objects.filter(grammar__world=world, nonterminal=row.nonterminal)
        templates = SemanticTemplate.objects.filter(grammar__world=world)
        return {
            "checked": form.checked or check_production(ProductionEdit.of_stored(row)),
            "lines": lines.exclude(pk=row.pk),
            "meanings": templates.for_nonterminal(row.nonterminal),
            **_completion(world, row.source),
        }

    def asked(self, request: WorldRequest, world: World) -> Mapping[str, Any]:
        """Begin with what the address says, or else with ``$Main`` where no set has it yet."""
        asked = {name: request.GET.get(name, "") for name in ("nonterminal", "source")}
        lines = Production.objects.filter(grammar__world=world)
        if not asked["nonterminal"] and not lines.filter(nonterminal=ROOT).exists():
            asked["nonterminal"] = ROOT
        return asked

    def alike(self, row: Production) -> Mapping[str, str]:
        return {"nonterminal": row.nonterminal, "source": row.source}

    def merging(self, world: World, row: Any) -> Mapping[str, Any]:
        return {"check_url": f"{reverse('production_check', args=[world.name])}?row={row.pk}"}

    def preview(
        self, request: WorldRequest, world: World, form: ProductionForm
    ) -> Mapping[str, Any]:
        """Return what the typed production expands to, and what saving it would change."""
        edit = edit_typed(form)
        checked = check_production(edit) if edit else None
        if edit is None or checked is None or checked.has_errors:
            return {"checked": checked}
        expected = consequences_of_production(edit)
        return {"checked": checked, "expected": expected, "groups": groups_of(expected)}


PRODUCTIONS = ProductionNoun()


def edit_typed(form: ProductionForm) -> ProductionEdit | None:
    """Return the production as typed, or None while a field is empty or invalid."""
    form.is_valid()
    nonterminal, expansion = (
        form.cleaned_data.get(name) or form[name].value() or ""
        for name in ("nonterminal", "expansion")
    )
    if not expansion.strip() or {"nonterminal", "source"} & form.errors.keys():
        return None
    if len(expansion) > MAX_PATTERN or "\0" in f"{nonterminal}{expansion}":
        return None
    source = form.cleaned_data["source"]
    return ProductionEdit(form.world, source, nonterminal, expansion, form.row)


def _completion(world: World, source: str) -> dict[str, Any]:
    """Return the task category whose nonterminals the editor offers."""
    edit = ProductionEdit(world, source, "", "")
    return {"category": next(edit.categories(), None)}

"""The rows of a recipe book, each with an example beside it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.generation.recipe_check import try_row
from annotations.language.plans import read_recipe
from annotations.models import Primitive, Recipe, World
from annotations.people.access import WorldRequest
from annotations.web.description.recipe_forms import BookRowForm, PrimitiveForm, RecipeForm
from annotations.web.editing.nouns import Noun


class BookNoun(Noun):
    """A row of the book, with what is wrong with it and what the robot does by it."""

    form: type[BookRowForm]
    template = "annotations/description/recipe.html"
    preview_template = "annotations/description/_recipe_preview.html"

    def context(
        self, request: WorldRequest, world: World, row: Any | None, form: BookRowForm
    ) -> Mapping[str, Any]:
        kind, model = self.kind.name, form.model
        return {
            "kind": kind,
            "preview": f"{kind}_preview",
            "name": self.title_of(row) if row else "",
            "text": row.text if row else "",
            "checked": try_row(world, model, row.text, row) if row else None,
        }

    def preview(self, request: WorldRequest, world: World, form: BookRowForm) -> Mapping[str, Any]:
        text = request.POST.get("text", "").replace("\0", "")
        text = text.replace("\r\n", "\n").replace("\n", " ")
        if not text.strip():
            return {"text": text}
        chosen = request.POST.get("example", "")
        return {"text": text, "checked": try_row(world, form.model, text, form.row, chosen)}

    def asked(self, request: WorldRequest, world: World) -> Mapping[str, Any]:
        return {"text": request.GET.get("text", "")}


class RecipeNoun(BookNoun):
    form = RecipeForm

    def title_of(self, row: Recipe) -> str:
        return str(read_recipe(row.text).pattern)


class PrimitiveNoun(BookNoun):
    form = PrimitiveForm

    def title_of(self, row: Primitive) -> str:
        return row.name


RECIPES, PRIMITIVES = RecipeNoun(), PrimitiveNoun()

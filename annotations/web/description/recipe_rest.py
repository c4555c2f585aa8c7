"""The recipes of a world and the primitives that they use, row by row and as a whole book."""

from __future__ import annotations

from typing import Any

from django.db import transaction
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.editing.recipe_books import (
    proposals_for,
    replace_book,
    shipped_book_of,
    take_proposals,
)
from annotations.generation.recipe_check import FIELD, try_row
from annotations.language.plans import RecipeBook, shipped_books
from annotations.language.texts import MAX_PREDICATE, MAX_ROW
from annotations.models import Duty, Primitive, Recipe, World
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.from_rows import recipe_book_of
from annotations.rows.stored_problems import as_json
from annotations.web.description.check_rest import Check, FoundSerializer, replaced_field
from annotations.web.description.recipe_forms import PrimitiveForm, RecipeBookForm, RecipeForm
from annotations.web.editing.noun_rest import NounRoute, NounViewSet
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.matching import etag_of, require_match
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import WorldRoute

ROWS = ("primitives", "recipes")
MOST_ROWS = 1_000  # of a kind, in a book


class PrimitiveSerializer(serializers.ModelSerializer[Primitive]):
    """Something that the robot can do: ``go_to(place) "go to {place}": moves to place``."""

    class Meta:
        model = Primitive
        fields = ["id", "name", "text", "position", "version"]


class RecipeSerializer(serializers.ModelSerializer[Recipe]):
    """How the robot does an action: ``go(destination) -> go_to(destination)``."""

    class Meta:
        model = Recipe
        fields = ["id", "action", "text", "position", "version"]


class BookRowChange(Fields):
    """A row as docs/reference/recipes.md describes it."""

    text = LineField(max_length=MAX_ROW)


class BookRowViewSet(NounViewSet):
    new_serializer = change_serializer = BookRowChange
    filter_backends = []


class PrimitiveViewSet(BookRowViewSet):
    """What the robot can do. The name of a primitive changes by renaming, and one that a recipe uses stays."""

    noun_form = PrimitiveForm
    serializer_class = PrimitiveSerializer
    sorts = {"position": "position", "name": "name", "id": "pk"}


class RecipeViewSet(BookRowViewSet):
    """How the robot does the actions of forms."""

    noun_form = RecipeForm
    serializer_class = RecipeSerializer
    sorts = {"position": "position", "action": "action", "id": "pk"}


class TaskPlanField(serializers.DictField):
    """A task plan as docs/reference/recipes.md describes it."""


class RecipeExampleSerializer(serializers.Serializer[Any]):
    """A command of the world, and what the robot does by the row."""

    command = serializers.CharField()
    english = serializers.CharField()
    form = serializers.CharField()
    task_plan = TaskPlanField()
    spoken = serializers.CharField()


class CheckedBookRow(FoundSerializer):
    """``commands`` are some of the world that use the row; the example is of one of them."""

    commands = serializers.ListField(child=serializers.CharField())
    example = RecipeExampleSerializer(allow_null=True)


class BookRowToCheck(BookRowChange):
    """``command`` asks for the example of one of the ``commands`` that an earlier answer named."""

    replaces = replaced_field()
    command = serializers.CharField(max_length=MOST_CHARACTERS, required=False, default="")


class CheckBookRow(NounRoute, Check):
    """Checks a row of the book, and says what the robot does by it."""

    @extend_schema(request=BookRowToCheck, responses={200: CheckedBookRow})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(BookRowToCheck)
        replaced = self.replaced(sent)
        checked = try_row(self.world, self.noun_form.model, sent["text"], replaced, sent["command"])
        example = checked.example
        return Response(
            {
                "problems": [{"field": FIELD, **as_json(each)} for each in checked.problems],
                "commands": checked.commands,
                "example": example
                and {
                    "command": example.command,
                    "english": example.english,
                    "form": example.form,
                    "task_plan": example.task_plan.as_json(),
                    "spoken": example.spoken,
                },
            }
        )


class CheckPrimitive(CheckBookRow):
    """Checks a primitive, and says what the robot does with it."""

    noun_form = PrimitiveForm


class CheckRecipe(CheckBookRow):
    """Checks a recipe, and says what the robot does by it."""

    noun_form = RecipeForm


class BookFields(Fields):
    """The name of a book that ships; or the rows of another one."""

    shipped = serializers.ChoiceField(choices=sorted(shipped_books()), required=False)
    primitives = serializers.ListField(child=LineField(max_length=MAX_ROW), max_length=MOST_ROWS)
    recipes = serializers.ListField(child=LineField(max_length=MAX_ROW), max_length=MOST_ROWS)

    def validate(self, sent: dict[str, Any]) -> dict[str, Any]:
        if "shipped" in sent and sent.keys() & set(ROWS):
            raise serializers.ValidationError("Send the name of a book or rows, not both.")
        return sent


class RecipeBookSerializer(serializers.Serializer[Any]):
    """The rows in order. ``shipped`` names the book that ships where the world has not changed it."""

    shipped = serializers.CharField(allow_blank=True)
    primitives = serializers.ListField(child=serializers.CharField())
    recipes = serializers.ListField(child=serializers.CharField())


class OneRecipeBook(WorldRoute):
    """Shows the recipe book of the world as a whole, and replaces it."""

    model = World
    serializer_class = RecipeBookSerializer
    filter_backends = []
    pagination_class = None
    duties = {"PATCH": Duty.ANNOTATE}
    conditional = ("PATCH",)

    @extend_schema(operation_id="recipe_book", responses={200: RecipeBookSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        shown = self._shown()
        return Response(shown, headers={"ETag": etag_of(None, shown)})

    @extend_schema(
        operation_id="replace_recipe_book",
        request=BookFields,
        responses={200: RecipeBookSerializer},
    )
    def patch(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(BookFields, partial=True)
        with transaction.atomic():
            self.hold_world()
            shown = self._shown()
            require_match(request, shown, shown)
            rows = {name: "\n".join(sent.get(name, shown[name])) for name in ROWS}
            form = RecipeBookForm({**rows, "shipped": sent.get("shipped", "")})
            if not form.is_valid():
                raise refusal_of_form(form)
            replace_book(self.world, form.book, request.user)
        return self.get(request)

    def _shown(self) -> dict[str, Any]:
        shipped, book = shipped_book_of(self.world), recipe_book_of(self.world)
        return {"shipped": shipped.name if shipped else "", **_rows_of(book)}


class ProposedRows(serializers.Serializer[Any]):
    """Recipes for the actions that none covers, and the primitives that they call."""

    primitives = serializers.ListField(child=serializers.CharField())
    recipes = serializers.ListField(child=serializers.CharField())


class ActionsToCover(Fields):
    """The actions whose recipes to add; without it, all."""

    actions = serializers.ListField(
        child=LineField(max_length=MAX_PREDICATE), max_length=MOST_ROWS, required=False
    )


class ProposedRecipes(WorldRoute):
    """Shows what is proposed for the actions that no recipe covers, and adds it to the book of the world."""

    filter_backends = []
    pagination_class = None
    duties = {"POST": Duty.ANNOTATE}

    @extend_schema(operation_id="proposed_recipes", responses={200: ProposedRows})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(_rows_of(proposals_for(self.world)))

    @extend_schema(
        operation_id="take_proposed_recipes",
        request=ActionsToCover,
        responses={200: ProposedRows},
    )
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        """Answers the rows that were added."""
        sent = self.read(ActionsToCover)
        return Response(_rows_of(take_proposals(self.world, request.user, sent.get("actions"))))


class ShippedBookSerializer(serializers.Serializer[Any]):
    """A book that comes with the program."""

    name = serializers.CharField()
    title = serializers.CharField()
    description = serializers.CharField()
    primitives = serializers.ListField(child=serializers.CharField())
    recipes = serializers.ListField(child=serializers.CharField())


class ShippedBooks(WorldRoute):
    """Shows the books that come with the program."""

    filter_backends = []
    pagination_class = None

    @extend_schema(operation_id="shipped_books", responses={200: ShippedBookSerializer(many=True)})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        return Response(
            [
                {
                    "name": each.name,
                    "title": each.title,
                    "description": each.description,
                    **_rows_of(each.book),
                }
                for each in shipped_books().values()
            ]
        )


def _rows_of(book: RecipeBook) -> dict[str, list[str]]:
    return {
        "primitives": list(map(str, book.primitives)),
        "recipes": list(map(str, book.recipes)),
    }

"""The productions of the command grammar."""

from __future__ import annotations

from rest_framework import serializers

from annotations.models import Production
from annotations.web.description.description_filters import ProductionFilters
from annotations.web.description.production_forms import ProductionForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.fields import LineField
from annotations.web.rest.form_fields import FormFields


class ProductionSerializer(serializers.ModelSerializer[Production]):
    """A line of the grammar: what a nonterminal may become. The nonterminal changes by renaming."""

    class Meta:
        model = Production
        fields = [
            *("id", "nonterminal", "expansion", "source", "line", "task_category"),
            *("position", "version"),
        ]


class ProductionChange(FormFields):
    class Meta:
        form = ProductionForm
        fields = [*ProductionForm.edited]


class NewProduction(ProductionChange):
    """``source`` is the set of the grammar that the line is added to: that of the only task category by default.

    In a world without task categories it names the first one.
    """

    source = LineField(max_length=200, required=False)  # type: ignore[assignment]  # the name of the column

    class Meta(ProductionChange.Meta):
        fields = ["nonterminal", "expansion"]


class ProductionViewSet(NounViewSet):
    """The lines of the grammar."""

    noun_form = ProductionForm
    serializer_class = ProductionSerializer
    new_serializer = NewProduction
    change_serializer = ProductionChange
    filterset_class = ProductionFilters
    sorts = {"position": "position", "nonterminal": "nonterminal", "id": "pk"}

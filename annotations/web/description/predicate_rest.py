"""The predicates of the logical forms."""

from __future__ import annotations

from rest_framework import serializers

from annotations.models import Predicate
from annotations.web.description.description_filters import PredicateFilters
from annotations.web.description.predicate_forms import PredicateForm
from annotations.web.editing.noun_rest import NounViewSet
from annotations.web.rest.fields import LineField
from annotations.web.rest.form_fields import FormFields


class PredicateSerializer(serializers.ModelSerializer[Predicate]):
    """A predicate. ``signatures`` lists the kinds of its arguments, once for each way to use it."""

    signatures = serializers.ListField(child=serializers.ListField(child=serializers.CharField()))

    class Meta:
        model = Predicate
        fields = ["id", "name", "kind", "signatures", "gloss", "is_edited", "version"]


class PredicateChange(FormFields):
    """``signatures`` may mark arguments at the end that may be missing: ``["object", "room?"]``."""

    signatures = serializers.ListField(
        child=serializers.ListField(child=LineField(max_length=40), max_length=50), max_length=100
    )

    class Meta:
        form = PredicateForm
        fields = ["kind", "gloss"]


class NewPredicate(PredicateChange):
    class Meta(PredicateChange.Meta):
        fields = ["name", "kind", "gloss"]


class PredicateViewSet(NounViewSet):
    """The predicates of the logical forms."""

    noun_form = PredicateForm
    serializer_class = PredicateSerializer
    new_serializer = NewPredicate
    change_serializer = PredicateChange
    filterset_class = PredicateFilters
    sorts = {"name": "name", "kind": "kind", "id": "pk"}

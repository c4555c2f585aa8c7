"""What people answer about utterances: a label, the entity that words name, an answer taken back."""

from __future__ import annotations

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.labelling.item_answers import take_answer_back
from annotations.language.texts import MAX_FORM
from annotations.models import Duty, Label
from annotations.models.corpus import MOST_CHARACTERS, verdict_choices
from annotations.showing.paging import LARGEST_INTEGER
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldViewSet

LARGEST_VERSION = 2**31 - 1


class LabelSerializer(serializers.ModelSerializer[Label]):
    """An answer of the caller. It decides from ``accepted_at`` on, a blind one once another agrees."""

    utterance = serializers.IntegerField(source="utterance_id")

    class Meta:
        model = Label
        fields = [
            *("id", "utterance", "verdict", "form", "reason", "seconds"),
            *("created_at", "accepted_at", "taken_back_at"),
        ]


class NewLabel(Fields):
    """What an utterance means: ``form`` in any notation where the verdict is ``form``. ``version`` is that
    of the utterance as it was read."""

    verdict = serializers.ChoiceField(choices=verdict_choices(), default="form")
    form = serializers.CharField(default="", allow_blank=True, max_length=MAX_FORM)
    reason = serializers.CharField(default="", allow_blank=True, max_length=MOST_CHARACTERS)
    version = serializers.IntegerField(min_value=0, max_value=LARGEST_VERSION)


class NewSpan(Fields):
    """The characters ``start`` to ``end`` of the text name the entity with this id; they become an alias."""

    start = serializers.IntegerField(min_value=0, max_value=MOST_CHARACTERS)
    end = serializers.IntegerField(min_value=1, max_value=MOST_CHARACTERS)
    entity = serializers.IntegerField(min_value=1, max_value=LARGEST_INTEGER)
    version = serializers.IntegerField(min_value=0, max_value=LARGEST_VERSION)


class LabelViewSet(ListModelMixin, WorldViewSet):
    """The caller's own answers, the last one first."""

    model = Label
    serializer_class = LabelSerializer
    filter_backends = []
    duties = {"take_back": Duty.ANNOTATE}
    sorts = {"newest": "-pk", "id": "pk"}

    def rows(self) -> QuerySet[Label]:
        """Leave out the answers of others: people who may still be asked must not see them."""
        return Label.objects.of_world(self.world).filter(annotator=self.request.user)

    @extend_schema(request=None, responses={200: LabelSerializer})
    @action(detail=True, methods=["post"], url_path="take-back")
    def take_back(self, request: ApiRequest, **kwargs: object) -> Response:
        """Undoes an answer of the caller: the utterance is what it was before."""
        rows = Label.objects.of_world(self.world)
        stored = get_object_or_404(rows, pk=self.kwargs["pk"])
        take_answer_back(stored, request.user)
        stored.refresh_from_db()
        return self.show(stored)

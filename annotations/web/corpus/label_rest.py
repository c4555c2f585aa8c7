"""What people answer about utterances: a label, the entity that words name, an answer taken back."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any, ClassVar

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.filters import BaseFilterBackend
from rest_framework.request import Request
from rest_framework.response import Response

from annotations.labelling.entity_spans import mend_span
from annotations.labelling.label_answers import AnsweredMeanwhile, NoLongerYours
from annotations.language.errors import LanguageError
from annotations.language.limits import MAX_FORM
from annotations.lists.paging import LARGEST_INTEGER
from annotations.models import Duty, Entity, Label
from annotations.models.corpus import MOST_CHARACTERS, verdict_choices
from annotations.queueing.item_answers import answer, take_answer_back
from annotations.web.corpus.utterance_rest import UtteranceNoun, UtteranceSerializer
from annotations.web.rest.fields import Fields
from annotations.web.rest.problem_details import Conflict, Refused, refusal_of_text
from annotations.web.rest.routes import RowRoute, RowsRoute

LARGEST_VERSION = 2**31 - 1


class LabelSerializer(serializers.ModelSerializer):
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


class LabelUtterance(UtteranceNoun, RowRoute):
    """Answers what an utterance means, whether or not the work queue has asked the caller."""

    http_method_names = ["post", "options"]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    @extend_schema(request=NewLabel, responses={201: LabelSerializer})
    def post(self, request: Request, **kwargs: object) -> Response:
        row, sent = self.get_object(), self.read(NewLabel)
        values = {name: sent[name] for name in ("verdict", "form", "version", "reason")}
        try:
            made = answer(row, by=request.user, **values)
        except (AnsweredMeanwhile, NoLongerYours) as error:
            raise Conflict(str(error)) from error
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        except ValueError as error:
            raise Refused(str(error)) from error
        return Response(LabelSerializer(made).data, status=HTTPStatus.CREATED)


class MendUtterance(UtteranceNoun, RowRoute):
    """Says which words of an utterance name which entity; unlabelled utterances with these words follow."""

    http_method_names = ["post", "options"]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    @extend_schema(request=NewSpan, responses={200: UtteranceSerializer})
    def post(self, request: Request, **kwargs: object) -> Response:
        row, sent = self.get_object(), self.read(NewSpan)
        entities = Entity.objects.filter(ontology__world=self.world)
        entity = get_object_or_404(entities, pk=sent["entity"])
        where = sent["start"], sent["end"]
        try:
            return self.show(mend_span(row, *where, entity, request.user, sent["version"]))
        except AnsweredMeanwhile as error:
            raise Conflict(str(error)) from error
        except ValueError as error:
            raise Refused(str(error)) from error


class LabelNoun:
    model = Label
    serializer_class = LabelSerializer
    filter_backends: ClassVar[list[type[BaseFilterBackend]]] = []

    def rows(self) -> QuerySet[Label]:
        """Leave out what others answered: who may still be asked must not see it."""
        rows: Any = Label.objects.of_world(self.world)
        return rows.filter(annotator=self.request.user)


class OwnLabels(LabelNoun, RowsRoute):
    """Lists the caller's own answers, the last one first."""

    sorts: ClassVar[dict[str, str]] = {"newest": "-pk", "id": "pk"}


class TakeLabelBack(LabelNoun, RowRoute):
    """Undoes an answer of the caller: the utterance is what it was before."""

    http_method_names = ["post", "options"]
    duties: ClassVar[dict[str, Duty]] = {"POST": Duty.ANNOTATE}

    @extend_schema(request=None, responses={200: LabelSerializer})
    def post(self, request: Request, **kwargs: object) -> Response:
        rows = Label.objects.of_world(self.world)
        stored = get_object_or_404(rows, pk=self.kwargs["pk"])
        try:
            take_answer_back(stored, request.user)
        except (NoLongerYours, ValueError) as error:
            raise Conflict(str(error)) from error
        stored.refresh_from_db()
        return self.show(stored)

"""Dialogues about commands over the API: start one, answer, look at it, keep what came of it."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.models import Duty
from annotations.models.corpus import MOST_CHARACTERS
from annotations.web.rest.fields import Fields
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldViewSet
from parser_service.models import Dialogue
from parser_service.serving.conversation import AnsweredMeanwhile, keep, reply, start
from parser_service.serving.dialogue_json import as_json
from parser_service.web.serving.plan_fields import PlanField


class NewDialogue(Fields):
    """What somebody tells the robot."""

    utterance = serializers.CharField(max_length=MOST_CHARACTERS, trim_whitespace=False)


class DialogueAnswer(Fields):
    """What somebody answers: an entity, new words for one, yes, no, stop, or another utterance.

    ``version``, if sent, is that of the dialogue as it was read; a 409 says that it has moved on.
    """

    answer = serializers.CharField(max_length=MOST_CHARACTERS, allow_blank=True)
    version = serializers.IntegerField(min_value=1, required=False)


class TurnSerializer(serializers.Serializer[Any]):
    who = serializers.ChoiceField(choices=["person", "robot"])
    text = serializers.CharField(allow_blank=True)


class AskedSerializer(serializers.Serializer[Any]):
    """The slot that the dialogue asks for. ``phrases`` are unknown words of the utterance."""

    entity_class = serializers.CharField(allow_blank=True)
    choices = serializers.ListField(child=serializers.CharField())
    likely = serializers.CharField(allow_null=True)
    phrases = serializers.ListField(child=serializers.CharField())


class OfferSerializer(serializers.Serializer[Any]):
    """An entity that the ontology may learn, or another word (``alias``) for one that it has."""

    entity_class = serializers.CharField()
    text = serializers.CharField()
    alias = serializers.CharField(allow_blank=True)


class DialogueSerializer(serializers.Serializer[Any]):
    """A dialogue: ``prompt`` is what the robot says, ``phase`` what it waits for or how it ended."""

    id = serializers.IntegerField()
    utterance = serializers.CharField()
    phase = serializers.CharField()
    is_over = serializers.BooleanField()
    prompt = serializers.CharField()
    asked = AskedSerializer(allow_null=True)
    form = serializers.CharField()
    grounded = serializers.CharField()
    reading = serializers.CharField()
    english = serializers.CharField()
    plan = PlanField(help_text="As docs/reference/plans.md describes it.")
    task_plan = PlanField(help_text="As docs/reference/recipes.md describes it.")
    spoken = serializers.CharField(allow_blank=True)
    offers = OfferSerializer(many=True)
    transcript = TurnSerializer(many=True)
    run = serializers.IntegerField(allow_null=True)
    kept_as = serializers.IntegerField(allow_null=True)
    started_at = serializers.DateTimeField()
    version = serializers.IntegerField()


class DialogueRow(serializers.ModelSerializer[Dialogue]):
    """A dialogue in a list."""

    class Meta:
        model = Dialogue
        fields = ["id", "utterance", "phase", "kept_as", "started_at", "version"]


class DialogueViewSet(ListModelMixin, WorldViewSet):
    """Dialogues about commands."""

    model = Dialogue
    serializer_class = DialogueRow
    filter_backends = []
    duties = {"keep": Duty.ANNOTATE}

    def rows(self) -> QuerySet[Dialogue]:
        return Dialogue.objects.filter(world=self.world)

    def show(self, row: Dialogue, status: int = HTTPStatus.OK) -> Response:
        return Response(DialogueSerializer(as_json(row)).data, status=status)

    @extend_schema(request=NewDialogue, responses={201: DialogueSerializer})
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Starts a dialogue about an utterance."""
        sent = self.read(NewDialogue)
        row = start(self.world, sent["utterance"], request.user)
        return self.show(row, HTTPStatus.CREATED)

    @extend_schema(responses=DialogueSerializer)
    def retrieve(self, request: ApiRequest, **kwargs: object) -> Response:
        """Shows a dialogue."""
        return self.show(self.get_object())

    @extend_schema(request=DialogueAnswer, responses=DialogueSerializer)
    @action(detail=True, methods=["post"])
    @once
    def answer(self, request: ApiRequest, **kwargs: object) -> Response:
        """Answers what a dialogue asks. One that is over stays as it is."""
        row = self.get_object()
        sent = self.read(DialogueAnswer)
        if sent.get("version", row.version) != row.version:
            raise AnsweredMeanwhile
        return self.show(reply(row, sent["answer"]))

    @extend_schema(request=None, responses=DialogueSerializer)
    @action(detail=True, methods=["post"])
    def keep(self, request: ApiRequest, **kwargs: object) -> Response:
        """Makes a labelled utterance of a dialogue that ended with a form."""
        row = self.get_object()
        keep(row, request.user)
        return self.show(row)

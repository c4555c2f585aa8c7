"""What parsers say, for people: a wrong answer sent to the work queue, forms suggested for a pattern."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.generation.suggesting import MOST_COMMAND
from annotations.language.texts import MAX_FORM, MAX_PATTERN, LanguageError
from annotations.models import Duty, Scope, TaskCategory, Utterance
from annotations.models.corpus import MOST_CHARACTERS
from annotations.showing.own_entities import OwnEntities
from annotations.web.description.template_rest import category_called
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_text
from annotations.web.rest.routes import WorldRoute
from parser_service.labelling.label_candidates import candidates_for
from parser_service.labelling.pattern_suggestions import suggest_with_parsers
from parser_service.labelling.wrong_answer_reports import report_wrong, say_parser

LARGEST_KEY = 2**63 - 1


class WrongAnswer(Fields):
    """An utterance that was answered wrongly, by which run, and the right form where it is known."""

    utterance = serializers.CharField(max_length=MOST_CHARACTERS)
    run = serializers.IntegerField(
        min_value=1, max_value=LARGEST_KEY, allow_null=True, default=None
    )
    form = serializers.CharField(max_length=MAX_FORM, allow_blank=True, default="")
    reason = LineField(max_length=MOST_CHARACTERS, allow_blank=True, default="")


class ReportedSerializer(serializers.Serializer[Any]):
    """What became of it, in a sentence."""

    sentence = serializers.CharField()


class ReportWrong(WorldRoute):
    """Sends an utterance that was answered wrongly to the work queue."""

    http_method_names = ["post", "options"]
    model = Utterance

    @extend_schema(request=WrongAnswer, responses={200: ReportedSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(WrongAnswer)
        run = get_object_or_404(self.world.runs.all(), pk=sent["run"]) if sent["run"] else None
        about = sent["utterance"], say_parser(run), request.user, sent["form"], sent["reason"]
        try:
            return Response({"sentence": report_wrong(self.world, *about)})
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error


class PatternToComplete(Fields):
    """A pattern, and the command that it was written for, if there is one."""

    task_category = LineField(max_length=60)
    pattern = serializers.CharField(max_length=MAX_PATTERN)
    command = LineField(max_length=MOST_COMMAND, allow_blank=True, default="")


class SuggestedFormSerializer(serializers.Serializer[Any]):
    """A form, its English sentence, the pattern of the template that it was made from, and which parsers
    answer it."""

    form = serializers.CharField(source="text")
    english = serializers.CharField(source="gloss")
    made_from = serializers.CharField(allow_blank=True)
    is_sure = serializers.BooleanField()
    parsers = serializers.SerializerMethodField()

    def get_parsers(self, form: Any) -> list[str]:
        return [each.parser for each in form.answers]


class SuggestionsSerializer(serializers.Serializer[Any]):
    """Forms, the likely one first. While ``waits_for`` names a parser, a worker asks it: ask again.

    Their English has the entities of ``example``, a command of the pattern."""

    forms = SuggestedFormSerializer(many=True)
    command = serializers.CharField(allow_blank=True)
    example = serializers.CharField(allow_blank=True)
    waits_for = serializers.CharField(allow_blank=True)
    reason = serializers.CharField(allow_blank=True)


class SuggestForms(WorldRoute):
    """Suggests forms for the pattern of a template."""

    http_method_names = ["post", "options"]
    model = TaskCategory
    filter_backends = []
    duties = {"POST": Duty.ANNOTATE}

    @extend_schema(request=PatternToComplete, responses={200: SuggestionsSerializer})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(PatternToComplete)
        category = category_called(self.world, sent["task_category"])
        asked = category, sent["pattern"].strip(), sent["command"], request.user
        return Response(SuggestionsSerializer(suggest_with_parsers(self.world, *asked)).data)


class LabelCandidateSerializer(serializers.Serializer[Any]):
    """A form, its English sentence with the entities of the utterance, and which sources give it: the answer now,
    the grammar, parsers, the nearest utterance."""

    form = serializers.CharField()
    english = serializers.CharField()
    sources = serializers.ListField(child=serializers.CharField())


class LabelCandidates(serializers.Serializer[Any]):
    """The likely form first."""

    results = LabelCandidateSerializer(many=True)


class CandidatesOfUtterance(WorldRoute):
    """Lists the forms that an utterance may have, as people who label it are offered them."""

    model = Utterance
    filter_backends = []
    duties = {"GET": Duty.ANNOTATE}
    scopes = {"GET": Scope.READ}

    def rows(self) -> QuerySet[Utterance]:
        return self.world.utterances.select_related("world")

    @extend_schema(operation_id="utterance_candidates", responses={200: LabelCandidates})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        row = self.get_object()
        own = OwnEntities.of_utterance(row)
        results = [
            {"form": each.form, "english": own.english(each.form), "sources": each.sources}
            for each in candidates_for(row)
        ]
        return Response(LabelCandidates({"results": results}).data)

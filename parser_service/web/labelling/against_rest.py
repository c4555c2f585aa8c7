"""Runs on people's paraphrases against runs on models', for programs."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.models import Duty, Scope
from annotations.people.allowances import may_take_long
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import Figures
from parser_service.labelling.people_against_models import (
    RunPair,
    run_pairs,
    start_people_against_models,
)
from parser_service.models import TrainingRun
from parser_service.models.evaluations import ShownScore
from parser_service.web.runs.run_rest import RunSerializer, StartedRunsSerializer


class NewParaphraseRuns(Fields):
    """Which parser is trained on each."""

    parser = LineField(max_length=60)


class PartOfScoreSerializer(serializers.Serializer[Any]):
    """One of the two figures behind a harmonic mean, with its 95 % interval, in percent: ``forms`` are ``unseen`` or
    ``known``."""

    forms = serializers.CharField(source="label")
    percent = serializers.FloatField()
    low = serializers.FloatField()
    high = serializers.FloatField()


class ParaphraseRunSerializer(serializers.Serializer[Any]):
    """A run, and its exact match on people's paraphrases of the test part with its 95 % interval, in percent; null
    before it is scored. By form it is a harmonic mean, of ``parts``."""

    run = RunSerializer()
    percent = serializers.FloatField(allow_null=True)
    low = serializers.FloatField(allow_null=True)
    high = serializers.FloatField(allow_null=True)
    parts = PartOfScoreSerializer(many=True)


class RunPairSerializer(serializers.Serializer[Any]):
    """Two runs that learned from as many paraphrases, of people and of models."""

    people = ParaphraseRunSerializer()
    models = ParaphraseRunSerializer()


class RunPairsSerializer(serializers.Serializer[Any]):
    """The newest pairs of runs first."""

    results = RunPairSerializer(many=True)


@may_take_long
class ParaphraseRuns(Figures):
    """Runs that learned from as many paraphrases of people and of models, tested on people's."""

    http_method_names = ["get", "post", "head", "options"]
    model = TrainingRun
    duties = {"POST": Duty.MANAGE}
    scopes = {"POST": Scope.TRAIN}

    @extend_schema(operation_id="paraphrase_runs", responses={200: RunPairsSerializer})
    def get(self, request: ApiRequest, **kwargs: object) -> Response:
        """Shows the runs with their accuracies."""
        rows = [_shown(pair) for pair in run_pairs(self.world)]
        return Response(RunPairsSerializer({"results": rows}).data)

    @extend_schema(
        request=NewParaphraseRuns,
        responses={201: StartedRunsSerializer, 200: StartedRunsSerializer},
    )
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        """Starts a run on people's paraphrases and one on models', on a split of today."""
        parser = self.read(NewParaphraseRuns)["parser"]
        answers = start_people_against_models(self.world, parser, request.user)
        new = sum(is_new for _, is_new in answers)
        runs = RunSerializer([run for run, _ in answers], many=True).data
        status = HTTPStatus.CREATED if new else HTTPStatus.OK
        return Response({"new": new, "runs": runs}, status=status)


def _shown(pair: RunPair) -> dict[str, Any]:
    people, models = (_with_score(run, score) for run, score in pair.sides)
    return {"people": people, "models": models}


def _with_score(run: TrainingRun, score: ShownScore | None) -> dict[str, Any]:
    if score is None:
        return {"run": run, "percent": None, "low": None, "high": None, "parts": ()}
    figures = {"percent": score.percent, "low": score.low, "high": score.high}
    return {"run": run, **figures, "parts": score.parts}

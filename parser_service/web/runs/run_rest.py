"""Training runs: started, watched, cancelled, trained again."""

from __future__ import annotations

from http import HTTPStatus
from typing import Any

from django.db.models import QuerySet
from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.response import Response

from annotations.language.texts import Refusal
from annotations.models import Duty, Job, Scope
from annotations.people.allowances import may_take_long
from annotations.web.rest.fields import Fields, FiniteField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_form
from annotations.web.rest.routes import RowsRoute, RowsViewSet
from annotations.web.worlds.job_rest import JobSerializer, accepted
from parser_service.models import Checkpoint, EpochMetric, RunEvent, TrainingRun
from parser_service.parsers.conditions import TRAIN_SOURCES, Protocol
from parser_service.parsers.registry import config_fields, parsers
from parser_service.reviews.state import analysis_of
from parser_service.runs import lifecycle
from parser_service.runs.analysis_requests import request_analysis
from parser_service.runs.learning_curve import MOST_SEEDS as MOST_CURVE_SEEDS
from parser_service.runs.run_requests import LARGEST_SEED, LEAST_SHARE, MOST_SEEDS
from parser_service.runs.starting import start_again, start_learning_curve, start_runs
from parser_service.runs.training_today import start_today
from parser_service.web.runs.run_filters import RunFilters
from parser_service.web.runs.run_forms import PREFIX, RunForm


class RunSerializer(serializers.ModelSerializer[TrainingRun]):
    """One parser trained once. ``config`` holds every hyperparameter.

    ``seconds_left`` is estimated by the progress of a running one, null where that says nothing yet.
    """

    config = serializers.DictField()
    split = serializers.IntegerField(source="split_id")
    split_name = serializers.CharField(source="split.name")
    created_by = serializers.CharField(source="created_by.username", default=None)
    seconds_left = serializers.FloatField(read_only=True, allow_null=True)

    class Meta:
        model = TrainingRun
        fields = [
            *("id", "parser", "parser_version", "config", "protocol", "train_sources"),
            *("train_share", "train_pairs", "seed", "split", "split_name", "status", "progress"),
            *("activity", "seconds_left", "failure", "cancel_requested", "parameters"),
            "seconds_trained",
            *("score_kind", "answered_by", "content_key", "created_by"),
            *("queued_at", "started_at", "finished_at"),
        ]


class NewRuns(Fields):
    """What to train, on what: one run per seed, counting up. What ``config`` leaves out is at its default."""

    split = serializers.IntegerField(min_value=1, max_value=2**63 - 1)
    parser = serializers.ChoiceField(choices=list(parsers()))
    config = serializers.DictField(child=serializers.JSONField(), default=dict)
    protocol = serializers.ChoiceField(choices=[each.value for each in Protocol], required=False)
    train_sources = serializers.ChoiceField(choices=TRAIN_SOURCES, default="gen")
    train_share = serializers.FloatField(min_value=LEAST_SHARE, max_value=1, default=1)
    seed = serializers.IntegerField(min_value=0, max_value=LARGEST_SEED, default=0)
    seeds = serializers.IntegerField(min_value=1, max_value=MOST_SEEDS, default=1)


class StartedRunsSerializer(serializers.Serializer[Any]):
    """The runs of a request; ``new`` of them were not there before."""

    new = serializers.IntegerField()
    runs = RunSerializer(many=True)


class CurveSeeds(Fields):
    """How many runs there are to be for each share, counting seeds up from that of the run."""

    seeds = serializers.IntegerField(min_value=1, max_value=MOST_CURVE_SEEDS, default=1)


TRAINING = ("create", "today", "cancel", "retrain", "learning_curve")


class RunViewSet(RowsViewSet):
    """The training runs, the newest first."""

    model = TrainingRun
    serializer_class = RunSerializer
    filterset_class = RunFilters
    duties = dict.fromkeys(TRAINING, Duty.MANAGE) | {"analysis": Duty.REVIEW}
    scopes = dict.fromkeys(TRAINING, Scope.TRAIN)
    sorts = {
        **{"newest": "-id", "parser": "parser", "status": "status"},
        "seconds_trained": "seconds_trained",
    }

    def rows(self) -> QuerySet[TrainingRun]:
        return self.world.runs.select_related("split__world", "created_by", "world")

    def answer_started(self, answers: list[tuple[TrainingRun, bool]]) -> Response:
        """Answer with the runs; 200 where all of them were there before."""
        new = sum(is_new for _, is_new in answers)
        shown = RunSerializer([run for run, _ in answers], many=True).data
        status = HTTPStatus.CREATED if new else HTTPStatus.OK
        return Response({"new": new, "runs": shown}, status=status)

    @extend_schema(
        request=NewRuns, responses={201: StartedRunsSerializer, 200: StartedRunsSerializer}
    )
    @once
    def create(self, request: ApiRequest, **kwargs: object) -> Response:
        """Starts runs, one for each seed."""
        sent = self.read(NewRuns)
        declared = {each.name: each.default for each in config_fields(sent["parser"])}
        unknown = [name for name in sent["config"] if name not in declared]
        if unknown:
            known = ", ".join(declared) or "none"
            said = f"{sent['parser']} has no hyperparameter {unknown[0][:80]}; there are: {known}."
            problem = {"field": f"config.{unknown[0][:80]}", "message": said}
            raise Refusal(said, "unknown_hyperparameter", problems=[problem])
        config = {PREFIX + name: value for name, value in {**declared, **sent["config"]}.items()}
        protocol = sent.get("protocol", parsers()[sent["parser"]].protocols[0])
        asked = {**sent, **config, "protocol": protocol, "share": 100 * sent["train_share"]}
        form = RunForm(self.world, sent["parser"], asked)
        if not form.is_valid():
            raise refusal_of_run(form)
        return self.answer_started(start_runs(self.world, request.user, **form.asked))

    @extend_schema(
        request=None,
        responses={201: StartedRunsSerializer, 200: StartedRunsSerializer, 202: JobSerializer},
    )
    @may_take_long
    @action(detail=False, methods=["post"])
    @once
    def today(self, request: ApiRequest, **kwargs: object) -> Response:
        """Freezes the world of today where that is to be done, and trains on it what answers here or is recommended.
        Where that takes long, the answer is a job (202), whose report names the run."""
        started = start_today(self.world, request.user)
        if isinstance(started, Job):
            return accepted(request, started)
        return self.answer_started([started])

    @extend_schema(request=None, responses={200: RunSerializer})
    @action(detail=True, methods=["post"])
    def cancel(self, request: ApiRequest, **kwargs: object) -> Response:
        """Cancels a run that waits or runs; it stops within seconds."""
        run = self.get_object()
        lifecycle.cancel(run)
        return self.show(self.get_object())

    @extend_schema(request=None, responses={201: StartedRunsSerializer, 200: StartedRunsSerializer})
    @action(detail=True, methods=["post"])
    @once
    def retrain(self, request: ApiRequest, **kwargs: object) -> Response:
        """Trains the same configuration on the split that follows the run's own."""
        run = self.get_object()
        return self.answer_started([start_again(run, request.user)])

    @extend_schema(
        request=CurveSeeds, responses={201: StartedRunsSerializer, 200: StartedRunsSerializer}
    )
    @action(detail=True, methods=["post"], url_path="learning-curve")
    @once
    def learning_curve(self, request: ApiRequest, **kwargs: object) -> Response:
        """Trains the run's configuration on shares of its training pairs, as far as that is not done."""
        run, seeds = self.get_object(), self.read(CurveSeeds)["seeds"]
        new = start_learning_curve(run, request.user, seeds)
        return self.answer_started([(each, True) for each in new])

    @extend_schema(request=None, responses={202: JobSerializer})
    @action(detail=True, methods=["post"])
    def analysis(self, request: ApiRequest, **kwargs: object) -> Response:
        """Lets a worker analyse the errors of a run, again where that was done; the answer is its job."""
        state = analysis_of(self.get_object())
        if not state.is_possible:
            run = state.run
            sentence = f"Run {run.pk} is {run.status}: only one that succeeded is analysed."
            raise Refusal(sentence, "run_not_succeeded", HTTPStatus.CONFLICT)
        job = request_analysis(state.run, request.user, again=state.is_complete)
        return accepted(request, job)


def refusal_of_run(form: RunForm) -> Refusal:
    """Return what is wrong with the form, its hyperparameters by their names in the body."""
    refusal, problems = refusal_of_form(form), []
    for problem in refusal.problems:
        if problem.get("field", "").startswith(PREFIX):
            field = f"config.{problem['field'].removeprefix(PREFIX)}"
            problems.append({**problem, "field": field})
        else:
            problems.append(dict(problem))
    return Refusal(refusal.message, refusal.code, problems=problems)


class OfRun(RowsRoute):
    """Rows of one run."""

    def run(self) -> TrainingRun:
        """Return the run of the address. Raises Http404."""
        return get_object_or_404(self.world.runs.all(), pk=self.kwargs["pk"])


class RunEventSerializer(serializers.ModelSerializer[RunEvent]):
    """A line of a run's log."""

    class Meta:
        model = RunEvent
        fields = ["id", "at", "attempt", "message"]


class RunLog(OfRun):
    """Lists the lines of a run's log."""

    model = RunEvent
    serializer_class = RunEventSerializer

    def rows(self) -> QuerySet[RunEvent]:
        return self.run().events.all()


class EpochSerializer(serializers.ModelSerializer[EpochMetric]):
    """A point of a run's curves. The unit of the losses is the parser's."""

    train_loss = FiniteField()
    validation_loss = FiniteField(allow_null=True)

    class Meta:
        model = EpochMetric
        fields = ["epoch", "train_loss", "validation_loss", "validation_accuracy", "seconds"]


class RunCurves(OfRun):
    """Lists loss and accuracy of a run by epoch."""

    model = EpochMetric
    serializer_class = EpochSerializer
    sorts = {"epoch": "epoch"}

    def rows(self) -> QuerySet[EpochMetric]:
        return self.run().epochs.all()


class CheckpointSerializer(serializers.ModelSerializer[Checkpoint]):
    """What a run keeps of its parser; ``sha256`` covers the files of the folder."""

    class Meta:
        model = Checkpoint
        fields = ["id", "epoch", "sha256", "is_best", "created_at"]


class RunCheckpoints(OfRun):
    """Lists the checkpoints of a run: the last, and the best."""

    model = Checkpoint
    serializer_class = CheckpointSerializer
    sorts = {"epoch": "epoch"}

    def rows(self) -> QuerySet[Checkpoint]:
        return self.run().checkpoints.all()

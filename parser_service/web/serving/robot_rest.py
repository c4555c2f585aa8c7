"""What a robot gets and what people tell about it: plans, names of actions, words from dialogues."""

from __future__ import annotations

from typing import Any

from django.db.models import QuerySet
from django.http import HttpResponseBase
from drf_spectacular.types import OpenApiTypes
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.decorators import action
from rest_framework.mixins import ListModelMixin
from rest_framework.response import Response

from annotations.language.forms import read_form
from annotations.language.plans import make_plan, spoken
from annotations.language.texts import MAX_FORM, LanguageError
from annotations.models import Duty, Scope
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import refusal_of_text
from annotations.web.rest.routes import WorldRoute, WorldViewSet
from parser_service.models import OfferedEntity
from parser_service.serving.action_naming import (
    names_of,
    read_name,
    store_names,
    version_of,
    write_arguments,
)
from parser_service.serving.entity_offers import confirm, refuse
from parser_service.serving.parse_answers import task_plan_of
from parser_service.serving.preparing import WorldLanguage
from parser_service.web.serving.tree_query import TreeQuery, tree_answer


class PlanQuery(TreeQuery):
    """A form with entities, such as ``grounded`` of a parse; ``as`` xml asks for a behaviour tree. With ``robust`` it
    tries each step up to ``tries`` times, each for at most ``seconds``."""

    form = serializers.CharField(max_length=MAX_FORM)


class PlanRoute(WorldRoute):
    """Makes the plan of a form: JSON, or XML for BehaviorTree.CPP 4. Stores nothing."""

    filter_backends = []
    scopes = {"POST": Scope.READ}

    @extend_schema(
        operation_id="plan",
        request=PlanQuery,
        responses={
            (200, "application/json"): OpenApiTypes.OBJECT,
            (200, "application/xml"): OpenApiTypes.STR,
        },
    )
    def post(self, request: ApiRequest, world: str) -> HttpResponseBase:
        sent = self.read(PlanQuery)
        try:
            form = read_form(sent["form"])
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        language = WorldLanguage.of(self.world)
        plan = make_plan(form, language.ontology, language.predicates, language.action_names)
        if sent["as"] == "xml":
            return tree_answer(plan, sent)
        return Response(plan.as_json())


class TaskPlanSerializer(serializers.Serializer[Any]):
    """What the robot does for a form in its own primitives, and what it says before it begins."""

    task_plan = serializers.DictField(help_text="As docs/reference/recipes.md describes it.")
    spoken = serializers.CharField(allow_blank=True)


class TaskPlanRoute(WorldRoute):
    """Makes the plan of a form in the primitives of the robot: JSON, or XML for BehaviorTree.CPP 4. Stores nothing."""

    filter_backends = []
    scopes = {"POST": Scope.READ}

    @extend_schema(
        operation_id="task_plan",
        request=PlanQuery,
        responses={
            (200, "application/json"): TaskPlanSerializer,
            (200, "application/xml"): OpenApiTypes.STR,
        },
    )
    def post(self, request: ApiRequest, world: str) -> HttpResponseBase:
        sent = self.read(PlanQuery)
        try:
            form = read_form(sent["form"])
        except LanguageError as error:
            raise refusal_of_text(error, "form") from error
        task_plan = task_plan_of(form, WorldLanguage.of(self.world))
        if sent["as"] == "xml":
            return tree_answer(task_plan, sent)
        return Response({"task_plan": task_plan.as_json(), "spoken": spoken(task_plan)})


class ActionNameSerializer(Fields):
    """What the robot calls an action; ``arguments`` as in ``destination=goal, thing=object``."""

    name = serializers.CharField(max_length=80)
    arguments = serializers.CharField(max_length=500, allow_blank=True, default="")


class ActionNamesSerializer(Fields):
    """All names of a world by action. ``version`` is that of the names as they were read; 0 for none."""

    version = serializers.IntegerField(min_value=0)
    names = serializers.DictField(child=ActionNameSerializer())


class ActionNamesRoute(WorldRoute):
    """Shows what the robot calls its actions, and replaces it as a whole."""

    filter_backends = []
    duties = {"POST": Duty.ANNOTATE}

    @extend_schema(operation_id="action_names", responses=ActionNamesSerializer)
    def get(self, request: ApiRequest, world: str) -> Response:
        names = {
            action: {"name": each.name, "arguments": write_arguments(each)}
            for action, each in sorted(names_of(self.world).items())
        }
        return Response({"version": version_of(self.world), "names": names})

    @extend_schema(
        operation_id="set_action_names",
        request=ActionNamesSerializer,
        responses=ActionNamesSerializer,
    )
    def post(self, request: ApiRequest, world: str) -> Response:
        sent = self.read(ActionNamesSerializer)
        names = {
            action: read_name(action, each["name"], each["arguments"])
            for action, each in sent["names"].items()
        }
        given = {action: each for action, each in names.items() if each is not None}
        store_names(self.world, given, request.user, sent["version"])
        return self.get(request, world)


class OfferedEntitySerializer(serializers.ModelSerializer[OfferedEntity]):
    """An entity, or another word (``alias``) for one, that came up in dialogues ``times`` times."""

    decided_by = serializers.CharField(source="decided_by.username", default=None)

    class Meta:
        model = OfferedEntity
        fields = [
            *("id", "entity_class", "text", "alias", "said_in", "times", "state"),
            *("offered_at", "decided_by", "decided_at"),
        ]


class DecisionSerializer(Fields):
    """``confirm`` puts it into the ontology, ``refuse`` keeps it out."""

    decision = serializers.ChoiceField(choices=["confirm", "refuse"])


class OfferedEntityViewSet(ListModelMixin, WorldViewSet):
    """What people named in dialogues and the ontology did not have."""

    model = OfferedEntity
    serializer_class = OfferedEntitySerializer
    filter_backends = []
    duties = {"decide": Duty.ANNOTATE}

    def rows(self) -> QuerySet[OfferedEntity]:
        return self.world.offered_entities.select_related("decided_by")

    @extend_schema(request=DecisionSerializer, responses=OfferedEntitySerializer)
    @action(detail=True, methods=["post"])
    def decide(self, request: ApiRequest, **kwargs: object) -> Response:
        """Confirms an offered entity, or refuses it; once."""
        row = self.get_object()
        decide = {"confirm": confirm, "refuse": refuse}[self.read(DecisionSerializer)["decision"]]
        decide(row, request.user)
        return Response(self.get_serializer(row).data)

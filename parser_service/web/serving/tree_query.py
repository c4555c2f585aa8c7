"""What a request for a plan says about the behaviour tree that it asks for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.http import HttpResponse
from rest_framework import serializers

from annotations.language.plans import Plan, Robust, TaskPlan, to_behavior_tree
from annotations.web.rest.fields import Fields

DEFAULT = Robust()
MOST_TRIES = 100
MOST_SECONDS = 86_400


class TreeQuery(Fields):
    """``as`` xml asks for a behaviour tree; with ``robust`` it tries each step up to ``tries`` times, each for at most
    ``seconds``, and hands a step that fails to the action ``step_failed``."""

    robust = serializers.BooleanField(default=False)
    tries = serializers.IntegerField(default=DEFAULT.tries, min_value=1, max_value=MOST_TRIES)
    seconds = serializers.FloatField(
        default=DEFAULT.seconds, min_value=0.001, max_value=MOST_SECONDS
    )

    def get_fields(self) -> dict[str, Any]:
        as_ = serializers.ChoiceField(choices=["json", "xml"], default="json")
        return {**super().get_fields(), "as": as_}


def tree_answer(plan: Plan | TaskPlan, sent: Mapping[str, Any]) -> HttpResponse:
    """Return the behaviour tree that a valid ``TreeQuery`` asks for."""
    robust = Robust(sent["tries"], sent["seconds"]) if sent["robust"] else None
    return HttpResponse(to_behavior_tree(plan, robust), content_type="application/xml")

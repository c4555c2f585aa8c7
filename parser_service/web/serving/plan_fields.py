"""How the schema of the API describes plans. What is sent is the JSON of the plan as it is."""

from __future__ import annotations

from typing import Any

from drf_spectacular.utils import extend_schema_field
from rest_framework import serializers


class SaidWordsSerializer(serializers.Serializer[Any]):
    """Words of the ``utterance``, in its characters ``start`` to ``end``; null where it does not have them so."""

    text = serializers.CharField()
    start = serializers.IntegerField(allow_null=True)
    end = serializers.IntegerField(allow_null=True)


class OpenArgumentSerializer(serializers.Serializer[Any]):
    """What is open in a step, and the question that settles it."""

    argument = serializers.CharField(
        help_text="Its name; command for a part of which nothing was understood."
    )
    question = serializers.CharField(help_text="What to ask; a dialogue asks the same.")
    entity_class = serializers.CharField(
        allow_blank=True, help_text="What it takes; empty where that is not known."
    )
    words = SaidWordsSerializer(many=True, help_text="The words that stand there and name nothing.")
    likely = serializers.CharField(
        allow_null=True, help_text="A guess, which nobody has confirmed."
    )
    asked_in = serializers.IntegerField(
        allow_null=True, help_text="The step that asks; null where none does."
    )


class UnresolvedSerializer(serializers.Serializer[Any]):
    """A step that does not ground: what is known of it, and what is open."""

    steps = serializers.ListField(
        child=serializers.IntegerField(), help_text="The numbers of the steps that wait for it."
    )
    action = serializers.CharField(
        allow_blank=True, help_text="Empty where nothing to do was understood."
    )
    predicate = serializers.CharField(allow_blank=True)
    text = serializers.CharField(allow_blank=True)
    arguments = serializers.DictField(
        help_text="What is known; a value of the kind open stands for what is not."
    )
    open = OpenArgumentSerializer(many=True)


class OfCommandSerializer(UnresolvedSerializer):
    """The same in a plan of several commands; the words are those of its command."""

    commands = serializers.ListField(child=serializers.IntegerField())


class PlanSerializer(serializers.Serializer[Any]):
    """A plan. With the steps that are ``unresolved`` the others are all that was said, each once."""

    version = serializers.IntegerField()
    is_executable = serializers.BooleanField(
        help_text="Whether a robot can do it without asking: nothing is unresolved or a problem."
    )
    steps = serializers.ListField(child=serializers.DictField())
    problems = serializers.ListField(child=serializers.DictField())
    unresolved = UnresolvedSerializer(many=True, help_text="The steps that do not ground.")


class JointPlanSerializer(PlanSerializer):
    """One plan of several commands."""

    unresolved = OfCommandSerializer(many=True, help_text="What of the commands does not ground.")


@extend_schema_field(PlanSerializer)
class PlanField(serializers.DictField):
    """A plan, or a task plan."""


@extend_schema_field(JointPlanSerializer)
class JointPlanField(serializers.DictField):
    """A joint plan."""

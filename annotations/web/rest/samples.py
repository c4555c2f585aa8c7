"""What routes say of a sample of a large language."""

from __future__ import annotations

from typing import Any

from rest_framework import serializers

from annotations.language.templates import Balance


class SampleNoteSerializer(serializers.Serializer[Any]):
    """A sample of ``commands`` of a language with ``of`` derivations, which are written as text.

    ``size`` commands were asked for. With ``is_all`` the language has no others.
    """

    commands = serializers.IntegerField()
    of = serializers.CharField()
    is_all = serializers.BooleanField()
    size = serializers.IntegerField()
    seed = serializers.IntegerField()
    balanced = serializers.ChoiceField(choices=[each.value for each in Balance])

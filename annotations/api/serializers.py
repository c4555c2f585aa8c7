"""How rows look over the API."""

from __future__ import annotations

from rest_framework import serializers

from annotations.exporting.split_export import FIELDS, Format
from annotations.models import Example
from annotations.models.splits import Source, part_choices


class ExampleSerializer(serializers.ModelSerializer):
    """One line of a JSON Lines export."""

    class Meta:
        model = Example
        fields = FIELDS


class ExportQuery(serializers.Serializer):
    """What may be asked of an export. Text needs ``part`` and ``source``: it is one pair file."""

    part = serializers.ChoiceField(choices=part_choices(), required=False)
    source = serializers.ChoiceField(choices=Source.choices, required=False)

    def get_fields(self) -> dict[str, serializers.Field]:
        # "as" is a word of Python and cannot be a class attribute.
        as_ = serializers.ChoiceField(choices=Format.choices, default=Format.JSONL)
        return {"as": as_, **super().get_fields()}

    def validate(self, query: dict[str, str]) -> dict[str, str]:
        if query["as"] == Format.TXT and not ("part" in query and "source" in query):
            raise serializers.ValidationError(
                "A text export is one pair file: add part=train|validation|test and "
                "source=generated|paraphrased."
            )
        return query

"""How bodies of requests are read, and numbers written."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from typing import Any

from rest_framework import serializers

from annotations.web.rest.problem_details import ProblemItemSerializer


class Fields(serializers.Serializer[Any]):
    """The fields that a body may have. An unknown name is refused."""

    def to_internal_value(self, data: Any) -> Any:
        if isinstance(data, Mapping):
            unknown = [name for name in data if name not in self.fields]
            if unknown:
                known = ", ".join(self.fields)
                hint = f"There is no field of this name. This request takes: {known}."
                raise serializers.ValidationError({str(name)[:80]: [hint] for name in unknown})
        return super().to_internal_value(data)


class LineField(serializers.CharField):
    """A text of one line."""

    def to_internal_value(self, data: Any) -> str:
        text = super().to_internal_value(data)
        if len(text.splitlines()) > 1:
            raise serializers.ValidationError("Write it in one line.")
        return text


class AttributesField(serializers.DictField):
    """Names and texts of one line each."""

    child = LineField(allow_blank=True, max_length=2_000)

    def to_internal_value(self, data: Any) -> dict[str, str]:
        for name in data if isinstance(data, Mapping) else ():
            letters = str(name).replace("_", "").replace("-", "")
            if not letters.isalnum() or not str(name).isprintable():
                raise serializers.ValidationError(
                    f"A name has letters, digits, _ and -, unlike “{str(name)[:60]}”."
                )
        return super().to_internal_value(data)


class FiniteField(serializers.FloatField):
    """A number; null for infinity and NaN, which JSON cannot write."""

    def to_representation(self, value: Any) -> Any:
        return float(value) if value is not None and math.isfinite(value) else None


@cache
def with_problems(serializer: Any) -> type[serializers.Serializer[Any]]:
    """Return the serializer of a row together with what the checker says of it."""
    name = f"Written{serializer.__name__}"
    doc = "The row as it is stored, and what the checker says of it."
    problems = ProblemItemSerializer(many=True)
    fields = [*dict.fromkeys([*serializer.Meta.fields, "problems"])]
    meta = type("Meta", (serializer.Meta,), {"fields": fields})
    return type(name, (serializer,), {"problems": problems, "__doc__": doc, "Meta": meta})

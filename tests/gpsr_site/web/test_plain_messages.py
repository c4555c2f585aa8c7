"""A body with a value of another type is answered in our words, whatever the type."""

from __future__ import annotations

import pytest
from rest_framework import serializers

from gpsr_site.web.plain_messages import OF_TYPES


class Body(serializers.Serializer):
    lines = serializers.ListField(child=serializers.CharField())
    rows = serializers.ListSerializer(child=serializers.CharField())
    names = serializers.DictField()
    text = serializers.CharField()
    count = serializers.IntegerField()
    share = serializers.FloatField()
    is_new = serializers.BooleanField()
    inner = serializers.Serializer()


@pytest.mark.parametrize("wrong", [{"a": 1}, "word", ["a"], 7, None])
def test_what_is_said_of_another_type_is_ours(wrong):
    body = Body(data=dict.fromkeys(Body().fields, wrong))
    body.is_valid()
    ours = {said for messages in OF_TYPES.values() for said in messages.values()}
    found = {
        str(error)
        for name, errors in body.errors.items()
        for error in (errors if isinstance(errors, list) else errors.get("non_field_errors", []))
        if error.code in {"invalid", "not_a_list", "not_a_dict"}
    }
    assert found <= ours and (found or wrong is None)

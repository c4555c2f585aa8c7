"""What reviewers read, sent back to annotators."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from django.db.models import QuerySet
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.labelling.sent_examples import send_examples
from annotations.models import Duty, Example
from annotations.web.labelling.work_item_forms import LONGEST_QUESTION
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import WorldRoute


class WhatToLookAt(Fields):
    """What annotators are to look at, as they read it in the queue."""

    reason = LineField(max_length=LONGEST_QUESTION)


class SentSerializer(serializers.Serializer[Any]):
    """What became of the examples: different texts, the rows behind them, and how many are in the queue now."""

    utterances = serializers.IntegerField()
    subjects = serializers.IntegerField()
    queued = serializers.IntegerField()
    left_out = serializers.IntegerField()


class Sending(WorldRoute):
    """Sends what is behind examples to the work queue."""

    http_method_names = ["post", "options"]
    duties = {"POST": Duty.REVIEW}

    def send(self, examples: Iterable[Example]) -> Response:
        """Send examples for the reason in the body. Raises Refusal where they are too many."""
        reason = self.read(WhatToLookAt)["reason"]
        sent = send_examples(self.world, examples, reason, self.request.user)
        return Response(SentSerializer(sent).data)


class SendExample(Sending):
    """Sends what is behind an example of a split to the work queue."""

    model = Example
    filter_backends = []

    def rows(self) -> QuerySet[Example]:
        return Example.objects.filter(split__world=self.world, split=self.kwargs["split"])

    @extend_schema(request=WhatToLookAt, responses={200: SentSerializer})
    @once
    def post(self, request: ApiRequest, **kwargs: Any) -> Response:
        return self.send([self.get_object()])

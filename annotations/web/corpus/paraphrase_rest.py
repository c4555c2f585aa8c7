"""How people say the commands."""

from __future__ import annotations

from django.db.models import QuerySet
from rest_framework import serializers
from rest_framework.response import Response

from annotations.editing.edits import delete
from annotations.label_audit.label_decisions import correct_label
from annotations.language.limits import MAX_FORM
from annotations.models import Duty, Paraphrase
from annotations.web.corpus.corpus_filters import ParaphraseFilters
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.routes import RowsViewSet


class ParaphraseSerializer(serializers.ModelSerializer[Paraphrase]):
    """How somebody said a prompt. Distances are to the prompt; ``command`` is the one behind it."""

    command = serializers.IntegerField(source="command_id", allow_null=True)

    class Meta:
        model = Paraphrase
        fields = [
            *("id", "prompt", "utterance", "grounded_form", "logical_form", "status", "command"),
            *("edit_distance", "jaccard_distance", "position", "version"),
        ]


class LabelChange(Fields):
    """The right label, in any notation. Whoever the work queue asks about labels may correct one."""

    logical_form = serializers.CharField(max_length=MAX_FORM)


class ParaphraseViewSet(RowsViewSet):
    """The paraphrases."""

    model = Paraphrase
    serializer_class = ParaphraseSerializer
    change_serializer = LabelChange
    duties = {"destroy": Duty.ANNOTATE}
    conditional = ("partial_update", "destroy")
    filterset_class = ParaphraseFilters
    sorts = {
        **{"position": "position", "utterance": "utterance", "prompt": "prompt"},
        **{"edit_distance": "edit_distance", "jaccard_distance": "jaccard_distance"},
    }

    def rows(self) -> QuerySet[Paraphrase]:
        return self.world.paraphrases.all()

    def partial_update(self, request: ApiRequest, **kwargs: object) -> Response:
        """Corrects the label of a paraphrase."""
        row = self.matched()
        form = self.read(LabelChange)["logical_form"]
        return self.show(correct_label(row, form, request.user, row.version))

    def destroy(self, request: ApiRequest, **kwargs: object) -> Response:
        """Deletes a paraphrase."""
        row = self.matched()
        delete(row, request.user, row.version)
        return Response(status=204)

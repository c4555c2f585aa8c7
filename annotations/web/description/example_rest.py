"""A world from what people say: what lines propose, and storing it."""

from __future__ import annotations

from dataclasses import asdict
from http import HTTPStatus
from typing import Any

from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.labelling.storing_examples import store_examples
from annotations.language.induction import (
    CATEGORY,
    MOST_CHARACTERS,
    MOST_LINES,
    OfferKind,
    Proposal,
    new_productions,
    propose,
)
from annotations.language.texts import MAX_TASK_CATEGORY
from annotations.models import Duty
from annotations.rows.known_world import known_world_of
from annotations.rows.stored_problems import as_json
from annotations.web.description.check_rest import Check
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.idempotency import once
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import ProblemItemSerializer
from annotations.web.rest.routes import WorldRoute


def lines_of_numbers() -> serializers.ListField:
    return serializers.ListField(child=serializers.IntegerField(), help_text="Counted from 1.")


class ExampleLines(Fields):
    """Commands, with marks around what may change: ``water the [tomatoes] in [bed two]``."""

    lines = serializers.ListField(
        child=LineField(max_length=MOST_CHARACTERS, allow_blank=True),
        max_length=MOST_LINES,
        help_text="What people say; an empty one and one that begins with # are no examples.",
    )


class NewExamples(ExampleLines):
    """``task_category`` is that of their templates; it is made where the world has none of this name."""

    task_category = LineField(max_length=MAX_TASK_CATEGORY, default=CATEGORY)


class ProposedClassSerializer(serializers.Serializer[Any]):
    """``is_named`` is false where nobody has said what they are: it has to be said before anything is stored.

    ``aliases`` has what else a text may be called; a line such as ``# [Brandt] is not [doctor Brandt]`` refuses it.
    """

    token = serializers.CharField()
    is_named = serializers.BooleanField()
    texts = serializers.ListField(child=serializers.CharField())
    aliases = serializers.DictField(child=serializers.ListField(child=serializers.CharField()))
    lines = lines_of_numbers()


class ProposedPredicateSerializer(serializers.Serializer[Any]):
    name = serializers.CharField()
    is_named = serializers.BooleanField()
    signatures = serializers.ListField(child=serializers.ListField(child=serializers.CharField()))
    gloss = serializers.CharField(allow_blank=True)
    lines = lines_of_numbers()


class ProposedProductionSerializer(serializers.Serializer[Any]):
    nonterminal = serializers.CharField()
    expansion = serializers.CharField()


class ProposedTemplateSerializer(serializers.Serializer[Any]):
    """``lines`` is empty where nobody has said it: it follows from others by analogy."""

    pattern = serializers.CharField()
    form = serializers.CharField()
    lines = lines_of_numbers()


class OfferedLineSerializer(serializers.Serializer[Any]):
    """A line that people may say, too. It counts once it is sent with the others."""

    line = serializers.CharField()
    kind = serializers.ChoiceField(choices=[*OfferKind])
    predicate = serializers.CharField()


class OpenQuestionSerializer(serializers.Serializer[Any]):
    """Two classes, or predicates, that may be one. ``comment`` is the line that says that they are not."""

    kind = serializers.ChoiceField(choices=["class", "predicate"])
    first = serializers.CharField()
    second = serializers.CharField()
    comment = serializers.CharField()


class ProposedEditSerializer(serializers.Serializer[Any]):
    """A production or a template as it is and as it becomes; ``before`` is empty for a production that is added."""

    kind = serializers.ChoiceField(choices=["production", "template"])
    before = serializers.CharField(allow_blank=True)
    after = serializers.CharField()


class ProposedChangeSerializer(serializers.Serializer[Any]):
    """``phrases`` that may be said beside ``old``. Each of ``comments`` is a line that refuses one of them."""

    old = serializers.CharField()
    phrases = serializers.ListField(child=serializers.CharField())
    edits = ProposedEditSerializer(many=True)
    lines = lines_of_numbers()
    comments = serializers.ListField(child=serializers.CharField())


class ProposalSerializer(serializers.Serializer[Any]):
    """What lines propose. ``changes`` are what becomes of stored lines, ``understood`` the lines that the world
    understands already."""

    problems = ProblemItemSerializer(many=True)
    classes = ProposedClassSerializer(many=True)
    predicates = ProposedPredicateSerializer(many=True)
    productions = ProposedProductionSerializer(many=True)
    templates = ProposedTemplateSerializer(many=True)
    changes = ProposedChangeSerializer(many=True)
    offers = OfferedLineSerializer(many=True)
    doubts = OpenQuestionSerializer(many=True)
    understood = lines_of_numbers()


class StoredExamplesSerializer(serializers.Serializer[Any]):
    """How many rows were added. ``changed`` are predicates that take other arguments as well now, ``lengthened``
    productions and templates that say more."""

    classes = serializers.IntegerField()
    entities = serializers.IntegerField()
    predicates = serializers.IntegerField()
    changed = serializers.IntegerField()
    productions = serializers.IntegerField()
    templates = serializers.IntegerField()
    utterances = serializers.IntegerField()
    lengthened = serializers.IntegerField()
    upload = serializers.IntegerField(help_text="The key of the upload that undoes it.")


class Proposals(Check):
    """Says what lines propose for the world; stores nothing."""

    @extend_schema(
        operation_id="propose", request=ExampleLines, responses={200: ProposalSerializer}
    )
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        lines = self.read(ExampleLines)["lines"]
        proposal = propose("\n".join(lines), known_world_of(self.world))
        return Response(ProposalSerializer(shown(proposal)).data)


class Examples(WorldRoute):
    """Stores what lines propose, and the lines as utterances; all of it or nothing."""

    http_method_names = ["post", "options"]
    duties = {"POST": Duty.ANNOTATE}
    filter_backends = []

    @extend_schema(
        operation_id="store_examples",
        request=NewExamples,
        responses={201: StoredExamplesSerializer},
    )
    @once
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(NewExamples)
        text, category = "\n".join(sent["lines"]), sent["task_category"]
        stored = store_examples(self.world, text, request.user, category)
        assert stored is not None  # without a key of a form it is stored
        return Response(asdict(stored), HTTPStatus.CREATED)


def shown(proposal: Proposal) -> dict[str, Any]:
    """Return what ``ProposalSerializer`` describes."""
    return {
        "problems": [as_json(each) for each in proposal.problems],
        "classes": [
            {
                "token": each.token,
                "is_named": each.is_named,
                "texts": each.texts,
                "aliases": {text: proposal.names[text] for text in each.texts},
                "lines": each.lines,
            }
            for each in proposal.classes
        ],
        "predicates": [
            {
                "name": each.predicate.name,
                "is_named": each.is_named,
                "signatures": [list(map(str, one.arguments)) for one in each.predicate.signatures],
                "gloss": each.predicate.gloss,
                "lines": each.lines,
            }
            for each in proposal.predicates
        ],
        "productions": [
            {"nonterminal": name, "expansion": expansion}
            for name, expansion in new_productions(proposal)
        ],
        "templates": proposal.templates,
        "changes": proposal.changes,
        "offers": proposal.offers,
        "doubts": proposal.doubts,
        "understood": proposal.understood,
    }

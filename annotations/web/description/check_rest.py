"""What the checker says of something before it is stored, and what storing it would do. Nothing is kept."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any, cast

from django.shortcuts import get_object_or_404
from drf_spectacular.utils import extend_schema
from rest_framework import serializers
from rest_framework.response import Response

from annotations.generation.predicate_check import check_predicate
from annotations.generation.production_check import (
    ProductionEdit,
    check_production,
    consequences_of_production,
)
from annotations.generation.template_check import check_template, samples_of
from annotations.generation.world_consequences import WorldConsequences
from annotations.labelling.entity_spans import anonymizer_of
from annotations.labelling.form_check import check_label
from annotations.language.texts import MAX_FORM, Problem
from annotations.models import Duty, Scope, SemanticTemplate
from annotations.models.corpus import MOST_CHARACTERS
from annotations.rows.stored_problems import as_json
from annotations.showing.paging import LARGEST_INTEGER
from annotations.web.description.predicate_forms import PredicateForm
from annotations.web.description.predicate_rest import NewPredicate
from annotations.web.description.production_forms import ProductionForm
from annotations.web.description.production_rest import NewProduction
from annotations.web.description.template_forms import consequences_of_form
from annotations.web.description.template_rest import TemplateChange, TemplateRoute
from annotations.web.editing.noun_rest import NounRoute
from annotations.web.rest.fields import Fields
from annotations.web.rest.permissions import ApiRequest
from annotations.web.rest.problem_details import ProblemItemSerializer, refusal_of_form
from annotations.web.rest.routes import WorldRoute


def replaced_field() -> serializers.IntegerField:
    return serializers.IntegerField(
        min_value=1,
        max_value=LARGEST_INTEGER,
        required=False,
        help_text="The row that it would replace.",
    )


class FoundSerializer(serializers.Serializer[Any]):
    """What the checker says, each with its place in a field of the body."""

    problems = ProblemItemSerializer(many=True)


class ConsequencesSerializer(serializers.Serializer[Any]):
    """What storing it would do to commands and splits; ``trouble`` says why that is not known."""

    sentence = serializers.CharField()
    trouble = serializers.CharField(allow_blank=True)


class SampleSerializer(serializers.Serializer[Any]):
    text = serializers.CharField()
    english = serializers.CharField()


class TemplateToCheck(TemplateChange):
    replaces = replaced_field()


class CheckedTemplate(FoundSerializer):
    """``commands`` counts what the template makes, as far as it was looked at; samples have entities."""

    english = serializers.CharField(allow_blank=True)
    commands = serializers.IntegerField()
    samples = SampleSerializer(many=True)
    consequences = ConsequencesSerializer(allow_null=True)


class ProductionToCheck(NewProduction):
    replaces = replaced_field()


class GrammarSizeSerializer(serializers.Serializer[Any]):
    """How many commands the grammar of a task category makes at most, as people read it."""

    task_category = serializers.CharField()
    before = serializers.CharField()
    after = serializers.CharField()


class CheckedProductionSerializer(FoundSerializer):
    samples = serializers.ListField(child=serializers.CharField())
    sizes = GrammarSizeSerializer(many=True)
    consequences = ConsequencesSerializer(allow_null=True)


class PredicateToCheck(NewPredicate):
    replaces = replaced_field()


class BrokenTemplateSerializer(serializers.Serializer[Any]):
    id = serializers.IntegerField()
    pattern = serializers.CharField()
    messages = serializers.ListField(child=serializers.CharField())


class CheckedPredicateSerializer(serializers.Serializer[Any]):
    """Forms with the predicate in English, and the templates that it would leave with a problem."""

    samples = SampleSerializer(many=True)
    templates = BrokenTemplateSerializer(many=True)


class FormToCheck(Fields):
    """A form in any notation, and the utterance that it is to be the label of."""

    form = serializers.CharField(max_length=MAX_FORM)
    utterance = serializers.CharField(max_length=MOST_CHARACTERS)


class CheckedForm(FoundSerializer):
    reading = serializers.CharField(allow_blank=True)
    english = serializers.CharField(allow_blank=True)


class Check(WorldRoute):
    """Answers what the checker says; stores nothing."""

    http_method_names = ["post", "options"]
    duties = {"POST": Duty.ANNOTATE}
    scopes = {"POST": Scope.READ}
    filter_backends = []

    def replaced(self, sent: dict[str, Any]) -> Any | None:
        """Return the row that ``replaces`` in the body names. Raises Http404."""
        key = sent.pop("replaces", None)
        return get_object_or_404(self.rows(), pk=key) if key else None


class CheckTemplate(TemplateRoute, Check):
    """Checks a template, and says what storing it would do."""

    @extend_schema(request=TemplateToCheck, responses={200: CheckedTemplate})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(TemplateToCheck)
        row = self.replaced(sent)
        form = self.form_of(row, sent)
        category = form.chosen_category
        checked = check_template(self.world, category, sent["pattern"], sent["form"])
        samples = samples_of(self.world, checked).rows
        answer = {
            "problems": show_problems(checked.problems),
            "english": checked.gloss,
            "commands": checked.size,
            "samples": [{"text": each.text, "english": each.gloss} for each in samples],
            "consequences": show_consequences(consequences_of_form(form)),
        }
        return Response(answer)


class CheckProduction(NounRoute, Check):
    """Checks a line of the grammar, and says what storing it would do."""

    noun_form = ProductionForm

    @extend_schema(request=ProductionToCheck, responses={200: CheckedProductionSerializer})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(ProductionToCheck)
        row = self.replaced(sent)
        form = self.form_of(row, sent)
        form.is_valid()
        if wrong := {name: each for name, each in form.errors.items() if name != "expansion"}:
            raise serializers.ValidationError(cast(dict[str, Any], wrong))
        source, nonterminal = form.cleaned_data["source"], form.cleaned_data["nonterminal"]
        edit = ProductionEdit(self.world, source, nonterminal, sent["expansion"], row)
        checked = check_production(edit)
        expected = None if checked.has_errors else consequences_of_production(edit)
        answer = {
            "problems": show_problems(checked.problems),
            "samples": checked.samples,
            "sizes": [asdict(each) for each in checked.sizes],
            "consequences": show_consequences(expected),
        }
        return Response(answer)


class CheckPredicate(NounRoute, Check):
    """Says a predicate in English, and names the templates that it would break."""

    noun_form = PredicateForm

    @extend_schema(request=PredicateToCheck, responses={200: CheckedPredicateSerializer})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(PredicateToCheck)
        row = self.replaced(sent)
        form = self.form_of(row, sent)
        if not form.is_valid():
            raise refusal_of_form(form)
        checked = check_predicate(self.world, form.predicate)
        templates = [
            {"id": each.pk, "pattern": each.pattern, "messages": messages}
            for each, messages in checked.templates
        ]
        samples = [{"text": each.form, "english": each.sentence} for each in checked.samples]
        return Response({"samples": samples, "templates": templates})


class CheckForm(Check):
    """Checks a form as the label of an utterance."""

    duties = {}
    model = SemanticTemplate

    @extend_schema(request=FormToCheck, responses={200: CheckedForm})
    def post(self, request: ApiRequest, **kwargs: object) -> Response:
        sent = self.read(FormToCheck)
        anonymized = anonymizer_of(self.world).anonymize(sent["utterance"]).command
        checked = check_label(self.world, anonymized, sent["form"], may_be_unknown=True)
        names = ("field", "line", "column", "severity", "message", "hint")
        problems = [{name: each[name] for name in names} for each in checked["problems"]]
        shown = {"problems": problems, "reading": checked["reading"], "english": checked["gloss"]}
        return Response(shown)


def show_problems(problems: Iterable[Problem]) -> list[dict[str, Any]]:
    """Return problems with the fields of the body that they are in."""
    items = map(as_json, problems)
    return [{"field": item["file"], **item} for item in items]


def show_consequences(expected: WorldConsequences | None) -> dict[str, str] | None:
    """Return consequences as people read them; None where there is nothing to expect yet."""
    if expected is None:
        return None
    return {"sentence": expected.sentence, "trouble": expected.trouble}

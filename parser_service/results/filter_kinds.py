"""The kinds of filters that choose predictions.

Each says as a ``FilterCondition`` what its value demands: ``demand(value, given)``, where ``given`` are the values of
all filters.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import django_filters
from django import forms
from django.db.models import Exists, OuterRef, Q, QuerySet
from django.http import QueryDict
from django_filters.fields import ChoiceField

from annotations.showing.filtering import Search
from annotations.showing.paging import LONE_SURROGATE, number_in
from parser_service.models import Prediction, Review, RunAnalysis
from parser_service.models.predictions import OUTCOMES
from parser_service.results.filter_conditions import FilterCondition
from parser_service.results.slot_confusions import SLOTS

LARGEST = 10**6
LONGEST_TEXT = 200
NO_FORM = "not a form"  # the head predicate of an answer that is none, as ``parser_service.analysis`` says
NO_CATEGORY = "none"
MOST_LAMBDAS = 3  # before the head predicate of an answer
Given = Mapping[str, Any]


class ChoiceFilter(django_filters.ChoiceFilter):
    """A column that equals one of the choices. A refinement alone demands nothing."""

    def __init__(self, *args: Any, is_refinement: bool = False, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.is_refinement = is_refinement

    def demand(self, value: str, given: Given) -> FilterCondition | None:
        return None if self.is_refinement else FilterCondition(Q(**{self.field_name: value}))


class OpenSelect(forms.Select):
    """Offers the current value too, where the choices lack it."""

    def optgroups(self, name: str, value: list[str], attrs: Any = None) -> Any:
        known = {str(key) for key, _ in self.choices}
        self.choices = [*self.choices, *((each, each) for each in value if each not in known)]
        return super().optgroups(name, value, attrs)


class OpenChoiceField(ChoiceField):
    """A choice that may also be another text, such as the name of a predicate that was renamed since."""

    widget = OpenSelect

    def valid_value(self, value: str) -> bool:
        return len(value) <= LONGEST_TEXT and "\0" not in value and not LONE_SURROGATE.search(value)


class OpenChoiceFilter(ChoiceFilter):
    field_class = OpenChoiceField


class WholeNumber(django_filters.Filter):
    """A bound on a column."""

    field_class = forms.IntegerField

    def __init__(self, field_name: str, lookup: str, label: str):
        widget = forms.NumberInput(attrs={"placeholder": label})
        bounds = {"min_value": 0, "max_value": LARGEST}
        super().__init__(field_name, lookup, label=label, widget=widget, **bounds)

    def demand(self, value: int, given: Given) -> FilterCondition:
        return FilterCondition(Q(**{f"{self.field_name}__{self.lookup_expr}": value}))


class UtteranceSearch(Search):
    """A text somewhere in the utterance. No column holds the words."""

    def demand(self, value: str, given: Given) -> FilterCondition:
        return FilterCondition(self.condition(value))


class OutcomeFilter(ChoiceFilter):
    """What the answer is worth."""

    def demand(self, value: str, given: Given) -> FilterCondition:
        return FilterCondition(OUTCOMES[value])


class SeenFilter(ChoiceFilter):
    """Whether training had a form. What is not known of an older run is in neither."""

    def demand(self, value: str, given: Given) -> FilterCondition:
        bound = {f"{self.field_name}__gt": 0} if value == "seen" else {self.field_name: 0}
        return FilterCondition(Q(**bound))


class AnswerHead(OpenChoiceFilter):
    """The head predicate of the answer, or ``NO_FORM``."""

    def demand(self, value: str, given: Given) -> FilterCondition:
        rows, prefix = Q(), ""
        if value == NO_FORM:
            rows = Q(is_well_formed=False)
        elif value == "UNKNOWN":
            rows = Q(logical_form="UNKNOWN")
        else:
            for number in range(1, MOST_LAMBDAS + 2):
                rows |= Q(logical_form__startswith=f"{prefix}( {value} ")
                prefix += f"( lambda ${number} e "
            rows &= Q(is_well_formed=True)
        return FilterCondition(rows, columns=Q(answer_head=value))


class AnswerForm(django_filters.CharFilter):
    """The answer is exactly this form. No column holds the forms; an index holds their lengths, which leaves few
    rows whose form has to be read."""

    def demand(self, value: str, given: Given) -> FilterCondition:
        # From an equality SQLite would conclude that the length need not be looked up.
        is_form = Q(logical_form__gte=value, logical_form__lte=value)
        rows = Q(logical_form__length=len(value)) & is_form
        return FilterCondition(rows, columns=Q(answer_form=value))


class CategoryFilter(OpenChoiceFilter):
    """The error category that people put the answer into, or the machine where nobody has.

    ``category_by`` asks for the one or the other alone; ``NO_CATEGORY`` for errors without any.
    """

    def demand(self, value: str, given: Given) -> FilterCondition:
        categories = self.parent.request.world.error_categories
        reviews = Review.objects.filter(category__isnull=False)
        by_people, proposed = reviews.filter(is_proposed=False), reviews.filter(is_proposed=True)
        by = given.get("category_by")
        if value == NO_CATEGORY:
            asked = {"people": by_people, "machine": proposed}.get(by or "", reviews)
            return FilterCondition(Q(is_exact_match=False) & ~self._have(asked))
        category = categories.filter(code=value).first()
        if category is None:
            return FilterCondition(Q(pk__in=()))
        people_say = self._have(by_people.filter(category=category))
        machine_says = self._have(proposed.filter(category=category))
        if by:
            return FilterCondition(people_say if by == "people" else machine_says)
        return FilterCondition(people_say | (machine_says & ~self._have(by_people)))

    def _have(self, reviews: QuerySet[Review]) -> Q:
        """Return the condition that an answer has one of these reviews. Where all answers are of one run, a
        database looks its reviews up once instead of once for each answer."""
        run = self.parent.of_run
        if run is not None:
            return Q(example__in=reviews.filter(run=run).values("example"))
        return Q(Exists(reviews.filter(run=OuterRef("run"), example=OuterRef("example"))))


class SavedSlice(ChoiceFilter):
    """A saved slice by its key: all that it demands."""

    def demand(self, value: str, given: Given) -> FilterCondition | None:
        saved = self.parent.request.world.slices.filter(pk=value).first()
        inner = type(self.parent)(
            QueryDict(saved.query if saved else ""),
            self.parent.queryset.none(),
            request=self.parent.request,
        )
        conditions = inner.conditions()
        if not conditions:
            return None
        rows, columns = Q(), Q()
        for condition in conditions:
            rows &= condition.rows
            columns &= condition.rows if condition.columns is None else condition.columns
        return FilterCondition(rows, columns)


class SlotFilter(django_filters.CharFilter):
    """Answers with one confusion of slots, ``RUN:PREDICATE:PLACE:LABELLED:ANSWERED``, as a stored analysis lists
    them."""

    def demand(self, value: str, given: Given) -> FilterCondition:
        run, _, confusion = value.partition(":")
        examples: list[int] = []
        if key := number_in(run):
            rows = RunAnalysis.objects.filter(run__world=self.parent.request.world, run=key)
            for lists in rows.values_list(f"findings__{SLOTS}__examples", flat=True):
                examples += (lists or {}).get(confusion, [])
        return FilterCondition(Q(example__in=examples))


class VersusRun(django_filters.Filter):
    """What another run of the world made of the same example: ``versus_outcome`` says what."""

    field_class = forms.IntegerField

    def __init__(self, **kwargs: Any):
        super().__init__(min_value=1, max_value=2**62, **kwargs)

    def demand(self, value: int, given: Given) -> FilterCondition:
        answers = Prediction.objects.best().filter(
            run=value, run__world=self.parent.request.world, example=OuterRef("example")
        )
        outcome = given.get("versus_outcome")
        if outcome:
            answers = answers.with_outcome(outcome)
        return FilterCondition(Q(Exists(answers)))

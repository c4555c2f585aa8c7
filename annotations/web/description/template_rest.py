"""The semantic templates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import django_filters
from django.db.models import QuerySet
from rest_framework import serializers

from annotations.language.texts import MAX_FORM, MAX_PATTERN, Refusal
from annotations.models import SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus, template_status_choices
from annotations.web.description.description_filters import TemplateFilters, with_counts
from annotations.web.description.template_forms import TemplateForm, initial_of, values_of
from annotations.web.rest.fields import Fields, LineField
from annotations.web.rest.problem_details import ProblemItemSerializer
from annotations.web.rest.routes import EditableViewSet, Noun


class TemplateSerializer(serializers.ModelSerializer[SemanticTemplate]):
    """A pattern and the logical form of its commands; ``problems`` is what the checker says."""

    author = serializers.CharField(source="author.username", default=None)
    problems = ProblemItemSerializer(many=True)

    class Meta:
        model = SemanticTemplate
        fields = [
            *("id", "task_category", "pattern", "form", "status", "problems", "author"),
            *("source", "line", "position", "version"),
        ]


class TemplateChange(Fields):
    """The form in any notation. Only ready templates make commands."""

    task_category = LineField(max_length=60)
    pattern = serializers.CharField(max_length=MAX_PATTERN)
    form = serializers.CharField(max_length=MAX_FORM)
    status = serializers.ChoiceField(
        choices=template_status_choices(), default=TemplateStatus.READY
    )


class TemplateQuery(TemplateFilters):
    """The filters of the page, and ``makes``: ``nothing`` of the grammar, or something ``outside`` of it."""

    makes = django_filters.ChoiceFilter(
        choices=[("nothing", "nothing"), ("outside", "outside")], method="by_commands"
    )

    def by_commands(self, rows: QuerySet[Any], name: str, value: str) -> QuerySet[Any]:
        counts = {"n_inside": 0} if value == "nothing" else {"n_outside__gt": 0}
        return rows.filter(pk__in=with_counts(self.request.world).filter(**counts).values("pk"))


def category_called(world: World, name: str) -> TaskCategory:
    """Return the task category of this name. Raises Refusal, which names those that there are."""
    categories = TaskCategory.objects.filter(grammar__world=world)
    category = categories.filter(name=name).first()
    if category is None:
        names = ", ".join(categories.values_list("name", flat=True)) or "none"
        said = f"There is no task category “{name}”; there are: {names}."
        problem = {"field": "task_category", "message": said}
        raise Refusal(said, "no_such_task_category", problems=[problem])
    return category


class TemplateNoun(Noun):
    model = SemanticTemplate
    serializer_class = TemplateSerializer
    new_serializer = change_serializer = TemplateChange

    def rows(self) -> QuerySet[SemanticTemplate]:
        rows = SemanticTemplate.objects.filter(grammar__world=self.world)
        return rows.select_related("author", "grammar__world")

    def form_of(self, row: SemanticTemplate | None, sent: Mapping[str, Any]) -> TemplateForm:
        stored: dict[str, Any] = dict(initial_of(self.world, row)) if row else {}
        given = {**stored, **sent}
        category = stored.get("task_category")
        if "task_category" in sent:
            category = category_called(self.world, sent["task_category"])
        given["task_category"] = category.pk if category else ""
        form = TemplateForm(self.world, given, initial=stored)
        form.fields["task_category"].required = row is None  # it stays where it is
        return form

    def unsaved(self, form: TemplateForm) -> SemanticTemplate:
        category = form.cleaned_data["task_category"]
        return SemanticTemplate.for_category(category, **values_of(form))

    def values_of(self, form: TemplateForm, row: SemanticTemplate) -> Mapping[str, Any]:
        return values_of(form) | row.moved_to(form.cleaned_data["task_category"])


class TemplateViewSet(TemplateNoun, EditableViewSet):
    """The semantic templates. After a change the commands follow at once, or as a job."""

    filterset_class = TemplateQuery
    sorts = {"position": "position", "pattern": "pattern", "status": "status", "id": "pk"}

"""The semantic templates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import django_filters
from django.db.models import QuerySet
from rest_framework import serializers

from annotations.language.texts import LanguageError, Refusal
from annotations.models import SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus, template_status_choices
from annotations.rows.composition import require_set_name
from annotations.web.description.description_filters import TemplateFilters, with_counts
from annotations.web.description.template_forms import TemplateForm
from annotations.web.editing.noun_rest import NounRoute, NounViewSet
from annotations.web.forms import sentence_of
from annotations.web.rest.fields import LineField
from annotations.web.rest.form_fields import FormFields
from annotations.web.rest.problem_details import ProblemItemSerializer


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


class TemplateChange(FormFields):
    """The form in any notation. Only ready templates make commands.

    ``task_category`` is the only one by default. In a world without any it names the first one.
    """

    task_category = LineField(max_length=60, required=False)
    status = serializers.ChoiceField(
        choices=template_status_choices(), default=TemplateStatus.READY
    )

    class Meta:
        form = TemplateForm
        fields = ["pattern", "form"]


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
        names = ", ".join(categories.values_list("name", flat=True))
        said = f"There is no task category “{name}”; there are: {names}. POST it to task-categories/ first."
        problem = {"field": "task_category", "message": said}
        raise Refusal(said, "no_such_task_category", problems=[problem])
    return category


def name_of_first(name: str) -> str:
    """Return ``name`` if a world's first task category can have it. Raises Refusal."""
    try:
        require_set_name(name)
    except LanguageError as error:
        said = sentence_of(error)
        problem = {"field": "task_category", "message": said}
        raise Refusal(said, "no_such_task_category", problems=[problem]) from error
    return name


class TemplateRoute(NounRoute):
    noun_form = TemplateForm

    def rows(self) -> QuerySet[Any]:
        return super().rows().select_related("author", "grammar__world")

    def form_of(self, row: SemanticTemplate | None, sent: Mapping[str, Any]) -> TemplateForm:
        given = {**(TemplateForm.shown(row) if row else {}), **sent}
        name = sent.get("task_category")
        has_any = TaskCategory.objects.filter(grammar__world=self.world).exists()
        if name is not None and has_any:
            given["task_category"] = category_called(self.world, name)
        category = given.get("task_category")
        given["task_category"] = category.pk if has_any and category else ""
        form = TemplateForm(self.world, row, given)
        if name is not None and not has_any:
            form.first_category = name_of_first(name)
        return form


class TemplateViewSet(TemplateRoute, NounViewSet):
    """The semantic templates. After a change the commands follow at once, or as a job."""

    serializer_class = TemplateSerializer
    new_serializer = change_serializer = TemplateChange
    filterset_class = TemplateQuery
    sorts = {"position": "position", "pattern": "pattern", "status": "status", "id": "pk"}

"""The form of a semantic template, and what saving it would do."""

from __future__ import annotations

import copy
from typing import Any

from django import forms
from django.db import transaction

from annotations.editing.edits import add
from annotations.editing.task_categories import begin_grammar
from annotations.generation.template_check import CheckedTemplate, check_template
from annotations.generation.world_consequences import (
    TemplateChange,
    WorldConsequences,
    consequences,
)
from annotations.language.forms import plain_marks
from annotations.language.texts import MAX_FORM, MAX_PATTERN
from annotations.models import (
    Production,
    SemanticTemplate,
    TaskCategory,
    User,
    World,
)
from annotations.models.description import TemplateStatus, template_status_choices
from annotations.rows.composition import FIRST_CATEGORY
from annotations.web.editing.noun_forms import NounForm
from annotations.web.forms import row_field


class TemplateForm(NounForm):
    """A pattern and its logical form. An error of the checker keeps a template from being ready.

    ``checked`` is what the checker says, once the form has been validated and holds both sides. In a world without
    task categories the first template makes one, called ``first_category``.
    """

    model = SemanticTemplate
    edited = ("pattern", "form", "status")
    key = "pattern"

    task_category = forms.ModelChoiceField(TaskCategory.objects.none(), empty_label=None)
    pattern = forms.CharField(
        max_length=MAX_PATTERN,
        widget=forms.Textarea(attrs={"rows": 2, "data-editor": "pattern"}),
    )
    form = forms.CharField(
        label="Logical form",
        max_length=MAX_FORM,
        widget=forms.Textarea(attrs={"rows": 4, "data-editor": "form"}),
    )
    status = forms.ChoiceField(
        choices=template_status_choices,
        initial=TemplateStatus.READY,
        help_text="Only ready templates make commands.",
    )

    first_category = FIRST_CATEGORY

    def __init__(self, world: World, *args: Any, **options: Any):
        super().__init__(world, *args, **options)
        self.checked: CheckedTemplate | None = None
        categories = TaskCategory.objects.filter(grammar__world=world)
        row_field(self, "task_category").queryset = categories
        first_two = categories[:2]
        if len(first_two) < 2 and self.row is None:  # there is nothing to choose
            self.fields["task_category"].required = False
            self.fields["task_category"].widget = forms.HiddenInput()
            # The editor asks for the completions of this one.
            self.initial.setdefault("task_category", next(iter(first_two), None))
        if self.row is not None:  # it stays where it is
            self.fields["task_category"].required = False
            self.fields[
                "task_category"
            ].help_text = "Choose another one to move the template there."
        for name, example in example_template(world).items():
            self.fields[name].widget.attrs["placeholder"] = example

    @classmethod
    def shown(cls, row: Any) -> dict[str, Any]:
        categories = TaskCategory.objects.filter(grammar=row.grammar_id)
        category = categories.filter(name=row.task_category).first()
        return {**super().shown(row), "task_category": category}

    @property
    def values(self) -> dict[str, Any]:
        """The values to store, with the problems that the checker found."""
        problems = self.checked.stored_problems if self.checked else []
        moved = self.row.moved_to(self.cleaned_data["task_category"]) if self.row else {}
        return {**super().values, "problems": problems, **moved}

    def store(self, by: User, once: str = "") -> SemanticTemplate:
        with transaction.atomic():
            begin_grammar(self.world, self.first_category, by)
            return add(self.unsaved(), by, once)

    def unsaved(self) -> SemanticTemplate:
        category = self.chosen_category
        assert category is not None  # ``store`` has made one
        return SemanticTemplate.for_category(category, **self.values)

    def clean_form(self) -> str:
        return plain_marks(self.cleaned_data["form"])

    def clean(self) -> dict[str, Any]:
        cleaned = self.cleaned_data
        if self.errors:
            return cleaned
        self.checked = check_template(
            self.world, self.chosen_category, cleaned["pattern"], cleaned["form"]
        )
        errors = [problem for problem in self.checked.problems if problem.is_error]
        for problem in errors if cleaned["status"] != TemplateStatus.DRAFT else ():
            side = "form" if problem.position.source == "form" else "pattern"
            hint = f" ({problem.hint})" if problem.hint else ""
            self.add_error(side, f"{problem.message}{hint}")
        return cleaned

    @property
    def chosen_category(self) -> TaskCategory | None:
        """The chosen task category, or else that of the template, or else the last one."""
        field: Any = row_field(self, "task_category")
        try:
            chosen: TaskCategory | None = field.clean(self["task_category"].value())
        except forms.ValidationError:
            chosen = None
        found: TaskCategory | None = (
            chosen or self.initial.get("task_category") or field.queryset.last()
        )
        return found


def example_template(world: World) -> dict[str, str]:
    """Return a pattern and a form of this world to show in the empty fields of a new template."""
    template = SemanticTemplate.objects.filter(
        grammar__world=world, status=TemplateStatus.READY
    ).first()
    if template:
        return {"pattern": template.pattern, "form": template.form}
    production = Production.objects.filter(grammar__world=world).order_by("position").first()
    return {"pattern": production.expansion} if production else {}


def consequences_of_form(form: TemplateForm) -> WorldConsequences | None:
    """Return what saving the form would change.

    None while a side is empty. ``trouble`` is set if an error keeps the template from being saved.
    """
    world, row = form.world, form.row
    form.is_valid()  # the template may be a draft, and then an error does not stop it
    values = {name: form[name].value() or "" for name in ("pattern", "form", "status")}
    category = form.chosen_category
    if not values["pattern"].strip() or not values["form"].strip() or category is None:
        return None
    if form.errors:
        return WorldConsequences(trouble="correct the errors first")
    if row:
        values |= row.moved_to(category)
    return consequences(world, change_to(row, category, values))


def change_to(
    row: SemanticTemplate | None, category: TaskCategory, values: dict[str, Any]
) -> TemplateChange:
    """Return the change that saving ``values`` over ``row`` makes. Without a row it is a new template."""
    after = copy.copy(row) if row else SemanticTemplate.for_category(category)
    for name, value in values.items():
        setattr(after, name, value)
    return TemplateChange(row, after)

"""The forms of the annotation pages."""

from __future__ import annotations

from typing import Any

from django import forms

from annotations.checking import check_template
from annotations.models import TaskCategory, World
from annotations.models.templates import Status, template_status_choices


class TemplateForm(forms.Form):
    """A pattern and its form. What the checker calls an error keeps a template from being ready."""

    task_category = forms.ModelChoiceField(queryset=None, empty_label=None)
    pattern = forms.CharField(widget=forms.Textarea(attrs={"rows": 2, "data-editor": "pattern"}))
    form = forms.CharField(
        label="Logical form", widget=forms.Textarea(attrs={"rows": 4, "data-editor": "form"})
    )
    status = forms.ChoiceField(
        choices=template_status_choices,
        initial=Status.READY,
        help_text="Only ready templates make commands.",
    )
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.world = world
        self.fields["task_category"].queryset = TaskCategory.objects.filter(grammar__world=world)

    def clean(self) -> dict[str, Any]:
        cleaned = super().clean()
        if self.errors or cleaned["status"] == Status.DRAFT:
            return cleaned
        checked = check_template(
            self.world, cleaned["task_category"], cleaned["pattern"], cleaned["form"]
        )
        for problem in checked.problems:
            if problem.is_error:
                side = "form" if problem.position.source == "form" else "pattern"
                self.add_error(
                    side, f"{problem.message} ({problem.hint})" if problem.hint else problem.message
                )
        return cleaned


class ManyFiles(forms.ClearableFileInput):
    allow_multiple_selected = True


class FilesField(forms.FileField):
    """Several uploaded files; cleans to a list of them."""

    widget = ManyFiles

    def clean(self, data: Any, initial: Any = None) -> list[Any]:
        files = data if isinstance(data, list | tuple) else [data]
        return [super(FilesField, self).clean(file, initial) for file in files]


class ImportForm(forms.Form):
    """The files of a generator, as they are or in one zip archive."""

    files = FilesField(
        label="Files",
        help_text="The grammar, template and ontology files of one generator: choose all of them, "
        "or one zip archive with them.",
    )

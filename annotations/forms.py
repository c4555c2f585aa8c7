"""The forms of the annotation pages."""

from __future__ import annotations

from typing import Any

from django import forms
from django.http import HttpRequest, QueryDict

from annotations.checking import check_template
from annotations.models import TaskCategory, World
from annotations.models.splits import criterion_choices
from annotations.models.templates import Status, template_status_choices


def posted(request: HttpRequest) -> QueryDict | None:
    """What a form is bound to; None while nothing has been sent."""
    return request.POST if request.method == "POST" else None


PATTERN_EDITOR = {
    "rows": 2,
    "data-editor": "pattern",
    "placeholder": "$vbfind the {kobject} in the {room}",
}
FORM_EDITOR = {
    "rows": 4,
    "data-editor": "form",
    "placeholder": "(find (λ$1:e (is_a $1 {kobject}) (at $1 {room})))",
}


class TemplateForm(forms.Form):
    """A pattern and its form. What the checker calls an error keeps a template from being ready."""

    task_category = forms.ModelChoiceField(queryset=None, empty_label=None)
    pattern = forms.CharField(widget=forms.Textarea(attrs=PATTERN_EDITOR))
    form = forms.CharField(label="Logical form", widget=forms.Textarea(attrs=FORM_EDITOR))
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


class WorldForm(forms.ModelForm):
    """The name of a world stands in its addresses and does not change."""

    class Meta:
        model = World
        fields = ["name", "description"]
        widgets = {"description": forms.Textarea(attrs={"rows": 2})}
        help_texts = {
            "name": "Lower-case letters, digits, _ and -. It stands in addresses and commands.",
            "description": "A sentence for those who see it in the list.",
        }


class SplitForm(forms.Form):
    """How to part the pairs. Shares are in percent and sum to 100."""

    SHARES = ("train", "validation", "test")

    name = forms.SlugField(
        max_length=80, help_text="Letters, digits, _ and -. It stands in tables and addresses."
    )
    criterion = forms.ChoiceField(
        label="No two parts share a",
        choices=lambda: [(name, label.lower()) for name, label in criterion_choices()],
        help_text="A logical form in one part only is the harder test.",
    )
    seed = forms.IntegerField(
        initial=0, min_value=0, max_value=2**32 - 1, help_text="The same seed, the same split."
    )
    train = forms.FloatField(label="Train, %", initial=70, min_value=0, max_value=100)
    validation = forms.FloatField(label="Validation, %", initial=10, min_value=0, max_value=100)
    test = forms.FloatField(label="Test, %", initial=20, min_value=0, max_value=100)

    @property
    def what(self) -> list[forms.BoundField]:
        return [field for field in self if field.name not in self.SHARES]

    @property
    def shares(self) -> list[forms.BoundField]:
        return [self[name] for name in self.SHARES]

    @property
    def choice(self) -> dict[str, Any]:
        """What the verb wants, once the form is valid."""
        shares = [self.cleaned_data[part] / 100 for part in self.SHARES]
        chosen = {name: self.cleaned_data[name] for name in ("criterion", "seed")}
        return {**chosen, "proportions": shares}


class ManyFiles(forms.ClearableFileInput):
    allow_multiple_selected = True


class FilesField(forms.FileField):
    """Several uploaded files; cleans to a list of them."""

    widget = ManyFiles

    def clean(self, data: Any, initial: Any = None) -> list[Any]:
        files = (data if isinstance(data, list | tuple) else [data]) or [None]
        return [super(FilesField, self).clean(file, initial) for file in files]


class PairsForm(forms.Form):
    """The pair files of a published corpus, in one archive."""

    name = forms.SlugField(
        max_length=60, help_text="The splits are called by it: name-command, name-logical_form."
    )
    archive = forms.FileField(
        help_text="A zip archive with any of the folders gen, para, gen_logical and para_logical "
        "(train.txt, val.txt, test.txt in each) and paraphrasings.txt."
    )


class ImportForm(forms.Form):
    """The files of a generator, as they are or in one zip archive."""

    files = FilesField(
        label="Files",
        help_text="The grammar, template and ontology files of one generator: choose all of them, "
        "or one zip archive with them.",
    )

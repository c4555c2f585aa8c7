"""The forms of the annotation pages."""

from __future__ import annotations

from typing import Any

from django import forms
from django.db import IntegrityError, transaction
from django.http import HttpRequest, QueryDict

from annotations.checking import Checked, check_template
from annotations.editing.once import new_key
from annotations.language.decoding import decode
from annotations.language.errors import LanguageError
from annotations.language.limits import MAX_FORM, MAX_PATTERN
from annotations.models import Origin, Production, SemanticTemplate, TaskCategory, World
from annotations.models.description import TemplateStatus, template_status_choices
from annotations.models.editing import MOST_CHARACTERS_OF_COMMENT
from annotations.models.splits import criterion_choices


def posted(request: HttpRequest) -> QueryDict | None:
    """Return the data to bind a form to; None when nothing has been sent."""
    return request.POST if request.method == "POST" else None


class TemplateForm(forms.Form):
    """A pattern and its logical form. An error of the checker keeps a template from being ready.

    ``checked`` is what the checker says, once the form has been validated and holds both sides.
    """

    task_category = forms.ModelChoiceField(queryset=None, empty_label=None)
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
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        self.world = world
        self.checked: Checked | None = None
        self.fields["task_category"].queryset = TaskCategory.objects.filter(grammar__world=world)
        for name, example in example_template(world).items():
            self.fields[name].widget.attrs["placeholder"] = example

    def clean(self) -> dict[str, Any]:
        cleaned = super().clean()
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
        """The chosen task category; where none is, that of the template, or else the last one."""
        field = self.fields["task_category"]
        try:
            chosen = field.clean(self["task_category"].value())
        except forms.ValidationError:
            chosen = None
        return chosen or self.initial.get("task_category") or field.queryset.last()


def example_template(world: World) -> dict[str, str]:
    """Return a pattern and a form of this world to show in the empty fields of a new template."""
    template = SemanticTemplate.objects.filter(
        grammar__world=world, status=TemplateStatus.READY
    ).first()
    if template:
        return {"pattern": template.pattern, "form": template.form}
    production = Production.objects.filter(grammar__world=world).order_by("position").first()
    return {"pattern": production.expansion} if production else {}


class UtterancesForm(forms.Form):
    """Utterances to label: pasted, one a line, or in a text file."""

    MOST_BYTES = 2_000_000

    text = forms.CharField(
        label="Utterances",
        required=False,
        max_length=MOST_BYTES,
        widget=forms.Textarea(
            attrs={"rows": 10, "placeholder": "could you get me the red mug from the kitchen"}
        ),
        help_text="One a line.",
    )
    file = forms.FileField(
        label="Or a text file", required=False, help_text="UTF-8, one utterance a line."
    )

    def clean_file(self) -> list[str]:
        """Return the lines of the file; none without one."""
        file = self.cleaned_data["file"]
        if file is None:
            return []
        if file.size > self.MOST_BYTES:
            raise forms.ValidationError(
                f"The file has {file.size:,} bytes; {self.MOST_BYTES:,} is the limit."
            )
        try:
            return decode(file.read(), file.name).splitlines()
        except LanguageError as error:
            raise forms.ValidationError(str(error)) from error

    def clean(self) -> dict[str, Any]:
        cleaned = super().clean()
        if not self.errors and not any(line.strip() for line in self.lines):
            self.add_error("text", "Write an utterance, or choose a file that has some.")
        return cleaned

    @property
    def lines(self) -> list[str]:
        """What was pasted, and then what the file holds."""
        return [*self.cleaned_data.get("text", "").splitlines(), *self.cleaned_data["file"]]

    @property
    def origin(self) -> str:
        return Origin.UPLOADED if self.cleaned_data["file"] else Origin.PASTED


class CommentForm(forms.Form):
    """What somebody says about a row."""

    text = forms.CharField(
        label="Your comment",
        max_length=MOST_CHARACTERS_OF_COMMENT,
        widget=forms.Textarea(attrs={"rows": 3}),
        help_text="Write @name to reach a member of this world.",
    )


class CommentEditForm(CommentForm):
    """What a comment is to say instead; ``version`` is the one that was edited."""

    version = forms.IntegerField(min_value=1, widget=forms.HiddenInput)


class WorldForm(forms.ModelForm):
    """A new world. Its name is used in URLs and never changes."""

    class Meta:
        model = World
        fields = ["name", "description"]
        widgets = {"description": forms.Textarea(attrs={"rows": 2})}
        help_texts = {
            "name": "Lower-case letters, digits, _ and -. Used in URLs and commands.",
            "description": "One sentence, shown in the list of worlds.",
        }

    def create(self) -> World | None:
        """Store the world that a valid form describes; None, with an error, where somebody was quicker."""
        try:
            with transaction.atomic():
                return self.save()
        except IntegrityError:
            self.add_error("name", "There is a world of this name already. Choose another name.")
            return None


class SplitForm(forms.Form):
    """How to split the pairs. The shares are percentages that sum to 100."""

    SHARES = ("train", "validation", "test")

    name = forms.SlugField(
        max_length=80, help_text="Letters, digits, _ and -. Used in tables and URLs."
    )
    criterion = forms.ChoiceField(
        label="Keep apart by",
        choices=lambda: [(name, label.lower()) for name, label in criterion_choices()],
        help_text="No two parts share one. By logical form is the harder test.",
    )
    seed = forms.IntegerField(
        initial=0, min_value=0, max_value=2**32 - 1, help_text="The same seed gives the same split."
    )
    train = forms.FloatField(label="Train, %", initial=70, min_value=0, max_value=100)
    validation = forms.FloatField(label="Validation, %", initial=10, min_value=0, max_value=100)
    test = forms.FloatField(label="Test, %", initial=20, min_value=0, max_value=100)

    def clean(self) -> dict[str, Any]:
        """Refuse shares that are no whole, in percent as they are asked for."""
        cleaned = super().clean()
        shares = [cleaned[part] for part in self.SHARES if part in cleaned]
        if len(shares) == len(self.SHARES) and abs(sum(shares) - 100) > 1e-4:
            self.add_error(
                "test", f"The three shares sum to {sum(shares):g} %; they have to sum to 100 %."
            )
        return cleaned

    @property
    def what(self) -> list[forms.BoundField]:
        return [field for field in self if field.name not in self.SHARES]

    @property
    def shares(self) -> list[forms.BoundField]:
        return [self[name] for name in self.SHARES]

    @property
    def choice(self) -> dict[str, Any]:
        """Return the arguments of ``freeze_split`` and ``plan_split``, once the form is valid."""
        shares = [self.cleaned_data[part] / 100 for part in self.SHARES]
        chosen = {name: self.cleaned_data[name] for name in ("criterion", "seed")}
        return {**chosen, "proportions": shares}


class UncoveredFilters(forms.Form):
    """What the commands without a form may be filtered by. Each name is a parameter of the page's URL."""

    q = forms.CharField(
        label="Search",
        required=False,
        max_length=200,
        widget=forms.SearchInput(attrs={"placeholder": "Search"}),
    )
    task_category = forms.ChoiceField(label="Task category", required=False)
    nonterminal = forms.ChoiceField(label="Nonterminal", required=False)

    def __init__(self, categories: list[str], nonterminals: list[str], *args: Any) -> None:
        super().__init__(*args)
        self.fields["task_category"].choices = _choices("Task category", categories)
        names = {name: f"${name}" for name in nonterminals}
        self.fields["nonterminal"].choices = [("", "Nonterminal: any"), *names.items()]


def _choices(label: str, names: list[str]) -> list[tuple[str, str]]:
    return [("", f"{label}: any"), *((name, name) for name in names)]

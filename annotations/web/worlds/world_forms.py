"""The form that creates or describes a world."""

from __future__ import annotations

from textwrap import shorten
from typing import Any

from django import forms
from django.db import IntegrityError, transaction
from django.http import QueryDict
from django.utils.text import slugify

from annotations.editing.edits import say_who
from annotations.exchange.shipped_worlds import SHIPPED_WORLDS, request_load
from annotations.models import AuditEntry, Job, User, World
from annotations.models.worlds import Role
from annotations.people.members import add_roles


def start_choices() -> list[tuple[str, str]]:
    """Return what a new world may begin with, and what that is: nothing, what people say, or a world that comes with
    this project."""
    shipped = ((each.name, each.description) for each in SHIPPED_WORLDS.values())
    return [
        ("", "You describe it by hand, or import the files of a command generator."),
        (EXAMPLES, "You write what people will say next, and mark what may change."),
        *shipped,
    ]


EXAMPLES = "what people say"
DESCRIBES = "describe the world"  # the words of the audit log
NAME_TAKEN = "There is a world of this name already. Choose another name."
LONGEST_SHOWN = 400  # characters of what another admin has saved
AT_WORK = "Jobs wait or run in this world, and find it by its name. Rename it when they have ended, or stop them."


class WorldForm(forms.ModelForm):  # type: ignore[type-arg]  # generic in the stubs alone
    """A world. Its name stands in all addresses below it."""

    class Meta:
        model = World
        fields = ["name", "description"]
        widgets = {"description": forms.Textarea(attrs={"rows": 2})}
        help_texts = {
            "name": "Lower-case letters, digits, _ and -. Used in URLs and commands.",
            "description": "One sentence, shown in the list of worlds.",
        }

    def full_clean(self) -> None:
        super().full_clean()
        fitting = slugify(self["name"].value() or "")
        if fitting and self.is_bound and self.has_error("name", "invalid"):
            self.add_error("name", f"{fitting} would do.")

    def create(self, by: User) -> World | None:
        """Create the world of a valid form, with ``by`` as its admin. Return None, with an error, if the name was
        taken meanwhile."""
        try:
            with transaction.atomic():
                created: World = self.save()
                add_roles(created, by, [Role.ADMIN])
        except IntegrityError:
            self.add_error("name", NAME_TAKEN)
            return None
        return created

    def change(self) -> bool:
        """Save the world of a valid form, its own columns alone. Return False, with an error, if the name is taken, or
        cannot change now."""
        changed = [
            name for name in self.Meta.fields if self.cleaned_data[name] != self.initial[name]
        ]
        try:
            with transaction.atomic():
                is_changed = "name" not in changed or self._let_jobs_follow()
                if is_changed:
                    self.instance.save(update_fields=changed)
        except IntegrityError:
            self.add_error("name", NAME_TAKEN)
            return False
        return is_changed

    def _let_jobs_follow(self) -> bool:
        """Tell jobs the new name: what was asked is answered in this world, and never in a later one that takes the
        old name. Return False, with an error, while any is active."""
        World.objects.hold().get(pk=self.instance.pk)  # an import holds it while it writes
        jobs = Job.objects.filter(world=self.instance)
        if jobs.active().exists():
            self.add_error("name", AT_WORK)
            return False
        jobs.update(world_name=self.cleaned_data["name"])
        return True


class WorldEditForm(WorldForm):
    """A world as an admin has seen and changed it: what another one has saved meanwhile is neither lost nor hidden.

    ``seen_…`` are the values that the page showed. A field that the reader left as it was keeps what is stored now.
    """

    seen_name = forms.CharField(required=False, strip=False, widget=forms.HiddenInput)
    seen_description = forms.CharField(required=False, strip=False, widget=forms.HiddenInput)

    def __init__(self, world: World, reader: User, data: QueryDict | None) -> None:
        seen = {f"seen_{name}": getattr(world, name) for name in self.Meta.fields}
        super().__init__(data, instance=world, initial=seen)
        self._reader = reader

    def clean(self) -> dict[str, Any]:
        values = super().clean() or self.cleaned_data
        for name in self.Meta.fields:
            key, stored = f"seen_{name}", str(self.initial[name])
            if key not in self.data or not values.keys() >= {name, key}:
                continue
            seen, typed = _lines(values[key]), _lines(values[name])
            if typed == seen:
                values[name] = stored
            elif _lines(stored) not in (seen, typed):
                self.add_error(name, self._say_overtaken(name, stored))
                assert isinstance(self.data, QueryDict)
                self.data = self.data.copy()
                self.data[key] = stored  # whoever saves again has read it
        return values

    def _say_overtaken(self, name: str, stored: str) -> str:
        world = self.instance
        entries = AuditEntry.objects.filter(world=world, what=DESCRIBES)
        last = entries.select_related("who").first()
        who = say_who(last.who if last else None, self._reader, f"saved another {name}")
        now = f"It is “{shorten(stored, LONGEST_SHOWN)}” now." if stored else "It is empty now."
        return f"{who} {now} Save again to put yours in its place."


def _lines(text: str) -> str:
    """Return a text with the line ends that are stored; browsers send others."""
    return text.replace("\r\n", "\n").strip()


class NewWorldForm(WorldForm):
    """A new world, empty or with what a shipped one holds."""

    starts_with = forms.ChoiceField(
        label="Starts with",
        choices=start_choices,
        required=False,
        widget=forms.RadioSelect,
        initial="",
    )

    def create(self, by: User) -> World | None:
        """Create the world; one that starts with nothing shipped has no classes of entities either."""
        self.instance.is_bare = self.cleaned_data["starts_with"] not in SHIPPED_WORLDS
        return super().create(by)

    def load(self, created: World, by: User) -> Job | None:
        """Queue the loading of what ``created`` starts with; None where it starts empty."""
        chosen = self.cleaned_data["starts_with"]
        return request_load(chosen, created, by) if chosen in SHIPPED_WORLDS else None

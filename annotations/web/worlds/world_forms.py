"""The form that creates or describes a world."""

from __future__ import annotations

from django import forms
from django.db import IntegrityError, transaction

from annotations.models import Job, User, World
from annotations.models.worlds import Role
from annotations.people.members import add_roles
from annotations.worlds.shipped_worlds import SHIPPED_WORLDS, request_load


def start_choices() -> list[tuple[str, str]]:
    """Return what a new world may begin with, and what that is: nothing, or a world that comes with this project."""
    shipped = ((each.name, each.description) for each in SHIPPED_WORLDS.values())
    return [("", "You import the files of a command generator next."), *shipped]


NAME_TAKEN = "There is a world of this name already. Choose another name."


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
        """Save the world of a valid form, its own columns alone. Return False, with an error, if the name is taken."""
        try:
            with transaction.atomic():
                self.instance.save(update_fields=self.changed_data)
        except IntegrityError:
            self.add_error("name", NAME_TAKEN)
            return False
        return True


class NewWorldForm(WorldForm):
    """A new world, empty or with what a shipped one holds."""

    starts_with = forms.ChoiceField(
        label="Starts with",
        choices=start_choices,
        required=False,
        widget=forms.RadioSelect,
        initial="",
    )

    def load(self, created: World, by: User) -> Job | None:
        """Queue the loading of what ``created`` starts with; None where that is nothing."""
        shipped = self.cleaned_data["starts_with"]
        return request_load(shipped, created, by) if shipped else None

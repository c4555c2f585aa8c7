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
        try:
            with transaction.atomic():
                is_changed = "name" not in self.changed_data or self._let_jobs_follow()
                if is_changed:
                    self.instance.save(update_fields=self.changed_data)
        except IntegrityError:
            self.add_error("name", NAME_TAKEN)
            return False
        return is_changed

    def _let_jobs_follow(self) -> bool:
        """Tell jobs the new name: what was asked is answered in this world, and never in a later one that takes the
        old name. Return False, with an error, while any is active."""
        World.objects.select_for_update().get(
            pk=self.instance.pk
        )  # an import holds it while it writes
        jobs = Job.objects.filter(world=self.instance)
        if jobs.active().exists():
            self.add_error("name", AT_WORK)
            return False
        jobs.update(world_name=self.cleaned_data["name"])
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

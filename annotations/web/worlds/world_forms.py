"""The form that creates or describes a world."""

from __future__ import annotations

from django import forms
from django.db import IntegrityError, transaction

from annotations.models import World


class WorldForm(forms.ModelForm):  # type: ignore[type-arg]  # generic in the stubs alone
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
        """Create the world of a valid form. Return None, with an error, if the name was taken meanwhile."""
        try:
            with transaction.atomic():
                created: World = self.save()
        except IntegrityError:
            self.add_error("name", "There is a world of this name already. Choose another name.")
            return None
        return created

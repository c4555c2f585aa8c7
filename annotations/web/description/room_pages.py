"""Choosing the rooms of locations, which files of a competition do not say."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import Overtaken, change_many
from annotations.language.texts import say_count
from annotations.language.world import guess_room
from annotations.models import Duty, Entity, World
from annotations.people.access import READ_AND_WRITE, WorldRequest, world_view
from annotations.web.forms import posted

MOST_LOCATIONS = 500  # on one page


class RoomsForm(forms.Form):
    """A choice of a room for each location; the name of a field is the key of the location."""

    def __init__(self, world: World, *args: Any, **kwargs: Any):
        super().__init__(*args, **kwargs)
        entities = Entity.objects.filter(ontology__world=world).order_by("position")
        rooms = list(dict.fromkeys(row.text for row in entities.filter(entity_class="room")))
        locations = entities.filter(entity_class="location")
        self.locations = {str(row.pk): row for row in locations[:MOST_LOCATIONS]}
        self.rooms = rooms
        for name, row in self.locations.items():
            room = row.attributes.get("room", "")
            guessed = "" if room else guess_room(row.text, rooms)
            known = [*rooms, *([room] if room and room not in rooms else [])]
            self.fields[name] = forms.ChoiceField(
                label=row.text,
                required=False,
                initial=room or guessed,
                help_text="guessed from its name" if guessed else "",
                choices=[("", "no room"), *((each, each) for each in known)],
            )

    @property
    def changes(self) -> list[tuple[Entity, dict[str, Any]]]:
        """The locations of a valid form that get another room, each with its new attributes."""
        changes = []
        for name, row in self.locations.items():
            room = self.cleaned_data.get(name, "")
            if name in self.data and room != row.attributes.get("room", ""):
                others = {key: value for key, value in row.attributes.items() if key != "room"}
                changes.append(
                    (row, {"attributes": {**others, **({"room": room} if room else {})}})
                )
        return changes


@world_view(Duty.ANNOTATE, READ_AND_WRITE, does="choose rooms")
def location_rooms(request: WorldRequest, world: World) -> HttpResponse:
    """Show the locations with their rooms, and store other ones."""
    form = RoomsForm(world, posted(request))
    if form.is_bound and form.is_valid():
        changes = form.changes
        try:
            change_many(world, changes, request.user)
        except Overtaken:
            form.add_error(None, "Somebody has changed a location in the meantime. Choose again.")
        else:
            if changes:
                messages.success(
                    request, f"Saved the rooms of {say_count(len(changes), 'location')}."
                )
            return redirect("ontology", world=world.name)
    status = 422 if form.errors else 200
    context = {"form": form, "most": MOST_LOCATIONS}
    return render(request, "annotations/description/location_rooms.html", context, status=status)

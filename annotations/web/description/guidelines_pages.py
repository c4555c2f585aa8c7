"""The guidelines for annotators: everybody of the world reads them, admins write them."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpResponse
from django.shortcuts import redirect, render

from annotations.editing.edits import Overtaken, add
from annotations.editing.once_keys import new_key
from annotations.models import Duty, Guidelines, World
from annotations.models.description import MOST_CHARACTERS_OF_GUIDELINES
from annotations.people.access import NOTHING, READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.showing.markdown import rendered
from annotations.web.editing.merge_pages import merge_page, save_edit
from annotations.web.forms import posted


class GuidelinesForm(forms.Form):
    """The guidelines for annotators, in Markdown."""

    text = forms.CharField(
        label="Guidelines",
        max_length=MOST_CHARACTERS_OF_GUIDELINES,
        required=False,
        strip=False,
        widget=forms.Textarea(attrs={"rows": 18}),
        help_text="Markdown: # heading, - list, **strong**, `form`, [words](address). HTML and images are not shown.",
    )
    version = forms.IntegerField(widget=forms.HiddenInput, required=False)
    once = forms.CharField(widget=forms.HiddenInput, required=False, max_length=60, initial=new_key)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE, does="write guidelines")
def guidelines(request: WorldRequest, world: World) -> HttpResponse:
    """Show the guidelines; a POST saves them as their next version."""
    row = world.guidelines.first()
    form = GuidelinesForm(posted(request), initial=initial_values(row) if row else {})
    if request.method == "POST" and form.is_valid():
        text = form.cleaned_data["text"]
        try:
            if row is None:
                unsaved = Guidelines(world=world, text=text)
                row = add(unsaved, request.user, form.cleaned_data["once"])
            else:
                row = save_edit(request, row, form, {"text": text})
        except Overtaken as clash:
            found = row or Guidelines(world=world, version=0)
            return merge_page(request, found, form, clash, initial_values)
        except ValidationError as error:
            form.add_error(None, error)
        else:
            messages.success(request, f"Saved as version {row.version}.")
            return redirect("guidelines", world=world.name)
    # A text that is refused as too long would take long to render.
    text = "" if form["text"].errors else form["text"].value() or ""
    context = {"row": row, "form": form, "preview": rendered(text)}
    return render(request, "annotations/description/guidelines.html", context)


@world_view(Duty.MANAGE, WRITE, does=NOTHING)
def guidelines_preview(request: WorldRequest, world: World) -> HttpResponse:
    """Show what the typed guidelines look like."""
    form = GuidelinesForm(request.POST)
    text = form.cleaned_data["text"] if form.is_valid() else ""
    context = {"preview": rendered(text), "form": form}
    return render(request, "annotations/description/_guidelines_preview.html", context)


def initial_values(row: Any) -> dict[str, Any]:
    """Return what the fields of the form show for ``row``."""
    return {"text": row.text, "version": row.version}

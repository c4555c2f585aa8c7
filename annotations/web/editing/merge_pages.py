"""The page that the second of two people gets who change the same row, whatever the row is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from django import forms
from django.db import transaction
from django.http import HttpResponse
from django.shortcuts import render

from annotations.editing.drafts import discard_draft
from annotations.editing.edits import Overtaken, bring_back, change
from annotations.editing.merged_fields import MergedField, merge
from annotations.models import Editable
from annotations.people.access import PageRequest
from annotations.rows.row_kinds import FORM_FIELDS, kind_of
from annotations.showing.form_presentation import Pieces, compare

Row = TypeVar("Row", bound=Editable)

# What the fields of a form are called → what they show for a row.
Shown = Callable[[Editable], Mapping[str, Any]]


@dataclass(frozen=True)
class Side:
    """A field of a row as one person has it: ``value`` for the form, the label or text of it in pieces."""

    title: str
    value: str
    pieces: Pieces


def save_edit(request: PageRequest, row: Row, form: forms.Form, values: Mapping[str, Any]) -> Row:
    """Save ``values``, if the row is still at the version that the field ``version`` of ``form`` holds.

    Raises Overtaken otherwise: answer it with ``merge_page``.
    """
    version = form.cleaned_data["version"] or 0
    verb = bring_back if "bring_back" in request.POST else change
    with transaction.atomic():
        saved = verb(row, values, request.user, version)
        discard_draft(request.user, row.owning_world, kind_of(row).name, row.pk)
    return saved


def merge_page(
    request: PageRequest,
    row: Editable,
    form: forms.Form,
    clash: Overtaken,
    shown: Shown,
    **context: Any,
) -> HttpResponse:
    """Show what ``row`` was, what somebody made of it, and what ``form`` holds, field by field.

    Args:
        row: as the reader's request found it.
        shown: what the fields of ``form`` show for a row.
        context: for the template: ``check_url`` and ``completion_url`` where the fields are checked
            and completed as one types.

    A change that only one of both made is taken over. The page sends the form to the same
    address, as an edit of the present version.
    """
    merged: dict[str, MergedField] = {}
    if clash.current:
        fields = _fields_to_fill_in(form)
        base = _posted_values(fields, shown(clash.base.instance)) if clash.base else None
        theirs = _posted_values(fields, shown(clash.current))
        mine = {field.name: _as_posted(field, field.value()) for field in fields}
        merged = {each.name: each for each in merge(base, theirs, mine)}
    data: Any = form.data
    data = data.copy()
    now: Any = clash.current or clash.last
    data["version"] = now.version
    for name, each in merged.items():
        data[name] = each.merged
    form.data = data
    who = clash.last.history_user if clash.last else None
    by = "you in another tab" if who == request.user else str(who or "somebody")
    changed = {name: each for name, each in merged.items() if not each.is_same}
    context |= {
        "kind": kind_of(row),
        "row": row,
        "form": form,
        "clash": clash,
        "changed": [(form[name], each, _sides(form, each, by)) for name, each in changed.items()],
        "others": [field for field in _fields_to_fill_in(form) if field.name not in changed],
    }
    return render(request, "annotations/editing/merge.html", context, status=409)


def _fields_to_fill_in(form: forms.Form) -> list[forms.BoundField]:
    """Return the fields that a person fills in."""
    return [field for field in form.visible_fields() if not field.field.disabled]


def _posted_values(fields: list[forms.BoundField], values: Mapping[str, Any]) -> dict[str, str]:
    return {field.name: _as_posted(field, values.get(field.name)) for field in fields}


def _as_posted(field: forms.BoundField, value: Any) -> str:
    """Write a value as a browser sends it."""
    prepared = field.field.prepare_value(value)
    return "" if prepared is None else str(prepared).replace("\r\n", "\n").strip()


def _sides(form: forms.Form, each: MergedField, by: str) -> list[Side]:
    """Return a field before, as theirs and as yours, options by their labels and changes marked."""
    is_form = each.name in FORM_FIELDS
    options = getattr(form[each.name].field, "choices", ())
    labels: dict[str | None, str] = {str(key): str(label) for key, label in options}
    texts = {value: labels.get(value, value or "") for value in (each.base, each.theirs, each.mine)}
    if each.base is None:
        theirs, mine = compare(texts[each.theirs], texts[each.mine], is_form)
        before = []
    else:
        _, theirs = compare(texts[each.base], texts[each.theirs], is_form)
        pieces, mine = compare(texts[each.base], texts[each.mine], is_form)
        before = [Side("Before", each.base, [("same", text) for _, text in pieces])]
    return [*before, Side(f"Saved by {by}", each.theirs, theirs), Side("Yours", each.mine, mine)]

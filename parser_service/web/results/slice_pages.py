"""Saved slices: every member may look at and apply them, reviewers save, rename and delete them."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.utils.http import url_has_allowed_host_and_scheme

from annotations.language.texts import LanguageError
from annotations.models import Duty, World
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.web.forms import sentence_of
from parser_service.models import Slice
from parser_service.results.saving import delete_slice, rename_slice, save_slice
from parser_service.results.selecting import describe_query

DELETED = "deleted_slice"  # in the session, until the page has offered to restore it


@world_view(Duty.VIEW, methods=READ_AND_WRITE, write_duty=Duty.REVIEW, does="save a slice")
def slices(request: WorldRequest, world: World) -> HttpResponse:
    """List the saved slices; save one that another page chose."""
    if request.method == "POST":
        sent = request.POST
        try:
            saved = save_slice(world, sent.get("name", ""), sent.get("query", ""), request.user)
        except LanguageError as error:
            messages.error(request, sentence_of(error))
        else:
            messages.success(request, f"Saved the slice “{saved.name}”.")
        following = sent.get("next", "")
        if following and url_has_allowed_host_and_scheme(following, {request.get_host()}):
            return redirect(following)
        return redirect("slices", world=world.name)
    rows = world.slices.select_related("created_by").prefetch_related("error_categories")
    context = {
        "slices": [(row, describe_query(world, row.query)) for row in rows],
        "deleted": request.session.pop(DELETED, None),
    }
    return render(request, "parser_service/results/slices.html", context)


@world_view(Duty.REVIEW, methods=WRITE, does="rename a slice")
def slice_rename(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Give a slice another name."""
    saved = get_object_or_404(Slice, world=world, pk=pk)
    try:
        rename_slice(saved, request.POST.get("name", ""))
    except LanguageError as error:
        messages.error(request, sentence_of(error))
    return redirect("slices", world=world.name)


@world_view(Duty.REVIEW, methods=WRITE, does="delete a slice")
def slice_delete(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Delete a slice; the next page offers to restore it."""
    saved = get_object_or_404(Slice, world=world, pk=pk)
    delete_slice(saved)
    request.session[DELETED] = {"name": saved.name, "query": saved.query}
    return redirect("slices", world=world.name)

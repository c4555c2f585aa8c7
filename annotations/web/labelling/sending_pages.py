"""Send what a reviewer reads back to annotators."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from django.contrib import messages
from django.http import HttpResponse, HttpResponseRedirect
from django.shortcuts import get_object_or_404, redirect
from django.utils.http import url_has_allowed_host_and_scheme

from annotations.labelling.sent_examples import send_examples
from annotations.language.texts import Refusal
from annotations.models import Duty, Example, World
from annotations.people.access import WRITE, PageRequest, WorldRequest, world_view
from annotations.web.labelling.work_item_forms import AskForm


@world_view(Duty.REVIEW, WRITE, does="send an example to the work queue")
def example_send(request: WorldRequest, world: World, split: int, pk: int) -> HttpResponse:
    """Send the row behind an example to the work queue with a reason, and go back."""
    rows = Example.objects.filter(split__world=world, split=split)
    row = get_object_or_404(rows, pk=pk)
    send(request, world, [row])
    return go_back(request, "example", world=world.name, split=split, pk=pk)


def send(request: WorldRequest, world: World, examples: Iterable[Example]) -> None:
    """Send examples to the work queue with the posted reason, and tell the reader the result."""
    form = AskForm(request.POST)
    if not form.is_valid():
        messages.error(request, "Say in a few words what is to be looked at.")
        return
    try:
        sent = send_examples(world, examples, form.cleaned_data["reason"], request.user)
    except Refusal as error:
        messages.error(request, str(error))
        return
    tell = messages.success if sent.queued else messages.info
    tell(request, sent.sentence)


def go_back(request: PageRequest, to: str, **keys: Any) -> HttpResponse:
    """Go to the page of this site that the form names as ``next``, or to a route."""
    address = request.POST.get("next", "")
    is_ours = url_has_allowed_host_and_scheme(address, {request.get_host()}, request.is_secure())
    if is_ours and address.startswith("/"):
        return HttpResponseRedirect(address)
    page: HttpResponse = redirect(to, **keys)
    return page

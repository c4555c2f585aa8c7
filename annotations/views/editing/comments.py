"""Comments on a row, and the inbox of whoever is named in one."""

from __future__ import annotations

from django.contrib import messages
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.http import require_http_methods

from annotations.commenting import SUBJECTS, add_comment, mark_read
from annotations.editing.kinds import KINDS
from annotations.forms import CommentForm, posted
from annotations.models import Comment, Duty, Notice, World
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.people.rate_limits import Rate
from annotations.views.editing.history import number_in

COMMENTS = Rate("comments", limit=60, seconds=600)
INBOX_SHOWN = 50


@world_view(Duty.VIEW, READ_AND_WRITE)
def comments(request: HttpRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Show the comments on a row; a POST adds one."""
    if kind not in SUBJECTS:
        raise Http404("There are no comments on such rows.")
    subject = SUBJECTS[kind]
    row = subject.row(world, pk)
    form = CommentForm(posted(request))
    if request.method == "POST" and form.is_valid():
        if COMMENTS.take(str(request.user.pk)) is None:
            form.add_error("text", "That were many comments. Wait some minutes, then send again.")
        else:
            add_comment(world, subject, row, form.cleaned_data["text"], request.user)
            return redirect(subject.address(world, pk))
    context = {"subject": subject, "row": row, "form": form}
    return render(request, "annotations/comments.html", context)


@require_http_methods(READ_AND_WRITE)
def inbox(request: HttpRequest) -> HttpResponse:
    """Show what waits for the reader in all their worlds; a POST marks all of it read."""
    notices = Notice.objects.of(request.user)
    if request.method == "POST":
        messages.success(request, f"Marked {mark_read(notices)} as read.")
        return redirect("inbox")
    if before := number_in(request.GET.get("before", "")):
        notices = notices.filter(pk__lt=before)
    some = list(notices.select_related("comment__world", "comment__author")[: INBOX_SHOWN + 1])
    context = {
        "notices": some[:INBOX_SHOWN],
        "older": some[INBOX_SHOWN - 1].pk if len(some) > INBOX_SHOWN else None,
        "has_unread": Notice.objects.of(request.user).unread().exists(),
    }
    return render(request, "annotations/inbox.html", context)


@require_http_methods(WRITE)
def notice_open(request: HttpRequest, pk: int) -> HttpResponse:
    """Mark a notice read and go to what it is about; with ``stay`` only mark it."""
    notice = get_object_or_404(Notice.objects.of(request.user), pk=pk)
    mark_read(Notice.objects.filter(pk=notice.pk))
    if "stay" in request.POST:
        return redirect("inbox")
    if address := address_of(notice.comment):
        return redirect(address)
    messages.warning(request, f"What {notice.comment.author} wrote about is not there any more.")
    return redirect("inbox")


def address_of(comment: Comment) -> str:
    """Return the page that shows ``comment``, or the history of what was deleted; empty where it is gone."""
    subject, kind = SUBJECTS[comment.kind], KINDS.get(comment.kind)
    if (pk := subject.current_key(comment)) is not None:
        return subject.address(comment.world, pk)
    if kind and kind.entries_of(comment.world).filter(id=comment.subject).exists():
        names = {"world": comment.world.name, "kind": kind.name, "pk": comment.subject}
        return reverse("history", kwargs=names)
    return ""

"""Comments on a row, and the inbox of whoever is named in one."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.exceptions import PermissionDenied
from django.http import Http404, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse

from annotations.editing.commenting import (
    SUBJECTS,
    EditedElsewhere,
    add_comment,
    change_comment,
    delete_comment,
    mark_read,
    restore_comment,
    versions_of,
)
from annotations.models import Comment, Duty, Notice, World
from annotations.people.access import (
    NOTHING,
    READ_AND_WRITE,
    WRITE,
    PageRequest,
    WorldRequest,
    plain_view,
    world_view,
)
from annotations.rows.row_kinds import KINDS
from annotations.showing.paging import number_in
from annotations.web.editing.comment_forms import COMMENTS, TOO_MANY, CommentEditForm, CommentForm
from annotations.web.editing.undo import say_with_undo
from annotations.web.forms import posted

INBOX_SHOWN = 50


@world_view(Duty.VIEW, READ_AND_WRITE, does="comment")
def comments(request: WorldRequest, world: World, kind: str, pk: int) -> HttpResponse:
    """Show the comments on a row; a POST adds one."""
    if kind not in SUBJECTS:
        raise Http404("There are no comments on such rows.")
    subject = SUBJECTS[kind]
    row = subject.row(world, pk)
    form = CommentForm(posted(request))
    if request.method == "POST" and form.is_valid():
        if COMMENTS.take(str(request.user.pk)) is None:
            form.add_error("text", TOO_MANY)
        else:
            add_comment(world, subject, row, form.cleaned_data["text"], request.user)
            return redirect(subject.address(world, pk))
    context = {"subject": subject, "row": row, "form": form}
    return render(request, "annotations/editing/comments.html", context)


@world_view(Duty.VIEW, READ_AND_WRITE, does="change a comment")
def comment(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Show a comment and its earlier versions. Its author edits it with a POST."""
    row = get_object_or_404(world.comments.present(), pk=pk)
    may_edit = row.may_be_edited_by(request.user)
    if request.method == "POST" and not may_edit:
        raise PermissionDenied("Only the author of a comment edits it.")
    values = {"text": row.text, "version": row.version}
    form = CommentEditForm(posted(request), initial=values)
    if request.method == "POST" and form.is_valid() and _save_edit(request, row, form):
        return redirect(address_of(row) or "inbox")
    context = {
        "comment": row,
        "form": form if may_edit else None,
        "versions": versions_of(row),
        "page": address_of(row),
    }
    return render(request, "annotations/editing/comment.html", context)


def _save_edit(request: PageRequest, row: Comment, form: CommentEditForm) -> bool:
    """Store the edit and return True, or add an error to the form and return False."""
    if COMMENTS.take(str(request.user.pk)) is None:
        form.add_error("text", TOO_MANY)
        return False
    try:
        change_comment(row, form.cleaned_data["text"], form.cleaned_data["version"])
    except EditedElsewhere as error:
        form.add_error("text", f"{error} What it says now stands below; save again to replace it.")
        data: Any = form.data
        form.data = data = data.copy()
        data["version"] = error.current.version
        return False
    return True


@world_view(Duty.VIEW, WRITE, does="delete a comment")
def comment_delete(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Delete a comment. Its author may, and so may admins."""
    row = get_object_or_404(world.comments.present(), pk=pk)
    if not row.may_be_deleted_by(request.user, request.duties):
        raise PermissionDenied("Only its author and the admins of this world delete a comment.")
    delete_comment(row, request.user)
    restore = reverse("comment_restore", kwargs={"world": world.name, "pk": pk})
    say_with_undo(request, "Deleted. “Restore” stands in its place.", restore)
    return redirect(address_of(row) or "inbox")


@world_view(Duty.VIEW, WRITE, does="restore a comment")
def comment_restore(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Bring a deleted comment back."""
    row = get_object_or_404(world.comments, pk=pk)
    if row.is_deleted:
        if not row.may_be_restored_by(request.user, request.duties):
            raise PermissionDenied("Only who deleted a comment restores it.")
        restore_comment(row)
    return redirect(address_of(row) or "inbox")


@plain_view(READ_AND_WRITE, does=NOTHING)
def inbox(request: PageRequest) -> HttpResponse:
    """Show the reader's notices from all their worlds. A POST marks all of them read."""
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
    return render(request, "annotations/editing/inbox.html", context)


@plain_view(WRITE, does=NOTHING)
def notice_open(request: PageRequest, pk: int) -> HttpResponse:
    """Mark a notice read and open its comment. With ``stay``, stay in the inbox."""
    notice = get_object_or_404(Notice.objects.of(request.user), pk=pk)
    mark_read(Notice.objects.filter(pk=notice.pk))
    if "stay" in request.POST:
        return redirect("inbox")
    if address := address_of(notice.comment):
        return redirect(address)
    messages.warning(request, f"What {notice.comment.author} wrote about is not there any more.")
    return redirect("inbox")


def address_of(comment: Comment) -> str:
    """Return the URL of the page with ``comment``, or of the history of its deleted row; empty if both are gone."""
    subject, kind = SUBJECTS[comment.kind], KINDS.get(comment.kind)
    if (pk := subject.current_key(comment)) is not None:
        return subject.address(comment.world, pk)
    if kind and kind.entries_of(comment.world).filter(id=comment.subject).exists():
        names = {"world": comment.world.name, "kind": kind.name, "pk": comment.subject}
        return reverse("history", kwargs=names)
    return ""

"""Verbs: close an account or open it, help somebody who lost a password, see where one is logged in and end it."""

from __future__ import annotations

from http import HTTPStatus

from django.contrib.auth.tokens import default_token_generator
from django.db import transaction
from django.http import HttpRequest
from django.urls import reverse
from django.utils import timezone
from django.utils.encoding import force_bytes
from django.utils.http import urlsafe_base64_encode

from annotations.language.texts import Refusal
from annotations.models import Assignment, LogInSession, User

MOST_DEVICE_CHARACTERS = 200


class OwnAccount(Refusal):
    """Somebody would lock themselves out."""

    code = "own_account"
    status = HTTPStatus.CONFLICT

    def __init__(self) -> None:
        super().__init__("Nobody closes their own account: another administrator may.")


def set_open(account: User, is_open: bool, by: User) -> None:
    """Open an account, or close it, which logs it out everywhere, stops its tokens, and frees for others
    what it held in work queues.

    Raises OwnAccount where ``by`` would close theirs.
    """
    if account == by and not is_open:
        raise OwnAccount
    account.is_active = is_open
    with transaction.atomic():
        account.save(update_fields=["is_active"])
        if not is_open:
            LogInSession.objects.filter(user=account).delete()
            Assignment.objects.orphaned().filter(person=account).release()


def password_path(account: User) -> str:
    """Return the path of a page on which ``account`` sets a new password, once, within three days."""
    key = default_token_generator.make_token(account)
    keys = {"uidb64": urlsafe_base64_encode(force_bytes(account.pk)), "token": key}
    return reverse("password_set", kwargs=keys)


def remember_device(request: HttpRequest) -> None:
    """Keep in the session what browser somebody has just logged in with."""
    device = request.headers.get("User-Agent", "").replace("\0", "")
    request.session["device"] = device.encode(errors="replace").decode()[:MOST_DEVICE_CHARACTERS]
    request.session["begun_at"] = timezone.now().isoformat()


def sessions_of(user: User) -> list[LogInSession]:
    """Return where ``user`` is logged in, the newest first."""
    rows = LogInSession.objects.filter(user=user, expire_date__gt=timezone.now())
    return sorted(rows, key=lambda each: each.begun_at or each.expire_date, reverse=True)


def end_session(user: User, handle: str) -> bool:
    """Log ``user`` out where the session called ``handle`` is; False where there is none."""
    keys = [each.pk for each in sessions_of(user) if each.handle == handle]
    return LogInSession.objects.filter(pk__in=keys).delete()[0] > 0

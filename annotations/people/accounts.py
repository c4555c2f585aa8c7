"""Verbs of the administrators of the site: close an account or open it, help somebody who lost a password."""

from __future__ import annotations

from django.contrib.auth.tokens import default_token_generator
from django.db import transaction
from django.urls import reverse
from django.utils.encoding import force_bytes
from django.utils.http import urlsafe_base64_encode

from annotations.models import LogInSession, User


class OwnAccount(ValueError):
    """Somebody would lock themselves out."""

    def __init__(self) -> None:
        super().__init__("Nobody closes their own account: another administrator may.")


def set_open(account: User, is_open: bool, by: User) -> None:
    """Open an account, or close it, which logs it out everywhere and stops its tokens.

    Raises OwnAccount where ``by`` would close theirs.
    """
    if account == by and not is_open:
        raise OwnAccount
    account.is_active = is_open
    with transaction.atomic():
        account.save(update_fields=["is_active"])
        if not is_open:
            LogInSession.objects.filter(user=account).delete()


def password_path(account: User) -> str:
    """Return the path of a page on which ``account`` sets a new password, once, within three days."""
    key = default_token_generator.make_token(account)
    keys = {"uidb64": urlsafe_base64_encode(force_bytes(account.pk)), "token": key}
    return reverse("password_set", kwargs=keys)

"""Single sign-on by django-allauth, where the environment names a server; nothing else imports this.

Nobody gets in by it alone. Somebody new needs an invitation. Somebody with an account connects it once, on
the page of the account, and then logs in by it.
"""

from __future__ import annotations

from typing import Any

from allauth.account.adapter import DefaultAccountAdapter
from allauth.core.exceptions import ImmediateHttpResponse
from allauth.socialaccount.adapter import DefaultSocialAccountAdapter
from allauth.socialaccount.models import SocialLogin
from django.db import transaction
from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import Resolver404, resolve, reverse

from annotations.models import AuditEntry, Invitation, User
from annotations.people.accounts import remember_device
from annotations.people.invitations import InvitationOver, join
from annotations.people.members import role_names
from gpsr_site.accounts.landing import landing_page_of

NO_ACCOUNT = (
    "Nobody here is connected to this sign-on. If you have an account, log in with its password and "
    "connect it under Account; if not, ask for an invitation."
)
CLOSED = "This account is closed. Ask an administrator of this installation."
FAILED = "The sign-on did not succeed. Try again, or log in with a password."


class Accounts(DefaultAccountAdapter):
    """What happens when somebody has signed on."""

    def is_open_for_signup(self, request: HttpRequest) -> bool:
        """Return False: only ``SignOn`` makes accounts."""
        return False

    def login(self, request: HttpRequest, user: User) -> None:
        super().login(request, user)
        remember_device(request)
        name = user.get_username()
        AuditEntry.objects.create(who=user, who_name=name, what="log in", subject="single sign-on")

    def get_login_redirect_url(self, request: HttpRequest) -> str:
        return landing_page_of(request.user)

    def respond_user_inactive(self, request: HttpRequest, user: User) -> HttpResponse:
        return refusal(request, CLOSED)

    def add_message(self, *args: Any, **kwargs: Any) -> None:
        """Say nothing: the page that follows shows who one is."""

    def send_mail(self, *args: Any, **kwargs: Any) -> None:
        """Send nothing: this site sends no mail."""


class SignOn(DefaultSocialAccountAdapter):
    """Who may come in."""

    def is_open_for_signup(self, request: HttpRequest, sociallogin: SocialLogin) -> bool:
        """Return True for somebody who has come by the link of an open invitation; refuse all others."""
        if _invitation_of(sociallogin) is None:
            raise ImmediateHttpResponse(refusal(request, NO_ACCOUNT))
        return True

    def save_user(self, request: HttpRequest, sociallogin: SocialLogin, form: Any = None) -> User:
        """Make the account, which takes a place of the invitation: there is no account without one."""
        invitation = _invitation_of(sociallogin)
        if invitation is None:
            raise ImmediateHttpResponse(refusal(request, NO_ACCOUNT))
        try:
            with transaction.atomic():
                user: User = super().save_user(request, sociallogin, form)
                join(invitation, user)
                AuditEntry.objects.create(
                    world=invitation.world,
                    world_name=invitation.world.name,
                    who=user,
                    who_name=user.get_username(),
                    what="join",
                    subject=f"as {role_names(invitation.roles)}, by single sign-on",
                )
        except InvitationOver as error:
            raise ImmediateHttpResponse(refusal(request, str(error))) from error
        return user

    def get_connect_redirect_url(self, request: HttpRequest, socialaccount: Any) -> str:
        return reverse("account")

    def on_authentication_error(self, request: HttpRequest, *args: Any, **kwargs: Any) -> None:
        raise ImmediateHttpResponse(refusal(request, FAILED))

    def send_notification_mail(self, *args: Any, **kwargs: Any) -> None:
        """Send nothing."""


def _invitation_of(sociallogin: SocialLogin) -> Invitation | None:
    """Return the open invitation whose page the sign-on was begun on."""
    try:
        match = resolve(sociallogin.state.get("next") or "")
    except Resolver404:
        return None
    return Invitation.objects.for_key(match.kwargs["key"]) if match.url_name == "join" else None


def refusal(request: HttpRequest, sentence: str) -> HttpResponse:
    """Return the page that says why somebody does not come in."""
    return render(request, "annotations/people/join.html", {"refusal": sentence}, status=403)

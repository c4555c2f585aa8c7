"""The user's own account: password, tokens for programs, and sessions."""

from __future__ import annotations

from django.contrib import messages
from django.contrib.auth import logout
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.utils import timezone
from django.views.decorators.cache import never_cache

from annotations.models import ApiToken, LogInSession, Scope
from annotations.people import shown_once
from annotations.people.access import WRITE, PageRequest, plain_view
from annotations.people.accounts import end_session, sessions_of
from annotations.people.audit_log import note
from annotations.web.people.token_forms import TokenForm

WHAT_SCOPES_DO = {
    Scope.READ: "lists, exports and parses",
    Scope.ANNOTATE: "also writes templates, labels and reviews",
    Scope.TRAIN: "also starts and cancels runs",
    Scope.ADMIN: "does all that you may do",
}


@never_cache
@plain_view()
def account(request: PageRequest) -> HttpResponse:
    """Show the user's tokens and sessions. The secret of a new token is shown once."""
    key = shown_once.take(request, "token") if request.method == "GET" else ""
    return _render_account(request, key=key)


@plain_view(WRITE, does="make a token")
def token_new(request: PageRequest) -> HttpResponse:
    """Create a token. The account page shows its secret once."""
    form = TokenForm(request.user, request.POST)
    if not form.is_valid():
        return _render_account(request, status=422, form=form)
    token, key = ApiToken.issue(request.user, **form.cleaned_data)
    note(request, f"{token.name} ({token.scope})")
    shown_once.keep(request, "token", key)
    return redirect("account")


@plain_view(WRITE, does="revoke a token")
def token_revoke(request: PageRequest, pk: int) -> HttpResponse:
    """Revoke a token of the user."""
    token = get_object_or_404(request.user.api_tokens, pk=pk)
    token.delete()
    note(request, token.name)
    messages.success(request, f"The token “{token.name}” is revoked.")
    return redirect("account")


@plain_view(WRITE, does="log out elsewhere")
def session_end(request: PageRequest, handle: str) -> HttpResponse:
    """Log the user out in one browser, which may be this one."""
    if end_session(request.user, handle):
        messages.success(request, "Logged out there.")
    return redirect("account")


@plain_view(WRITE, does="log out everywhere")
def sessions_end(request: PageRequest) -> HttpResponse:
    """Log the user out everywhere, in this browser too."""
    LogInSession.objects.filter(user=request.user).delete()
    logout(request)
    return redirect("login")


def _render_account(
    request: PageRequest, status: int = 200, form: TokenForm | None = None, key: str = ""
) -> HttpResponse:
    context = {
        "form": form or TokenForm(request.user),
        "key": key,
        "tokens": request.user.api_tokens.order_by("-pk"),
        "now": timezone.now(),
        "scopes": [(scope, WHAT_SCOPES_DO[scope]) for scope in Scope],
        "sessions": sessions_of(request.user),
        "here": request.session.session_key,
    }
    return render(request, "annotations/people/account.html", context, status=status)

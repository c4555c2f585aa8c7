"""One's own account: password, tokens of programs, and where one is logged in."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.contrib.auth import logout
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.utils import timezone
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods

from annotations.models import ApiToken, LogInSession, Scope, User
from annotations.models.people import scope_choices
from annotations.people.access import READ, WRITE
from annotations.people.audit_log import note
from annotations.people.sessions import end_session, sessions_of

MOST_TOKENS = 50
MOST_DAYS = 365
WHAT_SCOPES_DO = {
    Scope.READ: "lists, exports and parses",
    Scope.ANNOTATE: "also writes templates, labels and reviews",
    Scope.TRAIN: "also starts and cancels runs",
    Scope.ADMIN: "does all that you may do",
}


class TokenForm(forms.Form):
    """What a token is for, what it may be used for, and how long."""

    name = forms.CharField(
        label="What it is for",
        max_length=80,
        widget=forms.TextInput(attrs={"autocomplete": "off", "placeholder": "robot in the lab"}),
    )
    scope = forms.ChoiceField(choices=scope_choices, initial=Scope.READ)
    days = forms.IntegerField(
        label="Days", min_value=1, max_value=MOST_DAYS, initial=90, help_text="until it expires"
    )

    def __init__(self, user: User, *args: Any) -> None:
        super().__init__(*args)
        self.user = user

    def clean(self) -> dict[str, Any]:
        if self.user.api_tokens.count() >= MOST_TOKENS:
            raise forms.ValidationError(
                f"You have {MOST_TOKENS} tokens. Revoke one that you do not need."
            )
        return super().clean()


@require_http_methods(READ)
def account(request: HttpRequest) -> HttpResponse:
    """Show one's tokens and where one is logged in."""
    return _render_account(request)


@never_cache
@require_http_methods(WRITE)
def token_new(request: HttpRequest) -> HttpResponse:
    """Make a token, and show its secret, which is not shown again."""
    form = TokenForm(request.user, request.POST)
    if not form.is_valid():
        return _render_account(request, status=422, form=form)
    token, key = ApiToken.issue(request.user, **form.cleaned_data)
    note(request, f"{token.name} ({token.scope})")
    return _render_account(request, key=key)


@require_http_methods(WRITE)
def token_revoke(request: HttpRequest, pk: int) -> HttpResponse:
    """End one of one's tokens."""
    token = get_object_or_404(request.user.api_tokens, pk=pk)
    token.delete()
    note(request, token.name)
    messages.success(request, f"The token “{token.name}” is revoked.")
    return redirect("account")


@require_http_methods(WRITE)
def session_end(request: HttpRequest, handle: str) -> HttpResponse:
    """Log oneself out in one browser, which may be this one."""
    if end_session(request.user, handle):
        messages.success(request, "Logged out there.")
    return redirect("account")


@require_http_methods(WRITE)
def sessions_end(request: HttpRequest) -> HttpResponse:
    """Log oneself out everywhere, here as well."""
    LogInSession.objects.filter(user=request.user).delete()
    logout(request)
    return redirect("login")


def _render_account(
    request: HttpRequest, status: int = 200, form: TokenForm | None = None, key: str = ""
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
    return render(request, "annotations/account.html", context, status=status)

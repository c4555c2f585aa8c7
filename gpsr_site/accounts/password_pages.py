"""Logging in, with limits on how often one may get it wrong."""

from __future__ import annotations

import threading
import time
import unicodedata
from typing import TYPE_CHECKING, Any

from django import forms
from django.contrib import messages
from django.contrib.auth.forms import (
    AuthenticationForm,
    PasswordChangeForm,
    SetPasswordForm,
)
from django.contrib.auth.views import (
    INTERNAL_RESET_SESSION_TOKEN,
    LoginView,
    PasswordChangeView,
    PasswordResetConfirmView,
)
from django.core.exceptions import ValidationError
from django.db import transaction
from django.http import HttpRequest, HttpResponse, HttpResponseRedirect
from django.urls import reverse, reverse_lazy
from django.utils.decorators import method_decorator

from annotations.models import User
from annotations.people.access import READ_AND_WRITE, plain_view
from annotations.people.accounts import remember_device
from annotations.people.password_fields import MOST_CHARACTERS, ask_twice
from annotations.people.rate_limits import Rate
from gpsr_site.accounts.landing import landing_page_of

# For one name from one address; beyond it even the right password waits.
BY_NAME_AND_ADDRESS = Rate("log-in", limit=10, seconds=600)
# For one address, whatever the names.
BY_ADDRESS = Rate("log-in-address", limit=100, seconds=600)
# For one name from all addresses. Beyond it every attempt is slow; nobody is locked out, for else
# anybody could lock out anybody.
BY_NAME = Rate("log-in-name", limit=50, seconds=600)
SLOW_SECONDS = 2.0
# Slow attempts that wait at the same time; more would hold the threads that serve everybody.
SLOW_PLACES = threading.BoundedSemaphore(2)

TOO_OFTEN = (
    "Too many wrong attempts from this address. "
    f"Try again in {BY_NAME_AND_ADDRESS.seconds // 60} minutes."
)
TOO_MANY_AT_ONCE = "Too many attempts for this username just now. Try again in a few seconds."


class LogInForm(AuthenticationForm):
    """Username and password, of a length that is cheap to hash."""

    password = forms.CharField(strip=False, max_length=MOST_CHARACTERS, widget=forms.PasswordInput)
    error_messages = {
        "invalid_login": "No account has this username and this password.",
        "inactive": "This account is closed. Ask an admin of the site.",
    }


if TYPE_CHECKING:
    SetPasswordFormOfUsers = SetPasswordForm[User]
else:  # Django's class takes no type argument at run time
    SetPasswordFormOfUsers = SetPasswordForm


class NewPasswordForm(SetPasswordFormOfUsers):
    """A new password, twice."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        ask_twice(self, "new_password1", "new_password2")


class ChangePasswordForm(NewPasswordForm, PasswordChangeForm):
    """The old password, and a new one twice."""


# Here and below ``plain_view`` refuses, before anything is looked at, the PUT that Django's views of forms read too.
@method_decorator(plain_view(READ_AND_WRITE, does="log in"), "dispatch")
class LogIn(LoginView):
    """The only page for logging in; Django's admin leads here as well."""

    redirect_authenticated_user = True
    authentication_form = LogInForm

    def get_redirect_url(self) -> str:  # type: ignore[override]  # the stubs have an argument that Django has not
        """Return the page that somebody asked for before they logged in; the list of worlds is asked for by nobody."""
        address = super().get_redirect_url()
        return "" if address == reverse("home") else address

    def get_default_redirect_url(self) -> str:
        return landing_page_of(self.request.user)

    def post(self, request: HttpRequest, *args: object, **kwargs: object) -> HttpResponse:
        """Take a place under each limit before the password is looked at; a success returns them."""
        address = str(request.META["REMOTE_ADDR"])
        name = normalize_name(request.POST.get("username", ""))
        self.key = f"{address} {name}"
        address_place = BY_ADDRESS.take(address)
        name_place = BY_NAME_AND_ADDRESS.take(self.key)
        if address_place is None or name_place is None:
            return self.refuse(TOO_OFTEN, BY_NAME_AND_ADDRESS.seconds)
        self.address_place = address_place
        if BY_NAME.take(name) is None and not wait_slowly():
            return self.refuse(TOO_MANY_AT_ONCE, int(SLOW_SECONDS) * 2)
        return super().post(request, *args, **kwargs)

    def refuse(self, sentence: str, seconds: int) -> HttpResponse:
        form = self.get_form()
        form.full_clean = lambda: None  # type: ignore[method-assign]  # the password is not looked at
        form.cleaned_data = {}
        form._errors = forms.utils.ErrorDict()  # type: ignore[attr-defined]  # private to Django
        form.add_error(None, ValidationError(sentence))
        context = self.get_context_data(form=form)
        headers = {"Retry-After": str(seconds)}
        return self.render_to_response(context, status=429, headers=headers)

    def form_valid(self, form: AuthenticationForm) -> HttpResponse:
        BY_NAME_AND_ADDRESS.forget(self.key)
        BY_ADDRESS.give_back(self.address_place)
        response = super().form_valid(form)
        remember_device(self.request)
        return response


@method_decorator(plain_view(READ_AND_WRITE, does="change password"), "dispatch")
class ChangePassword(PasswordChangeView):
    """Whoever is logged in changes their own password, and stays logged in here but nowhere else."""

    form_class = ChangePasswordForm
    template_name = "registration/password.html"
    success_url = reverse_lazy("account")

    def form_valid(self, form: PasswordChangeForm) -> HttpResponse:
        response = super().form_valid(form)
        messages.success(
            self.request, "Your password was changed. Your tokens have ended, make new ones."
        )
        return response


@method_decorator(plain_view(READ_AND_WRITE, does="set password"), "dispatch")
class SetPassword(PasswordResetConfirmView):
    """Whoever has the link that an administrator has made sets a new password by it, once."""

    form_class = NewPasswordForm
    template_name = "registration/password_set.html"
    success_url = reverse_lazy("login")

    def form_valid(self, form: SetPasswordForm[User]) -> HttpResponse:
        """Set the password, or say that the link was used already."""
        form.save(commit=False)  # hashes it, which takes long, while nobody waits
        token = self.request.session[INTERNAL_RESET_SESSION_TOKEN]
        with transaction.atomic():
            held = User.objects.select_for_update(no_key=True).filter(pk=form.user.pk).first()
            if held is not None and self.token_generator.check_token(held, token):
                form.user.save(update_fields=["password"])
                del self.request.session[INTERNAL_RESET_SESSION_TOKEN]
                return HttpResponseRedirect(self.get_success_url())
        self.validlink = False
        return self.render_to_response(self.get_context_data())


def normalize_name(name: str) -> str:
    """Return ``name`` as Django looks it up (NFKC), and without regard to case."""
    return unicodedata.normalize("NFKC", name[:1000]).strip().casefold()


def wait_slowly() -> bool:
    """Wait before an attempt on a name that many try; False where others wait already."""
    if not SLOW_PLACES.acquire(blocking=False):
        return False
    try:
        time.sleep(SLOW_SECONDS)
    finally:
        SLOW_PLACES.release()
    return True

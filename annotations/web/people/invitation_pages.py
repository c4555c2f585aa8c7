"""The page that the link of an invitation leads to; the only way to an account besides site administrators."""

from __future__ import annotations

from django.contrib.auth import login
from django.contrib.auth.decorators import login_not_required
from django.contrib.auth.forms import UserCreationForm
from django.core.exceptions import ValidationError
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.views.decorators.cache import never_cache
from django.views.decorators.debug import sensitive_post_parameters

from annotations.models import Invitation, User
from annotations.people.access import READ_AND_WRITE, plain_view
from annotations.people.accounts import remember_device
from annotations.people.audit_log import note
from annotations.people.invitations import (
    InvitationOver,
    NameTaken,
    sign_up,
    world_joined_by,
)
from annotations.people.invitations import join as take_place
from annotations.people.members import role_names
from annotations.people.password_fields import ask_twice
from annotations.people.rate_limits import JOINING
from annotations.web.people.member_forms import OVER, TOO_OFTEN

MODEL_BACKEND = "django.contrib.auth.backends.ModelBackend"


class SignUpForm(UserCreationForm):  # type: ignore[type-arg]  # generic in the stubs alone
    """A username that nobody has in any spelling, and a password that is not easily guessed."""

    class Meta:
        model = User
        fields = ("username",)

    def __init__(self, *args: object, **kwargs: object) -> None:
        super().__init__(*args, **kwargs)
        self.fields["username"].label = "Username"
        self.fields["username"].help_text = "Others see it beside what you do."
        self.fields["username"].widget.attrs |= {
            "autocomplete": "username",
            "autocapitalize": "none",
        }
        ask_twice(self, "password1", "password2")

    def clean_username(self) -> str:
        name: str = self.cleaned_data["username"]
        if User.objects.alike(name):
            raise ValidationError(str(NameTaken()))
        return name


@login_not_required
@never_cache
@sensitive_post_parameters()
@plain_view(READ_AND_WRITE, does="join")
def join(request: HttpRequest, key: str) -> HttpResponse:
    """Let a logged-in user join the world, or create an account that joins it.

    Attempts are counted by address: wrong links, and accounts that were not made.
    """
    address = str(request.META["REMOTE_ADDR"])
    invitation = Invitation.objects.for_key(key)
    if invitation is None and (world := world_joined_by(key, request.user)):
        return redirect("world", world=world.name)
    is_attempt = invitation is None or request.method == "POST"
    place = JOINING.take(address) if is_attempt else ""
    if place is None:
        response = _refuse(request, TOO_OFTEN, 429)
        response["Retry-After"] = str(JOINING.seconds)
        return response
    if invitation is None:
        return _refuse(request, OVER, 404)
    form = SignUpForm(request.POST if request.method == "POST" else None)
    if request.method == "POST":
        try:
            if request.user.is_authenticated:
                take_place(invitation, request.user)
            elif form.is_valid():
                typed = form.cleaned_data
                account = sign_up(invitation, typed["username"], typed["password1"])
                login(request, account, backend=MODEL_BACKEND)
                remember_device(request)
        except InvitationOver as error:
            return _refuse(request, str(error), 404)
        except NameTaken as error:
            form.add_error("username", str(error))
        if request.user.is_authenticated:
            JOINING.give_back(place)
            request.world = invitation.world  # type: ignore[attr-defined]  # for the audit log
            note(request, f"as {role_names(invitation.roles)}")
            return redirect("world", world=invitation.world.name)
    context = {"invitation": invitation, "form": form, "roles": role_names(invitation.roles)}
    status = 422 if form.errors else 200
    return render(request, "annotations/people/join.html", context, status=status)


def _refuse(request: HttpRequest, sentence: str, status: int) -> HttpResponse:
    return render(request, "annotations/people/join.html", {"refusal": sentence}, status=status)

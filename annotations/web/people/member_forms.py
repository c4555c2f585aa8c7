"""The forms that let people into a world, and what the link of an invitation says when it does not."""

from __future__ import annotations

from django import forms
from django.core.exceptions import ValidationError

from annotations.models import User
from annotations.models.worlds import role_choices
from annotations.people.invitations import MOST_DAYS, MOST_PLACES, InvitationOver
from annotations.people.members import find_account
from annotations.people.rate_limits import JOINING

OVER = str(InvitationOver())
TOO_OFTEN = f"Too many attempts from this address. Try again in {JOINING.seconds // 60} minutes."


class MemberForm(forms.Form):
    """An account by its name, and what it may do here. Nobody gets a role unasked."""

    name = forms.CharField(
        label="Username",
        max_length=150,
        help_text="Whoever has no account yet joins by an invitation.",
        widget=forms.TextInput(attrs={"autocomplete": "off", "autocapitalize": "none"}),
    )
    roles = forms.MultipleChoiceField(
        choices=role_choices,
        widget=forms.CheckboxSelectMultiple,
        error_messages={"required": "Choose at least one role."},
    )

    def clean_name(self) -> User:
        account = find_account(self.cleaned_data["name"])
        if account is None:
            raise ValidationError(
                "No account has this username. Invite the person by a link instead."
            )
        return account


class RolesForm(forms.Form):
    """The roles of a member. No role at all removes the member."""

    roles = forms.MultipleChoiceField(choices=role_choices, required=False)


class InvitationForm(forms.Form):
    """What a link gives, to how many people, and how long."""

    prefix = "invite"
    note = forms.CharField(
        label="For whom",
        max_length=80,
        required=False,
        help_text="So that admins know later. Whoever joins does not see it.",
        widget=forms.TextInput(attrs={"autocomplete": "off"}),
    )
    roles = forms.MultipleChoiceField(
        choices=role_choices,
        widget=forms.CheckboxSelectMultiple,
        error_messages={"required": "Choose at least one role."},
    )
    places = forms.IntegerField(
        label="People",
        min_value=1,
        max_value=MOST_PLACES,
        initial=1,
        help_text="who may use the link",
    )
    days = forms.IntegerField(
        label="Days",
        min_value=1,
        max_value=MOST_DAYS,
        initial=7,
        help_text="until the link expires",
    )

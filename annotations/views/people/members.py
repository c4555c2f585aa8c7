"""The people of a world: everybody in it sees them, its admins invite people and give and take roles."""

from __future__ import annotations

from django import forms
from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.models import Duty, Invitation, User, World
from annotations.models.worlds import Role, role_choices
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.people.audit_log import note
from annotations.people.invitations import MOST_DAYS, MOST_PLACES
from annotations.people.members import (
    NoAdminLeft,
    add_roles,
    find_account,
    members_of,
    role_names,
    set_roles,
)

WHAT_ROLES_DO = {
    Role.ANNOTATOR: "writes templates, generates commands, makes splits",
    Role.REVIEWER: "judges paraphrases, labels in doubt and predictions",
    Role.ADMIN: "does all of that, imports files, starts runs, and decides who is here",
}


class MemberForm(forms.Form):
    """An account by its name, and what it may do here. Nobody gets a role unasked."""

    name = forms.CharField(
        max_length=150,
        help_text="The name of an account. Whoever has none yet joins by an invitation.",
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
            raise ValidationError("No account has this name. Invite the person by a link instead.")
        return account


class RolesForm(forms.Form):
    """The roles of somebody who is here already; none of them removes the person."""

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


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE)
def people(request: HttpRequest, world: World) -> HttpResponse:
    """List the members with their roles; add one who has an account."""
    form = MemberForm(request.POST if request.method == "POST" else None)
    if form.is_bound and form.is_valid():
        account = form.cleaned_data["name"]
        add_roles(world, account, form.cleaned_data["roles"])
        note(request, f"{account}: {role_names(form.cleaned_data['roles'])}")
        messages.success(request, f"{account} is a member of {world}.")
        return redirect("people", world=world.name)
    return _render_people(request, world, form=form)


@never_cache
@world_view(Duty.MANAGE, WRITE)
def invite(request: HttpRequest, world: World) -> HttpResponse:
    """Make an invitation, and show its link, which is not shown again."""
    form = InvitationForm(request.POST)
    if not form.is_valid():
        return _render_people(request, world, status=422, invitation_form=form)
    invitation, key = Invitation.issue(world, by=request.user, **form.cleaned_data)
    note(request, f"{role_names(invitation.roles)}: {invitation.note or 'a link'}")
    link = request.build_absolute_uri(reverse("join", kwargs={"key": key}))
    return _render_people(request, world, link=link)


@world_view(Duty.MANAGE, WRITE)
def withdraw(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Delete an invitation, so that nobody else joins by its link."""
    invitation = get_object_or_404(world.invitations, pk=pk)
    invitation.delete()
    note(request, invitation.note or "a link")
    messages.success(request, "The invitation is withdrawn. Who has joined by it stays.")
    return redirect("people", world=world.name)


@world_view(Duty.MANAGE, WRITE)
def member(request: HttpRequest, world: World, pk: int) -> HttpResponse:
    """Change the roles of a member, or remove them."""
    account = get_object_or_404(User.objects.filter(memberships__world=world).distinct(), pk=pk)
    form = RolesForm(request.POST)
    if not form.is_valid():
        messages.error(request, "There is no such role.")
        return redirect("people", world=world.name)
    roles = [] if "remove" in request.POST else form.cleaned_data["roles"]
    try:
        set_roles(world, account, roles, by=request.user)
    except NoAdminLeft as error:
        note(request, f"refused: {account} is the last admin")
        messages.error(request, str(error))
        return redirect("people", world=world.name)
    note(request, f"{account}: {role_names(roles) or 'removed'}")
    done = f"is now {role_names(roles)} of" if roles else "is no longer a member of"
    messages.success(request, f"{account} {done} {world}.")
    is_gone = not roles and account == request.user and not request.user.is_superuser
    return redirect("home") if is_gone else redirect("people", world=world.name)


def _render_people(
    request: HttpRequest,
    world: World,
    status: int = 200,
    form: MemberForm | None = None,
    invitation_form: InvitationForm | None = None,
    link: str = "",
) -> HttpResponse:
    """Render the page with forms that were sent, or the link of an invitation that was just made."""
    may_invite = Duty.MANAGE in request.duties
    context = {
        "form": form or MemberForm(),
        "invitation_form": invitation_form or InvitationForm(),
        "link": link,
        "invitations": world.invitations.open().select_related("created_by") if may_invite else (),
        "members": members_of(world),
        "roles": [(role, role.label, WHAT_ROLES_DO[role]) for role in Role],
    }
    return render(request, "annotations/people.html", context, status=status)

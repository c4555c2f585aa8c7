"""The people of a world: everybody in it sees them, its admins give and take roles."""

from __future__ import annotations

from django import forms
from django.contrib import messages
from django.core.exceptions import ValidationError
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render

from annotations.models import Duty, User, World
from annotations.models.worlds import Role, role_choices
from annotations.people.access import READ_AND_WRITE, WRITE, world_view
from annotations.people.members import NoAdminLeft, find_account, members_of, set_roles

WHAT_ROLES_DO = {
    Role.ANNOTATOR: "writes templates, generates commands, makes splits",
    Role.REVIEWER: "judges paraphrases, labels in doubt and predictions",
    Role.ADMIN: "does all of that, imports files, starts runs, and decides who is here",
}


class MemberForm(forms.Form):
    """An account by its name, and what it may do here. Nobody gets a role unasked."""

    name = forms.CharField(
        max_length=150,
        help_text="The name of an account. Administrators of the site create accounts.",
        widget=forms.TextInput(attrs={"autocomplete": "off", "autocapitalize": "none"}),
    )
    roles = forms.MultipleChoiceField(choices=role_choices, widget=forms.CheckboxSelectMultiple)

    def clean_name(self) -> User:
        account = find_account(self.cleaned_data["name"])
        if account is None:
            raise ValidationError("No account has this name. Ask an administrator of the site.")
        return account


class RolesForm(forms.Form):
    """The roles of somebody who is here already; none of them removes the person."""

    roles = forms.MultipleChoiceField(choices=role_choices, required=False)


@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE)
def people(request: HttpRequest, world: World) -> HttpResponse:
    """List the members with their roles; add one."""
    form = MemberForm(request.POST if request.method == "POST" else None)
    if form.is_bound and form.is_valid():
        account = form.cleaned_data["name"]
        held = world.memberships.filter(user=account).values_list("role", flat=True)
        set_roles(world, account, {*held, *form.cleaned_data["roles"]}, by=request.user)
        messages.success(request, f"{account} is a member of {world}.")
        return redirect("people", world=world.name)
    context = {
        "form": form,
        "members": members_of(world),
        "roles": [(role, role.label, WHAT_ROLES_DO[role]) for role in Role],
    }
    return render(request, "annotations/people.html", context)


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
        messages.error(request, str(error))
        return redirect("people", world=world.name)
    done = f"is now {' and '.join(roles)} of" if roles else "is no longer a member of"
    messages.success(request, f"{account} {done} {world}.")
    is_gone = not roles and account == request.user and not request.user.is_superuser
    return redirect("home") if is_gone else redirect("people", world=world.name)

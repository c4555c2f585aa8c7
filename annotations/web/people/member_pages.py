"""The people of a world: everybody in it sees them, its admins invite people and give and take roles."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.views.decorators.cache import never_cache

from annotations.language.texts import Refusal
from annotations.models import Duty, Invitation, User, World
from annotations.models.worlds import Role
from annotations.people import shown_once
from annotations.people.access import READ_AND_WRITE, WRITE, WorldRequest, world_view
from annotations.people.audit_log import note
from annotations.people.members import (
    NoAdminLeft,
    add_roles,
    members_of,
    role_names,
    roles_of,
    set_roles,
)
from annotations.people.taking_back import PeopleChange, take_back_people_change
from annotations.web.editing.undo import say_with_undo
from annotations.web.people.member_forms import InvitationForm, MemberForm, RolesForm

WHAT_ROLES_DO = {
    Role.ANNOTATOR: "writes templates, generates commands, makes splits",
    Role.REVIEWER: "judges paraphrases, labels in doubt and predictions",
    Role.ADMIN: "does all of that, imports files, starts runs, and decides who is here",
}


@never_cache
@world_view(Duty.VIEW, READ_AND_WRITE, write_duty=Duty.MANAGE, does="add a member")
def people(request: WorldRequest, world: World) -> HttpResponse:
    """List the members with their roles; add one who has an account."""
    form = MemberForm(request.POST if request.method == "POST" else None)
    if form.is_bound and form.is_valid():
        account = form.cleaned_data["name"]
        before = roles_of(world, account)
        add_roles(world, account, form.cleaned_data["roles"])
        note(request, f"{account}: {role_names(form.cleaned_data['roles'])}")
        change = PeopleChange(world, account, before, roles_of(world, account))
        _say_changed(request, f"{account} is a member of {world}.", change)
        return redirect("people", world=world.name)
    return _render_people(request, world, form=form)


@world_view(Duty.MANAGE, WRITE, does="invite")
def invite(request: WorldRequest, world: World) -> HttpResponse:
    """Create an invitation. The page “People” shows its link once."""
    form = InvitationForm(request.POST)
    if not form.is_valid():
        return _render_people(request, world, status=422, invitation_form=form)
    invitation, key = Invitation.issue(world, by=request.user, **form.cleaned_data)
    note(request, f"{role_names(invitation.roles)}: {invitation.note or 'a link'}")
    link = request.build_absolute_uri(reverse("join", kwargs={"key": key}))
    shown_once.keep(request, f"invitation:{world.pk}", link)
    return redirect("people", world=world.name)


@world_view(Duty.MANAGE, WRITE, does="withdraw an invitation")
def withdraw(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """End an invitation. Its link stops working."""
    rows = Invitation.objects.filter(world=world)
    invitation = get_object_or_404(rows.open(), pk=pk)
    change = PeopleChange(world, withdrawn=rows.filter(pk=pk).withdraw())
    note(request, invitation.note or "a link")
    sentence = "The invitation is withdrawn. Who has joined by it stays."
    _say_changed(request, sentence, change)
    return redirect("people", world=world.name)


@world_view(Duty.MANAGE, WRITE, does="undo a change of people")
def take_change_back(request: WorldRequest, world: World) -> HttpResponse:
    """Undo a change of roles, of members or of an invitation, as long as nobody has changed it again."""
    try:
        change = PeopleChange.read(request.POST.get("change", ""), world)
        said = take_back_people_change(change, request.user)
    except Refusal as error:
        note(request, f"refused: {error.message}")
        messages.error(request, error.message)
    else:
        note(request, said)
        messages.success(request, said)
    return redirect("people", world=world.name)


@world_view(Duty.MANAGE, WRITE, does="change roles")
def member(request: WorldRequest, world: World, pk: int) -> HttpResponse:
    """Change the roles of a member, or remove them."""
    account = get_object_or_404(User.objects.filter(memberships__world=world).distinct(), pk=pk)
    form = RolesForm(request.POST)
    if not form.is_valid():
        messages.error(request, "There is no such role.")
        return redirect("people", world=world.name)
    roles = [] if "remove" in request.POST else form.cleaned_data["roles"]
    before = roles_of(world, account)
    try:
        withdrawn = set_roles(world, account, roles, by=request.user)
    except NoAdminLeft as error:
        note(request, f"refused: {account} is the last admin")
        messages.error(request, str(error))
        return redirect("people", world=world.name)
    note(request, f"{account}: {role_names(roles) or 'removed'}")
    done = f"is now {role_names(roles)} of" if roles else "is no longer a member of"
    change = PeopleChange(world, account, before, roles_of(world, account), withdrawn)
    _say_changed(request, f"{account} {done} {world}.", change)
    is_gone = not roles and account == request.user and not request.user.is_superuser
    return redirect("home") if is_gone else redirect("people", world=world.name)


def _say_changed(request: WorldRequest, sentence: str, change: PeopleChange) -> None:
    """Say what was done, with a button that undoes it for whoever may still do that."""
    if change.withdrawn and change.member:
        count = len(change.withdrawn)
        were = "invitation of theirs is" if count == 1 else "invitations of theirs are"
        sentence = f"{sentence} {count} {were} withdrawn."
    is_none = list(change.before) == list(change.after) and not change.withdrawn
    if change.world.allows(request.user, Duty.MANAGE) and not is_none:
        address = reverse("people_take_back", kwargs={"world": change.world.name})
        say_with_undo(request, sentence, address, change=change.sealed())
    else:
        messages.success(request, sentence)


def _render_people(
    request: WorldRequest,
    world: World,
    status: int = 200,
    form: MemberForm | None = None,
    invitation_form: InvitationForm | None = None,
) -> HttpResponse:
    """Render the page, with the forms that were sent, or with the link of a new invitation."""
    is_read = request.method == "GET"
    may_invite = Duty.MANAGE in request.duties
    context = {
        "form": form or MemberForm(),
        "invitation_form": invitation_form or InvitationForm(),
        "link": shown_once.take(request, f"invitation:{world.pk}") if is_read else "",
        "invitations": world.invitations.open().select_related("created_by") if may_invite else (),
        "members": members_of(world),
        "roles": [(role, role.label, WHAT_ROLES_DO[role]) for role in Role],
    }
    return render(request, "annotations/people/people.html", context, status=status)

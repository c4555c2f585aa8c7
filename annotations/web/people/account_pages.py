"""All accounts of the site, for its administrators: who is there, who may log in, who has lost a password."""

from __future__ import annotations

from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect
from django.views.decorators.cache import never_cache

from annotations.models import User
from annotations.people import shown_once
from annotations.people.access import WRITE, PageRequest, site_view
from annotations.people.accounts import OwnAccount, password_path, set_open
from annotations.people.audit_log import note
from annotations.showing.listing import Listing, Sort, render_list
from annotations.web.people.people_filters import AccountFilters

SORTS = {"name": Sort("Username", "username"), "joined": Sort("Since", "date_joined")}


@never_cache
@site_view()
def accounts(request: PageRequest) -> HttpResponse:
    """List all accounts with their worlds. A new link for a password is shown once."""
    rows = User.objects.prefetch_related("memberships__world")
    listing = Listing(request, AccountFilters, rows, SORTS)
    link = shown_once.take(request, "password") if request.method == "GET" else ""
    return render_list(
        request, "annotations/people/accounts.html", {"listing": listing, "link": link}
    )


@site_view(WRITE, does="close or open an account")
def account_close(request: PageRequest, pk: int) -> HttpResponse:
    """Close or reopen an account. Closing it logs it out everywhere and stops its tokens."""
    account = get_object_or_404(User, pk=pk)
    try:
        set_open(account, not account.is_active, by=request.user)
    except OwnAccount as error:
        messages.error(request, str(error))
        return redirect("accounts")
    done = "open" if account.is_active else "closed"
    note(request, f"{account}: {done}")
    messages.success(request, f"The account of {account} is {done}.")
    return redirect("accounts")


@site_view(WRITE, does="make a link for a new password")
def account_link(request: PageRequest, pk: int) -> HttpResponse:
    """Make a link for a new password. It works once, for three days."""
    account = get_object_or_404(User.objects.filter(is_active=True), pk=pk)
    link = request.build_absolute_uri(password_path(account))
    note(request, str(account))
    sentence = f"{account} sets a new password by this link. The present one stays until then."
    messages.success(request, sentence)
    shown_once.keep(request, "password", link)
    return redirect("accounts")

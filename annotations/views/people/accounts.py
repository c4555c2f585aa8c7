"""All accounts of the site, for its administrators: who is there, who may log in, who has lost a password."""

from __future__ import annotations

import django_filters
from django.contrib import messages
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.views.decorators.cache import never_cache

from annotations.lists.filtering import PageFilters, Search
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import User
from annotations.people.access import WRITE, site_view
from annotations.people.accounts import OwnAccount, password_path, set_open
from annotations.people.audit_log import note

SORTS = {"name": Sort("Name", "username"), "joined": Sort("Since", "date_joined")}


class AccountFilters(PageFilters):
    q = Search("username")
    is_active = django_filters.ChoiceFilter(
        label="Account", choices=[("True", "open"), ("False", "closed")]
    )


@site_view()
def accounts(request: HttpRequest) -> HttpResponse:
    """List all accounts with the worlds that they belong to."""
    rows = User.objects.prefetch_related("memberships__world")
    listing = Listing(request, AccountFilters, rows, SORTS)
    return render_list(request, "annotations/accounts.html", {"listing": listing})


@site_view(WRITE)
def account_close(request: HttpRequest, pk: int) -> HttpResponse:
    """Close an account, which logs it out everywhere and stops its tokens, or open it again."""
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


@never_cache
@site_view(WRITE)
def account_link(request: HttpRequest, pk: int) -> HttpResponse:
    """Show a link by which somebody sets a new password, once, within three days."""
    account = get_object_or_404(User.objects.filter(is_active=True), pk=pk)
    link = request.build_absolute_uri(password_path(account))
    note(request, str(account))
    context = {"account": account, "link": link}
    return render(request, "annotations/account_link.html", context)

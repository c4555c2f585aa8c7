"""All accounts of the site, for its administrators: who is there, who may log in, who has lost a password."""

from __future__ import annotations

import django_filters
from django.contrib import messages
from django.contrib.auth.tokens import default_token_generator
from django.http import HttpRequest, HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import reverse
from django.utils.encoding import force_bytes
from django.utils.http import urlsafe_base64_encode
from django.views.decorators.cache import never_cache

from annotations.lists.filtering import PageFilters, Search
from annotations.lists.listing import Listing, Sort, render_list
from annotations.models import LogInSession, User
from annotations.people.access import WRITE, site_view
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
    if account == request.user:
        messages.error(request, "Nobody closes their own account: another administrator may.")
        return redirect("accounts")
    account.is_active = not account.is_active
    account.save(update_fields=["is_active"])
    if not account.is_active:
        LogInSession.objects.filter(user=account).delete()
    done = "open" if account.is_active else "closed"
    note(request, f"{account}: {done}")
    messages.success(request, f"The account of {account} is {done}.")
    return redirect("accounts")


@never_cache
@site_view(WRITE)
def account_link(request: HttpRequest, pk: int) -> HttpResponse:
    """Show a link by which somebody sets a new password, once, within three days."""
    account = get_object_or_404(User.objects.filter(is_active=True), pk=pk)
    key = default_token_generator.make_token(account)
    keys = {"uidb64": urlsafe_base64_encode(force_bytes(account.pk)), "token": key}
    link = request.build_absolute_uri(reverse("password_set", kwargs=keys))
    note(request, str(account))
    context = {"account": account, "link": link}
    return render(request, "annotations/account_link.html", context)

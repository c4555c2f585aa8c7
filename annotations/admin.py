"""Accounts, memberships and tokens, for the administrators of the site."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from django.contrib import admin
from django.contrib.auth.admin import UserAdmin
from django.contrib.auth.decorators import login_not_required
from django.contrib.auth.models import Group
from django.contrib.auth.views import redirect_to_login
from django.core.exceptions import PermissionDenied
from django.db import transaction
from django.db.models import QuerySet
from django.http import HttpRequest, HttpResponse
from django.urls import reverse

from annotations.models import ApiToken, Assignment, Membership, User, World

admin.site.site_header = "GPSR Workbench: accounts"
admin.site.site_title = "Accounts"
admin.site.index_title = "Who may do what"
admin.site.unregister(Group)


if TYPE_CHECKING:
    ModelAdmin = admin.ModelAdmin[Any]
    TabularInline = admin.TabularInline[Membership, Any]
    AdminOfUsers = UserAdmin[User]
else:  # Django's classes take no type arguments at run time
    ModelAdmin = admin.ModelAdmin
    TabularInline = admin.TabularInline
    AdminOfUsers = UserAdmin


class MembershipInline(TabularInline):
    model = Membership
    extra = 0


class WithMemberships(ModelAdmin):
    """An account or a world, with the roles that belong to it. Who loses one by a change here holds nothing
    in the work queue any more that they may not do."""

    inlines = (MembershipInline,)

    def save_related(self, *args: Any, **kwargs: Any) -> None:
        super().save_related(*args, **kwargs)
        Assignment.objects.orphaned().release()

    def delete_model(self, request: HttpRequest, obj: Any) -> None:
        super().delete_model(request, obj)
        Assignment.objects.orphaned().release()

    def delete_queryset(self, request: HttpRequest, queryset: QuerySet[Any]) -> None:
        with transaction.atomic():
            super().delete_queryset(request, queryset)
            Assignment.objects.orphaned().release()


@admin.register(User)
class AccountAdmin(WithMemberships, AdminOfUsers):
    pass


@admin.register(World)
class WorldAdmin(WithMemberships):
    """A world's name is used in URLs and commands and never changes. The workbench has a page of its
    own for deleting one, which the confirmation here, a line for every row, would not survive."""

    list_display = ("name", "description", "created_at")
    fields = ("name", "description")

    def get_readonly_fields(self, request: HttpRequest, obj: World | None = None) -> list[str]:
        return ["name"] if obj else []

    def has_delete_permission(self, request: HttpRequest, obj: World | None = None) -> bool:
        return False


@admin.register(ApiToken)
class ApiTokenAdmin(ModelAdmin):
    """Tokens are seen and ended here, not made: a secret is shown to its owner alone."""

    list_display = ("name", "user", "scope", "created_at", "expires_at")
    readonly_fields = ("user", "name", "scope", "digest", "created_at")

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False


def may_enter(request: HttpRequest) -> bool:
    """Return whether the person is an active superuser; the staff flag alone does not open the admin."""
    return request.user.is_active and request.user.is_superuser


@login_not_required
def log_in(request: HttpRequest, extra_context: object = None) -> HttpResponse:
    """Lead to the site's own page for logging in, which counts wrong attempts."""
    if request.user.is_authenticated and not may_enter(request):
        raise PermissionDenied("Only administrators of this installation may do this.")
    return redirect_to_login(request.GET.get("next") or reverse("admin:index"))


admin.site.has_permission = may_enter  # type: ignore[method-assign]  # instead of a site of our own
admin.site.login = log_in  # type: ignore[method-assign]  # the same

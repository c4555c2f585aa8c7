"""Accounts, memberships and tokens, for the administrators of the site."""

from __future__ import annotations

from django.contrib import admin
from django.contrib.auth.admin import UserAdmin
from django.contrib.auth.decorators import login_not_required
from django.contrib.auth.models import Group
from django.contrib.auth.views import redirect_to_login
from django.core.exceptions import PermissionDenied
from django.http import HttpRequest, HttpResponse
from django.urls import reverse

from annotations.models import ApiToken, Membership, User, World

admin.site.site_header = "GPSR Workbench: accounts"
admin.site.site_title = "Accounts"
admin.site.index_title = "Who may do what"
admin.site.unregister(Group)


class MembershipInline(admin.TabularInline):
    model = Membership
    extra = 0


@admin.register(User)
class AccountAdmin(UserAdmin):
    inlines = (MembershipInline,)


@admin.register(World)
class WorldAdmin(admin.ModelAdmin):
    """A world's name is used in URLs and commands and never changes. The workbench has a page of its
    own for deleting one, which the confirmation here, a line for every row, would not survive."""

    list_display = ("name", "description", "created_at")
    fields = ("name", "description")
    inlines = (MembershipInline,)

    def get_readonly_fields(self, request: HttpRequest, obj: World | None = None) -> list[str]:
        return ["name"] if obj else []

    def has_delete_permission(self, request: HttpRequest, obj: World | None = None) -> bool:
        return False


@admin.register(ApiToken)
class ApiTokenAdmin(admin.ModelAdmin):
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


admin.site.has_permission = may_enter
admin.site.login = log_in

"""Accounts, memberships and tokens, for the administrators of the site."""

from __future__ import annotations

from django.contrib import admin
from django.contrib.auth.admin import UserAdmin
from django.contrib.auth.models import Group
from django.http import HttpRequest

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
    list_display = ("name", "description", "created_at")
    inlines = (MembershipInline,)


@admin.register(ApiToken)
class ApiTokenAdmin(admin.ModelAdmin):
    """Tokens are seen and ended here, not made: a secret is shown to its owner alone."""

    list_display = ("name", "user", "created_at", "expires_at")
    readonly_fields = ("user", "name", "digest", "created_at")

    def has_add_permission(self, request: HttpRequest) -> bool:
        return False


def may_enter(request: HttpRequest) -> bool:
    """Accounts are the business of superusers alone, whatever else somebody's staff flag says."""
    return request.user.is_active and request.user.is_superuser


admin.site.has_permission = may_enter

"""What the work queue and the labels in doubt may be filtered by. Each name is a parameter of the page's URL."""

from __future__ import annotations

import django_filters

from annotations.models.queueing import (
    AuditFindingQuerySet,
    WorkItemQuerySet,
    audit_reason_choices,
    finding_status_choices,
    work_kind_choices,
)
from annotations.people.access import WorldRequest
from annotations.showing.filtering import Choices, PageFilters, Search


def member_choices(request: WorldRequest) -> Choices:
    """Return the people who have a role in the world."""
    rows = request.world.memberships.order_by("user__username")
    return [(str(key), name) for key, name in rows.values_list("user", "user__username").distinct()]


class WorkItemFilters(PageFilters):
    """The items of the work queue; those that are done are hidden unless asked for."""

    q = Search("title", "reason")
    kind = django_filters.ChoiceFilter(label="Why", choices=work_kind_choices)
    state = django_filters.ChoiceFilter(
        label="State",
        choices=[("free", "free"), ("taken", "somebody has it"), ("done", "done")],
        method="by_state",
    )
    person = django_filters.ChoiceFilter(label="Person", method="by_person")
    world_choices = {"person": member_choices}

    @property
    def qs(self) -> WorkItemQuerySet:
        rows = super().qs
        is_asked = self.is_bound and self.form.is_valid() and self.form.cleaned_data["state"]
        chosen: WorkItemQuerySet = rows if is_asked else rows.open()
        return chosen

    def by_state(self, rows: WorkItemQuerySet, name: str, value: str) -> WorkItemQuerySet:
        if value == "done":
            return rows.filter(closed_at__isnull=False)
        return rows.free() if value == "free" else rows.taken()

    def by_person(self, rows: WorkItemQuerySet, name: str, value: str) -> WorkItemQuerySet:
        return rows.of_person(int(value))


class AuditFindingFilters(PageFilters):
    """The findings of label audits; those that are decided are hidden unless asked for."""

    q = Search("text", "source_command")
    status = django_filters.ChoiceFilter(
        label="Status",
        choices=finding_status_choices,
        empty_label="Status: open",
        method="by_status",
    )
    reason = django_filters.ChoiceFilter(
        label="Against it", choices=audit_reason_choices, method="by_reason"
    )

    @property
    def qs(self) -> AuditFindingQuerySet:
        rows = super().qs
        is_asked = self.is_bound and self.form.is_valid() and self.form.cleaned_data["status"]
        chosen: AuditFindingQuerySet = rows if is_asked else rows.open()
        return chosen

    def by_status(self, rows: AuditFindingQuerySet, name: str, value: str) -> AuditFindingQuerySet:
        return rows.with_status(value)

    def by_reason(self, rows: AuditFindingQuerySet, name: str, value: str) -> AuditFindingQuerySet:
        return rows.with_reason(value)

"""Worlds, who may do what in them, and who did what."""

from __future__ import annotations

from annotations.models.worlds.audit_entries import AuditEntry
from annotations.models.worlds.invitations import Invitation
from annotations.models.worlds.worlds import DUTIES, Duty, Membership, Role, World, role_choices

__all__ = [
    "DUTIES",
    "AuditEntry",
    "Duty",
    "Invitation",
    "Membership",
    "Role",
    "World",
    "role_choices",
]

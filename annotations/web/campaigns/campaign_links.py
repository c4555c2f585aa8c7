"""The address that a campaign is known by."""

from __future__ import annotations

from typing import Any

from django.urls import reverse

from annotations.models import Campaign


def link_of(request: Any, campaign: Campaign) -> str:
    """Return the whole address of the public page; empty where the link was revoked."""
    if not campaign.key:
        return ""
    return str(request.build_absolute_uri(reverse("campaign", kwargs={"key": campaign.key})))

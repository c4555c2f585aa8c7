"""What pages of campaigns call things."""

from __future__ import annotations

from django import template

from annotations.models import Contributor
from annotations.models.campaigns import ContributorKind
from annotations.web.campaigns.submission_filters import FLAG_LABELS

register = template.Library()

SHOWN_DIGITS = 6  # of a pseudonym


@register.filter
def flag_label(code: str) -> str:
    """Return what a flag is called."""
    labels = {str(each): label for each, label in FLAG_LABELS.items()}
    return labels.get(code, code)


@register.filter
def contributor_name(contributor: Contributor) -> str:
    """Return the model's name, or the beginning of a pseudonym."""
    if contributor.kind == ContributorKind.MODEL:
        return str(contributor.settings.get("model", ""))
    return contributor.pseudonym[:SHOWN_DIGITS]

"""What pages of campaigns call things."""

from __future__ import annotations

from django import template

from annotations.web.campaigns.submission_filters import FLAG_LABELS

register = template.Library()


@register.filter
def flag_label(code: str) -> str:
    """Return what a flag is called."""
    labels = {str(each): label for each, label in FLAG_LABELS.items()}
    return labels.get(code, code)

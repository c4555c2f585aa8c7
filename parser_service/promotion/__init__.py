"""Verbs: promote a run, so that it answers in its world; roll back; propose and decline."""

from parser_service.promotion.proposing import consider
from parser_service.promotion.verbs import decline, previous_run, promote, promoted_run, roll_back

__all__ = [
    "consider",
    "decline",
    "previous_run",
    "promote",
    "promoted_run",
    "roll_back",
]

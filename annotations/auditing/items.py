"""Verb: decide about a label by ending its item in the work queue."""

from __future__ import annotations

from annotations.auditing.deciding import decide
from annotations.models import Assignment, FindingStatus, Verdict

# What an answer to the item decides; whoever ends it without one has looked and found nothing wrong.
DECISIONS = {
    "": FindingStatus.KEPT,
    Verdict.FORM: FindingStatus.CORRECTED,
    Verdict.EXCLUDE: FindingStatus.EXCLUDED,
}


def end_item(part: Assignment, verdict: str = "", form: str = "", reason: str = "") -> bool:
    """Decide about the finding that the item of ``part`` asks about. Return False where there is none.

    Raises what ``decide`` raises.
    """
    finding = part.item.open_finding
    if finding is None:
        return False
    if verdict not in DECISIONS:
        raise ValueError("Keep the label, give the right form, or exclude the pair.")
    decide(finding, DECISIONS[verdict], part.person, form, reason)
    return True

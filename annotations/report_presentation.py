"""What a verb reports, as pages show it: the same right after a request and on the page of a job."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.models import JobKind

MOST_PROBLEMS = 500
MOST_NAMES = 200

TEMPLATES = {
    JobKind.IMPORT_GENERATOR: "annotations/_import_result.html",
    JobKind.IMPORT_PAIRS: "annotations/_pairs_result.html",
    JobKind.IMPORT_WORLD: "annotations/_world_result.html",
    JobKind.GENERATE: "annotations/_generation_result.html",
    JobKind.PROPOSE: "annotations/_proposals_result.html",
    JobKind.AUDIT: "annotations/_audit_result.html",
    JobKind.DELETE_WORLD: "annotations/_deletion_result.html",
}


def shown_report(kind: str, report: Mapping[str, Any]) -> dict[str, Any]:
    """The context of ``_report.html``: the report, its template, and its problems, the errors first."""
    problems = [{**each, "source": each["file"]} for each in report.get("problems", ())]
    problems.sort(key=lambda each: each["severity"] != "error")
    n_errors = sum(each["severity"] == "error" for each in problems)
    return {
        "report": report,
        "report_template": TEMPLATES[JobKind(kind)],
        "problems": problems[:MOST_PROBLEMS],
        "n_problems_left_out": max(0, len(problems) - MOST_PROBLEMS),
        "n_errors": n_errors,
        "is_refused": n_errors > 0,
        "removals": _shown_removals(report.get("removals") or {}),
    }


def _shown_removals(removals: Mapping[str, list[str]]) -> list[dict[str, Any]]:
    """What would go, by what it is: how many, and the first of them."""
    singular = {"templates": "template", "productions": "production", "entities": "entity"}
    return [
        {
            "count": len(texts),
            "noun": singular[name] if len(texts) == 1 else name,
            "texts": texts[:MOST_NAMES],
            "left_out": max(0, len(texts) - MOST_NAMES),
        }
        for name, texts in removals.items()
        if texts
    ]

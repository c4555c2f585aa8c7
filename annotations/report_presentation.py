"""What a verb reports, as pages show it: the same right after a request and on the page of a job."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from annotations.models import JobKind

MOST_PROBLEMS = 500
MOST_NAMES = 200

SINGULAR = {
    "templates": "template",
    "productions": "production",
    "entities": "entity",
    "predicates": "predicate",
    "paraphrases": "paraphrase",
}
TEMPLATES = {
    JobKind.IMPORT_GENERATOR: "annotations/_import_result.html",
    JobKind.IMPORT_PAIRS: "annotations/_pairs_result.html",
    JobKind.IMPORT_WORLD: "annotations/_world_result.html",
    JobKind.GENERATE: "annotations/_generation_result.html",
    JobKind.PROPOSE: "annotations/_proposals_result.html",
    JobKind.AUDIT: "annotations/_audit_result.html",
    JobKind.ANALYSE: "annotations/_analysis_result.html",
    JobKind.ANSWER: "annotations/_answers_result.html",
    JobKind.DELETE_WORLD: "annotations/_deletion_result.html",
}


def shown_report(kind: str, report: Mapping[str, Any]) -> dict[str, Any]:
    """Return the context of ``_report.html``: the report, its template, and its problems, the errors first."""
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
        "removals": _shown_texts(report.get("removals") or {}),
        "left_out": _shown_texts(report.get("left_out") or {}),
    }


def _shown_texts(rows: Mapping[str, list[str]]) -> list[dict[str, Any]]:
    """Return rows by what they are: how many, and the first of them. ``kind`` is a name in rows.kinds."""
    return [
        {
            "count": len(texts),
            "kind": SINGULAR[name],
            "plural": name,
            "noun": SINGULAR[name] if len(texts) == 1 else name,
            "texts": texts[:MOST_NAMES],
            "left_out": max(0, len(texts) - MOST_NAMES),
        }
        for name, texts in rows.items()
        if texts
    ]

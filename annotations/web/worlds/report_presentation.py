"""Prepare the report of a verb for pages: the same right after a request and on the page of a job."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from django.urls import reverse
from django.utils.http import urlencode

from annotations.language.templates import SampleNote
from annotations.models import Entity, JobKind, Production, SemanticTemplate, World
from annotations.web.worlds.problem_groups import group_problems

MOST_PROBLEMS = 500
MOST_NAMES = 200

SINGULAR = {
    "templates": "template",
    "productions": "production",
    "entities": "entity",
    "predicates": "predicate",
    "paraphrases": "paraphrase",
}
# The page of the world on which files are chosen again after a refused import.
IMPORT_PAGES = {
    JobKind.IMPORT_GENERATOR: "import",
    JobKind.IMPORT_COMPETITION: "import_competition",
    JobKind.IMPORT_PAIRS: "import_pairs",
}
# What asks whether an import may go on.
QUESTIONS = {
    JobKind.IMPORT_RESULTS: "annotations/campaigns/_results_question.html",
    JobKind.IMPORT_COMPETITION: "annotations/worlds/_arena_question.html",
}
REMOVAL_QUESTION = "annotations/worlds/_removal_question.html"


def shown_report(
    kind: str, report: Mapping[str, Any], world: World | None = None
) -> dict[str, Any]:
    """Return the context of ``_report.html``: the report, its template, and its problems, the errors first.

    A problem of an import into ``world`` has a ``url``: that of the row on its line, or of its list. Where an import
    was refused, or has only asked, there is no ``url``, since no row comes from its files.
    """
    problems = [{**each, "source": each["file"]} for each in report.get("problems", ())]
    problems.sort(key=lambda each: each["severity"] != "error")
    n_errors = sum(each["severity"] == "error" for each in problems)
    is_stored = not (n_errors or report.get("is_waiting") or report.get("is_dropped"))
    if world is not None and is_stored:
        _link_to_rows(world, problems[:MOST_PROBLEMS])
    return {
        "report": report,
        "report_template": f"annotations/worlds/_{JobKind(kind)}_result.html",
        "question_template": QUESTIONS.get(JobKind(kind), REMOVAL_QUESTION),
        "problems": problems[:MOST_PROBLEMS],
        "problem_groups": group_problems(problems[:MOST_PROBLEMS]),
        "import_page": IMPORT_PAGES.get(JobKind(kind), ""),
        "n_problems_left_out": max(0, len(problems) - MOST_PROBLEMS),
        "n_errors": n_errors,
        "n_warnings": len(problems) - n_errors,
        "is_refused": n_errors > 0,
        "sample_note": SampleNote.from_json(report.get("sample")),
        "removals": _shown_texts(report.get("removals") or {}),
        "left_out": _shown_texts(report.get("left_out") or {}),
    }


def _link_to_rows(world: World, problems: list[dict[str, Any]]) -> None:
    """Give each problem the address of the row that stands on its line, or of the list of its file."""
    files = {each["file"] for each in problems if each.get("file")}
    named = files | {file.lower() for file in files}  # as the rows of an ontology have it
    rows: dict[tuple[str, int], tuple[str, int]] = {}
    lists: dict[str, str] = {}
    for model, path, name, list_name in (
        (Entity, "ontology__world", "entity", "ontology"),
        (Production, "grammar__world", "production", "grammar"),
        (SemanticTemplate, "grammar__world", "template", "templates"),
    ):
        of_files = model._default_manager.filter(source__in=named, **{path: world})
        for source, line, key in of_files.order_by("pk").values_list("source", "line", "pk"):
            rows[source, line] = name, key
            lists[source] = list_name
    for each in problems:
        file, line = each.get("file", ""), each.get("line", 0)
        source = file if file in lists else file.lower()
        if (source, line) in rows:
            name, key = rows[source, line]
            each["url"] = reverse(name, kwargs={"world": world.name, "pk": key})
        elif source in lists:
            query = "" if lists[source] == "ontology" else f"?{urlencode({'source': source})}"
            each["url"] = reverse(lists[source], kwargs={"world": world.name}) + query


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

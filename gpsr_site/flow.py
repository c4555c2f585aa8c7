"""The way through the house (DESIGN §1) as the home of a world shows it, and what to do next."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from annotations.models import Duty
from gpsr_site.counts import Counts


@dataclass(frozen=True, slots=True)
class Stage:
    """One noun of the flow: ``name`` is the URL of its page, ``note`` what waits there, ``verb`` what
    leads to the next noun."""

    label: str
    name: str
    count: int
    unit: str
    verb: str = ""
    note: str = ""


@dataclass(frozen=True, slots=True)
class Step:
    """Something to do: why, and the page (or, where ``is_action``, the button) that does it."""

    reason: str
    label: str
    name: str
    is_action: bool = False


def stages(counts: Counts) -> list[Stage]:
    """The nouns in the order in which one makes them."""
    ontology_note = _remarks(counts.ontology_problems)
    grammar_note = _remarks(counts.grammar_problems)
    return [
        Stage("World", "ontology", counts.entities, "entities", "+", ontology_note),
        Stage("Grammar", "grammar", counts.productions, "productions", "annotate", grammar_note),
        Stage("Templates", "templates", counts.templates, "lines", "generate", _unready(counts)),
        Stage("Commands", "commands", counts.commands, f"{counts.forms} forms", "collect"),
        Stage("Paraphrases", "paraphrases", counts.paraphrases, "utterances", "freeze"),
        Stage("Splits", "splits", counts.splits, "frozen", "train"),
        Stage("Runs", "runs", counts.runs, "started", "evaluate", _active(counts)),
        Stage("Results", "results", counts.evaluated, "evaluated"),
    ]


def next_steps(counts: Counts, duties: frozenset[Duty]) -> list[Step]:
    """At most three things worth doing now, for somebody with ``duties``."""
    return [step for duty, step in _steps(counts) if duty in duties][:3]


def _steps(counts: Counts) -> Iterator[tuple[Duty, Step]]:
    if not counts.productions and not counts.templates:
        reason = (
            "This world is empty. A generator folder brings its ontology, grammar and templates."
        )
        yield Duty.MANAGE, Step(reason, "Import files", "import")
        return
    if not counts.templates:
        reason = "The grammar has no templates yet, so its commands have no meaning."
        yield Duty.ANNOTATE, Step(reason, "Write a template", "template_new")
    if counts.templates and not counts.commands:
        reason = "The templates have not been expanded yet."
        yield Duty.ANNOTATE, Step(reason, "Generate commands", "generate", is_action=True)
    if counts.commands and not counts.splits:
        reason = "Parsers train on a frozen split of the pairs, and there is none."
        yield Duty.ANNOTATE, Step(reason, "Freeze a split", "split_new")
    if counts.splits and not counts.runs:
        reason = "A split is frozen and no parser has been trained on it."
        yield Duty.MANAGE, Step(reason, "Start a run", "run_new")
    if counts.runs_active:
        reason = (
            f"{counts.runs_active} run{'s' if counts.runs_active > 1 else ''} queued or running."
        )
        yield Duty.VIEW, Step(reason, "Watch the runs", "runs")
    if counts.evaluated:
        reason = "Parsers have been scored. Read where they go wrong."
        yield Duty.VIEW, Step(reason, "Open the results", "results")
    if counts.templates_waiting:
        reason = f"{counts.templates_waiting} templates are drafts or disputed."
        yield Duty.ANNOTATE, Step(reason, "Review templates", "templates")
    if counts.grammar_problems:
        reason = f"The checker has {_remarks(counts.grammar_problems)} on the grammar."
        yield Duty.ANNOTATE, Step(reason, "Read them", "grammar")


def _remarks(problems: int) -> str:
    return f"{problems} remark{'s' if problems > 1 else ''}" if problems else ""


def _unready(counts: Counts) -> str:
    return f"{counts.templates_waiting} not ready" if counts.templates_waiting else ""


def _active(counts: Counts) -> str:
    return f"{counts.runs_active} queued or running" if counts.runs_active else ""

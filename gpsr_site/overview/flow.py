"""The stages from ontology to results (docs/design/architecture.md), as the overview of a world shows them."""

from __future__ import annotations

from dataclasses import dataclass

from annotations.language.texts import plural, say_count
from gpsr_site.overview.counts import Counts


@dataclass(frozen=True, slots=True)
class Stage:
    """One noun of the flow. ``name`` is the URL of its page, ``note`` says what waits there, and
    ``verb`` leads to the next noun."""

    label: str
    name: str
    count: int
    unit: str
    verb: str = ""
    note: str = ""


def stages(counts: Counts) -> list[Stage]:
    """List the nouns in the order in which people make them."""
    ontology_note = _warnings(counts.ontology_problems)
    grammar_note = _warnings(counts.grammar_problems)
    forms = say_count(counts.forms, "form")
    entities, productions = (
        _unit(counts.entities, "entity"),
        _unit(counts.productions, "production"),
    )
    lines, said = _unit(counts.templates, "line"), _unit(counts.paraphrases, "utterance")
    unready = f"{counts.templates_waiting} not ready" if counts.templates_waiting else ""
    stale = "out of date" if counts.stale and counts.commands else ""
    active = f"{counts.runs_active} queued or running" if counts.runs_active else ""
    return [
        Stage("Ontology", "ontology", counts.entities, entities, "describe", ontology_note),
        Stage("Grammar", "grammar", counts.productions, productions, "annotate", grammar_note),
        Stage("Templates", "templates", counts.templates, lines, "generate", unready),
        Stage("Commands", "commands", counts.commands, forms, "collect", stale),
        Stage("Paraphrases", "paraphrases", counts.paraphrases, said, "freeze"),
        Stage("Splits", "splits", counts.splits, "frozen", "train"),
        Stage("Runs", "runs", counts.runs, "started", "evaluate", active),
        Stage("Results", "results", counts.evaluated, "evaluated"),
    ]


def _unit(count: int, noun: str) -> str:
    return noun if count == 1 else plural(noun)


def _warnings(count: int) -> str:
    return say_count(count, "warning") if count else ""

"""Which forms attract unlike inputs, for each source of a part."""

from __future__ import annotations

from typing import Any

import numpy as np

from annotations.background.progress import Progress
from annotations.language.corpus import Part
from parser_service.analyses.target import ROWS_AT_ONCE, SOURCES, Target
from parser_service.analysis.attractors import find_attractors

MOST_INPUTS = 5  # that are kept with a form, to be read on the page
_NUMBERS = (
    *("form", "predicted", "missed", "annotated", "p_value", "q_value"),
    *("dispersion", "own_dispersion", "dispersion_p", "is_attractor"),
)


def attractor_findings(target: Target, progress: Progress) -> dict[str, list[dict[str, Any]]]:
    """Return source → rows of ``Attractor`` with some of its wrong inputs; training pairs of the same source
    are further inputs of a form's own. An example without an answer has no form that could attract it."""
    rows = {}
    for source in target.sources:
        progress.check()
        rows[source] = _find(target, source)
    return rows


def attractors_in(findings: dict[str, Any]) -> frozenset[str]:
    """Return the forms that both tests call attractors, among the findings of a part."""
    rows = findings.get("attractors", {}).values()
    return frozenset(row["form"] for each in rows for row in each if row["is_attractor"])


def _find(target: Target, source: str) -> list[dict[str, Any]]:
    known: tuple[list[str], list[str]] = [], []  # utterances and forms of the training part
    shared: dict[str, str] = {}
    training = target.run.split.examples.of(Part.TRAIN, SOURCES[source]).order_by("pk")
    for utterance, form in training.values_list("utterance", "logical_form").iterator(ROWS_AT_ONCE):
        known[0].append(utterance)
        known[1].append(shared.setdefault(form, form))
    answers = target.answers
    places = np.flatnonzero(answers.of_source(source)).tolist()
    utterances = [answers.utterances[place] for place in places]
    attractors = find_attractors(
        utterances,
        [answers.labels[place] for place in places],
        [answers.answers[place] for place in places],
        known,
    )
    rows = []
    for attractor in attractors:
        if attractor.form:
            numbers = {name: getattr(attractor, name) for name in _NUMBERS}
            # Evenly spaced, since neighbours in a split are alike.
            step = max(1, len(attractor.inputs) // MOST_INPUTS)
            inputs = attractor.inputs[::step][:MOST_INPUTS].tolist()
            rows.append({**numbers, "inputs": [utterances[place] for place in inputs]})
    return rows

"""Which forms attract unlike inputs, for each source of a part."""

from __future__ import annotations

from typing import Any

import numpy as np

from annotations.background.progress import Progress
from annotations.language.corpus import Part
from parser_service.analysis.arrays import Bools
from parser_service.analysis.attractors import find_attractors
from parser_service.models import TrainingRun
from parser_service.reviews.target import ROWS_AT_ONCE, SOURCES, Target

MOST_INPUTS = 5  # that are kept with a form, to be read on the page
_NUMBERS = (
    *("form", "predicted", "missed", "annotated", "p_value", "q_value"),
    *("dispersion", "own_dispersion", "dispersion_p", "is_attractor"),
)


def attractor_findings(target: Target, progress: Progress) -> dict[str, list[dict[str, Any]]]:
    """Return source → rows of ``Attractor``, each with some of its wrong inputs.

    Training pairs of the source count as inputs of their form. Examples without an answer give no row.
    """
    rows = {}
    for source in target.sources:
        progress.check()
        mask = target.answers.of_source(source)
        rows[source] = _find(target, mask, _known(target.run, source))
    return rows


def attractors_in(findings: dict[str, Any]) -> frozenset[str]:
    """Return the forms that both tests call attractors, among the findings of a part."""
    rows = findings.get("attractors", {}).values()
    return frozenset(row["form"] for each in rows for row in each if row["is_attractor"])


def _find(target: Target, mask: Bools, known: tuple[list[str], list[str]]) -> list[dict[str, Any]]:
    places = np.flatnonzero(mask).tolist()
    answers = target.answers
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


def _known(run: TrainingRun, source: str) -> tuple[list[str], list[str]]:
    """Return the utterances and forms of the training part that are of a source."""
    rows = run.split.examples.of(Part.TRAIN, SOURCES[source]).order_by("pk")
    texts: list[str] = []
    forms: list[str] = []
    shared: dict[str, str] = {}
    for utterance, form in rows.values_list("utterance", "logical_form").iterator(ROWS_AT_ONCE):
        texts.append(utterance)
        forms.append(shared.setdefault(form, form))
    return texts, forms

"""How the answers of a run change with edits, without single words, and between utterances one word apart."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from functools import lru_cache
from typing import Any

import numpy as np

from annotations.background.progress import Progress
from parser_service.analysis.answer_forms import is_same_answer
from parser_service.analysis.encoded_labels import encode
from parser_service.analysis.mining import mine_pairs
from parser_service.analysis.sensitivity import (
    EditAnswers,
    find_deciding_words,
    measure_sensitivity,
    single_word,
)
from parser_service.models import Expectation, TrainingRun
from parser_service.reviews.probe_kinds import REMOVAL
from parser_service.reviews.target import Target

MOST_WORDS = 20
MOST_PAIRS = 50  # that are kept, to be read on the page
MOST_MINED = 300_000  # utterances among which pairs are looked for
_is_same = lru_cache(maxsize=100_000)(is_same_answer)


def sensitivity_findings(target: Target, progress: Progress) -> list[dict[str, Any]]:
    """Return the rows of ``Sensitivity``: one for each kind of edit, and one for all of them last."""
    edits = target.run.probes.filter(
        expectation__in=(Expectation.SAME, Expectation.CHANGED), answer__isnull=False
    )
    rows = list(
        edits.order_by("position").values_list(
            *("kind", "base_id", "answer__logical_form"),
            *("base__logical_form", "expected_form"),
        )
    )
    progress.check()
    before = answers_before(target.run, {row[1] for row in rows})
    return [
        asdict(each)
        for each in measure_sensitivity(
            EditAnswers(
                kinds=[row[0] for row in rows],
                bases=[row[1] for row in rows],
                before=[before[row[1]] for row in rows],
                after=[row[2] for row in rows],
                label_before=[row[3] for row in rows],
                label_after=[row[4] for row in rows],
            )
        )
    ]


def answers_before(run: TrainingRun, examples: Iterable[int]) -> dict[int, str]:
    """Return example → the run's first answer to it as it was; a few hundred examples at most."""
    rows = run.predictions.best().filter(example__in=set(examples))
    return dict(rows.values_list("example_id", "logical_form"))


def deciding_word_findings(target: Target, progress: Progress) -> dict[str, Any]:
    """Return the words without which the answer changes most, and the single one that it hangs on, or None."""
    removals = target.run.probes.filter(kind=REMOVAL, answer__isnull=False).order_by("position")
    rows = list(removals.values_list("old", "base_id", "answer__logical_form"))
    progress.check()
    before = answers_before(target.run, {row[1] for row in rows})
    changed = np.fromiter(
        (not _is_same(before[base], answer) for _, base, answer in rows), dtype=np.bool_
    )
    words = find_deciding_words([word for word, _, _ in rows], changed)
    single = single_word(words)
    return {
        "trials": len(rows),
        "changes": int(changed.sum()),
        "single": single.word if single else None,
        "words": [{**asdict(word), "rate": word.rate} for word in words[:MOST_WORDS]],
    }


def pair_findings(target: Target, progress: Progress) -> dict[str, Any]:
    """Return how many utterances of the part that share their label but for one word get different answers."""
    answers = target.answers
    pairs = mine_pairs(answers.utterances[:MOST_MINED])
    progress.check()
    labels, forms = encode(answers.labels).codes, encode(answers.answers).codes
    is_alike = labels[pairs.first] == labels[pairs.second]
    differ = np.flatnonzero(is_alike & (forms[pairs.first] != forms[pairs.second]))
    flips = []
    for number in differ.tolist():
        first, second = int(pairs.first[number]), int(pairs.second[number])
        if not _is_same(answers.answers[first], answers.answers[second]):
            flips.append((number, first, second))
    return {
        "pairs": int(is_alike.sum()),
        "flips": len(flips),
        "rows": [
            {
                "words": pairs.changed_words(number),
                "examples": [int(answers.examples[each]) for each in (first, second)],
                "utterances": [answers.utterances[each] for each in (first, second)],
                "answers": [answers.answers[each] for each in (first, second)],
                "label": answers.labels[first],
            }
            for number, first, second in flips[:MOST_PAIRS]
        ],
    }

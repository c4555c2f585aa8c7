"""Which slots a run fills wrongly, and in which answers; and the columns that pages count. Both are too slow for a
page."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from parser_service.analysis.confusions import confuse_slots
from parser_service.models import TrainingRun
from parser_service.slices.columns import answers_of, examples_of

MOST_EXAMPLES = 500  # that are kept with a confusion
AT_ONCE = 20_000


def confusion_findings(run: TrainingRun, part: str) -> dict[str, Any]:
    """Return the confusions of slots among a run's first answers on a part, as plain values.

    The columns of the run are stored too, so that the first comparison need not wait for them.

    Returns:
        ``rows``: predicate, place of the argument (from 1), kind in the label, kind in the answer, count; the
        most frequent first. ``examples``: ``PREDICATE:PLACE:LABELLED:ANSWERED`` → keys of examples with it.
    """
    answers_of(run, part, examples_of(run.split, part))
    columns = ("example_id", "example__logical_form", "logical_form")
    wrong = run.predictions.best().filter(example__part=part, is_exact_match=False).order_by()
    pairs: dict[tuple[str, str], list[int]] = defaultdict(list)
    for key, label, answer in wrong.values_list(*columns).iterator(chunk_size=AT_ONCE):
        pairs[label, answer].append(key)
    counts: dict[tuple[str, int, str, str], int] = defaultdict(int)
    examples: dict[tuple[str, int, str, str], list[int]] = defaultdict(list)
    for (label, answer), keys in pairs.items():
        for slot in confuse_slots([label], [answer]):
            if slot.is_error:
                confusion = (slot.predicate, slot.place, slot.gold, slot.predicted)
                counts[confusion] += slot.count * len(keys)
                examples[confusion] += keys[: MOST_EXAMPLES - len(examples[confusion])]
    ordered = sorted(counts, key=lambda confusion: (-counts[confusion], confusion))
    return {
        "rows": [[*confusion, counts[confusion]] for confusion in ordered],
        "examples": {":".join(map(str, each)): sorted(examples[each]) for each in ordered},
    }

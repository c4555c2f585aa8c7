"""The groups that a comparison is broken down by, beside saved slices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from parser_service.analysis.encoded_labels import EncodedLabels
from parser_service.analysis.slicing import BIN_STARTS, bin_names
from parser_service.models import Review
from parser_service.results.compared import Compared
from parser_service.results.filter_kinds import NO_CATEGORY
from parser_service.results.stored_columns import UNKNOWN_COUNT

NO_TASK_CATEGORY = "no task category"
SEEN, NEW, NOT_KNOWN = "in the training pairs", "not in the training pairs", "not known"
RIGHT = ""  # no code of a category
AT_ONCE = 20_000
Parameters = dict[str, str]


@dataclass(frozen=True, slots=True)
class Grouping:
    """``labels`` puts each chosen example into a group, and ``parameters`` says which filters choose a group (None
    where none do). ``titles`` names groups whose labels are no names. ``is_of_base``: the groups are about the first
    run's answers or training.
    """

    name: str
    title: str
    labels: Callable[[Compared], EncodedLabels[str]]
    parameters: Callable[[str], Parameters | None]
    is_ordered: bool = False
    is_of_base: bool = False
    titles: Callable[[Compared], dict[str, str]] = lambda compared: {}


def _by_category(compared: Compared) -> EncodedLabels[str]:
    labels = compared.column("task_category")
    return EncodedLabels(tuple(value or NO_TASK_CATEGORY for value in labels.values), labels.codes)


def _by_words(compared: Compared) -> EncodedLabels[str]:
    places = np.digitize(compared.column("word_count"), BIN_STARTS[1:])
    return EncodedLabels(bin_names(), places.astype(np.int64))


def _words_in(name: str) -> Parameters:
    place = bin_names().index(name)
    bounds = {"min_words": str(BIN_STARTS[place]) if place else ""}
    if place + 1 < len(BIN_STARTS):
        bounds["max_words"] = str(BIN_STARTS[place + 1] - 1)
    return {name: value for name, value in bounds.items() if value}


def _by_depth(compared: Compared) -> EncodedLabels[str]:
    depths, codes = np.unique(compared.column("depth"), return_inverse=True)
    return EncodedLabels(tuple(map(str, depths.tolist())), codes.astype(np.int64))


def _by_training(compared: Compared) -> EncodedLabels[str]:
    counts = compared.column("label_in_training")
    codes = np.where(counts == UNKNOWN_COUNT, 2, np.where(counts > 0, 0, 1))
    return EncodedLabels((SEEN, NEW, NOT_KNOWN), codes.astype(np.int64))


def _by_error(compared: Compared) -> EncodedLabels[str]:
    """Group the answers of the first run by their error category; what people say counts more than what the
    machine proposes, and the newest word of people most."""
    categories = list(compared.world.error_categories.values_list("pk", "code"))
    places = {key: place for place, (key, _) in enumerate(categories)}
    keys = compared.examples.keys
    codes = np.full(len(keys), len(places))
    codes[compared.answers[0]["is_exact_match"]] = len(places) + 1
    reviews = Review.objects.filter(run=compared.base, category__in=places).order_by()
    proposed, by_people = reviews.filter(is_proposed=True), reviews.filter(is_proposed=False)
    for rows in (proposed, by_people.order_by("changed_at")):
        pairs = rows.values_list("example_id", "category_id").iterator(chunk_size=AT_ONCE)
        table = np.array(list(pairs), dtype=np.int64).reshape(-1, 2)  # [reviews, 2]
        at = np.searchsorted(keys, table[:, 0])
        is_there = at < len(codes)
        is_there[is_there] = keys[at[is_there]] == table[is_there, 0]
        codes_of_reviews = np.array(
            [places[category] for category in table[:, 1].tolist()], dtype=np.int64
        )
        codes[at[is_there]] = codes_of_reviews[
            is_there
        ]  # where an example is named twice, the last one counts
    return EncodedLabels(
        (*(code for _, code in categories), NO_CATEGORY, RIGHT), codes[compared.chosen]
    )


def _error_names(compared: Compared) -> dict[str, str]:
    names = dict(compared.world.error_categories.values_list("code", "name"))
    return {**names, NO_CATEGORY: "not categorised", RIGHT: "right"}


def _column(name: str) -> Callable[[Compared], EncodedLabels[str]]:
    return lambda compared: compared.column(name)


def _exactly(parameter: str, none: str = "") -> Callable[[str], Parameters | None]:
    return lambda value: None if value == none else {parameter: value}


GROUPINGS = (
    Grouping(
        "category", "Task category", _by_category, _exactly("task_category", NO_TASK_CATEGORY)
    ),
    Grouping("head", "Head predicate of the label", _column("head_predicate"), _exactly("head")),
    Grouping("words", "Words of the utterance", _by_words, _words_in, is_ordered=True),
    Grouping(
        "depth",
        "Depth of the form",
        _by_depth,
        lambda value: {"min_depth": value, "max_depth": value},
        is_ordered=True,
    ),
    Grouping("source", "Source", _column("source"), _exactly("source")),
    Grouping(
        "training",
        "Form in training",
        _by_training,
        {SEEN: {"label": "seen"}, NEW: {"label": "new"}}.get,
        is_ordered=True,
        is_of_base=True,
    ),
    Grouping(
        "error",
        "Error category",
        _by_error,
        lambda code: {"outcome": "correct"} if code == RIGHT else {"category": code},
        is_of_base=True,
        titles=_error_names,
    ),
)

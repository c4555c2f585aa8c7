"""Examples and answers as arrays: made once, stored compressed, read in milliseconds.

A split is frozen and the answers of a run that succeeded do not change, so a copy stays right.
"""

from __future__ import annotations

import array
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from django.db.models import QuerySet
from numpy.typing import NDArray

from annotations.language.corpus import SplitItem
from annotations.models import Split
from annotations.models.background import Status
from annotations.rows.synchronise import batches
from parser_service.analysis.answer_forms import NO_FORM
from parser_service.analysis.arrays import Bools, Ints
from parser_service.analysis.encoded_labels import EncodedLabels, encode
from parser_service.analysis.outcomes import encode_clusters
from parser_service.analysis.slicing import head_predicates
from parser_service.models import AnswerColumns, ExampleColumns, TrainingRun
from parser_service.runs.split_pairs import cluster_of

TEXTS = ".values"  # ends the name of the array with the texts that codes stand for
Column = "NDArray[Any] | EncodedLabels[str]"
UNKNOWN_COUNT = (
    -1
)  # where it is not known how often training had a label, or whether plans are the same
AT_ONCE = 20_000  # rows read from the database


@dataclass(frozen=True, eq=False, slots=True)
class ExampleArrays:
    """The examples of one part: ``keys`` ascending, and by name the columns ``source``, ``task_category``,
    ``head_predicate`` (texts), ``depth``, ``word_count`` and ``cluster``, the place of what is right or wrong
    together (``outcomes.encode_clusters``), [examples] each."""

    keys: Ints
    columns: Mapping[str, Any]

    def mask_of_keys(self, keys: Sequence[int]) -> Bools:
        """Return which examples have one of these keys, [examples]."""
        mask = np.zeros(len(self.keys), dtype=bool)
        wanted = np.asarray(keys, dtype=np.int64)
        places = np.searchsorted(self.keys, wanted)
        inside = places < len(self.keys)
        places, wanted = places[inside], wanted[inside]
        mask[places[self.keys[places] == wanted]] = True
        return mask


def examples_of(split: Split, part: str) -> ExampleArrays:
    """Return the examples of a part. The first call for it reads every row."""
    stored = ExampleColumns.objects.filter(split=split, part=part).first()
    columns = _unpack(stored.data) if stored else {}
    if "cluster" not in columns:  # nor in those that were stored before clusters were drawn
        columns = _read_examples(split, part)
        ExampleColumns.objects.update_or_create(
            split=split, part=part, defaults={"data": _pack(columns)}
        )
    return ExampleArrays(
        columns["keys"], {name: columns[name] for name in columns if name != "keys"}
    )


def answers_of(run: TrainingRun, part: str, examples: ExampleArrays) -> dict[str, Any]:
    """Return the columns of a run's first answers to ``examples``, [examples] each.

    They are ``is_there``, ``is_exact_match``, ``is_equivalent``, ``is_well_formed``, ``is_empty``,
    ``is_same_plan`` (1, 0), ``answer_in_training`` and ``label_in_training`` (these three ``UNKNOWN_COUNT`` where not
    known), and the texts
    ``answer_head`` and ``logical_form``, of which only the empty one is kept apart. They are stored once the
    run has succeeded.
    """
    stored = AnswerColumns.objects.filter(run=run, part=part).first()
    columns = _unpack(stored.data) if stored else {}
    if "is_same_plan" in columns:  # not in those that were stored before plans were compared
        return _with_emptiness(columns)
    arrays = _read_answers(run, part, examples.keys)
    if stored is not None:
        AnswerColumns.objects.filter(pk=stored.pk).update(data=_pack(arrays))
    elif run.status == Status.SUCCEEDED:
        AnswerColumns.objects.get_or_create(run=run, part=part, defaults={"data": _pack(arrays)})
    return _with_emptiness(arrays)


def forget_answers(run: TrainingRun) -> None:
    """Let the columns of a run be made again, after its predictions were changed."""
    AnswerColumns.objects.filter(run=run).delete()


def _with_emptiness(arrays: dict[str, Any]) -> dict[str, Any]:
    codes = np.where(arrays["is_empty"], 0, 1)
    return {**arrays, "logical_form": EncodedLabels(("", "a form"), codes)}


def _read_examples(split: Split, part: str) -> dict[str, Any]:
    numbers, texts = ("pk", "depth", "word_count"), ("source", "task_category", "head_predicate")
    rows = split.examples.filter(part=part).order_by("pk")
    keys, depths, words, *labels = _read_columns(rows, numbers, texts)
    of_clusters = ("source", "utterance", "source_command", "logical_form")
    codes: dict[str, int] = {}
    clusters = array.array("q")
    for row in rows.values_list(*of_clusters).iterator(chunk_size=AT_ONCE):
        cluster = cluster_of(SplitItem(*row), split.criterion)
        clusters.append(codes.setdefault(cluster, len(codes)))
    return {
        "keys": keys,
        **dict(zip(texts, labels, strict=True)),
        "depth": depths,
        "word_count": words,
        "cluster": encode_clusters(list(codes))[np.frombuffer(clusters, dtype=clusters.typecode)],
    }


def _read_answers(run: TrainingRun, part: str, keys: Ints) -> dict[str, Any]:
    flags = ("is_exact_match", "is_equivalent", "is_well_formed")
    counts = ("answer_in_training", "label_in_training", "is_same_plan")
    best = run.predictions.best().filter(example__part=part, example__split=run.split_id)
    read = _read_columns(best.order_by(), ("example_id", *counts), ("logical_form",), flags)
    examples, values, forms, outcomes = read[0], read[1:4], read[4], read[5:]
    places = np.searchsorted(keys, examples)
    arrays: dict[str, Any] = {"is_there": _scatter(places, len(keys), True)}
    for name, outcome in zip(flags, outcomes, strict=True):
        arrays[name] = _scatter(places, len(keys), outcome)
    is_empty = np.array([not form for form in forms.values], dtype=bool)
    arrays["is_empty"] = _scatter(places, len(keys), is_empty[forms.codes])
    for name, seen in zip(counts, values, strict=True):
        arrays[name] = np.full(len(keys), UNKNOWN_COUNT, dtype=np.int64)
        arrays[name][places] = seen
    heads = encode(head_predicates(forms.values), (NO_FORM,))
    codes = np.zeros(len(keys), dtype=np.int64)
    codes[places] = heads.codes[forms.codes]
    arrays["answer_head"] = EncodedLabels(heads.values, codes)
    return arrays


def _read_columns(
    rows: QuerySet[Any],
    numbers: Sequence[str],
    texts: Sequence[str],
    flags: Sequence[str] = (),
) -> list[Any]:
    """Return whole numbers (``UNKNOWN_COUNT`` for None, 1 for what is true) as arrays, then texts as labels, then
    truths as arrays.

    A million rows are never in memory at once as Python objects, only the distinct texts.
    """
    stored = [array.array("q") for _ in (*numbers, *texts)]
    stored += [array.array("b") for _ in flags]
    known: list[dict[str, int]] = [{} for _ in texts]
    read = rows.values_list(*numbers, *texts, *flags).iterator(chunk_size=AT_ONCE)
    for some in batches(read, AT_ONCE):
        for place, values in enumerate(zip(*some, strict=True)):
            text = place - len(numbers)
            if 0 <= text < len(texts):
                codes = known[text]
                stored[place].extend(codes.setdefault(each, len(codes)) for each in values)
            else:
                stored[place].extend(UNKNOWN_COUNT if each is None else each for each in values)
    columns: list[Any] = [np.frombuffer(each, dtype=each.typecode) for each in stored]
    for place, codes in enumerate(known, start=len(numbers)):
        columns[place] = EncodedLabels(tuple(codes), columns[place])
    return [
        each.astype(bool) if place >= len(numbers) + len(texts) else each
        for place, each in enumerate(columns)
    ]


def _scatter(places: Ints, length: int, values: Any) -> Bools:
    column = np.zeros(length, dtype=bool)
    column[places] = values
    return column


def _pack(columns: Mapping[str, Any]) -> bytes:
    """Write arrays as small types and texts as codes; nothing in it is a pickle."""
    arrays: dict[str, Any] = {}  # arrays; mypy would take one for ``allow_pickle``
    for name, column in columns.items():
        if isinstance(column, EncodedLabels):
            arrays[name + TEXTS] = np.array(column.values, dtype=np.str_)
            arrays[name] = _shrink(column.codes)
        elif column.dtype == bool:
            arrays[name] = column
        else:
            arrays[name] = _shrink(column)
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


def _shrink(numbers: Ints) -> NDArray[Any]:
    low, high = numbers.min(initial=0), numbers.max(initial=0)
    return numbers.astype(np.result_type(np.min_scalar_type(low), np.min_scalar_type(high)))


def _unpack(data: bytes | memoryview) -> dict[str, Any]:
    with np.load(io.BytesIO(bytes(data)), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    columns: dict[str, Any] = {}
    for name, stored in arrays.items():
        if name.endswith(TEXTS):
            continue
        wide = stored if stored.dtype == bool else stored.astype(np.int64)
        texts = arrays.get(name + TEXTS)
        columns[name] = wide if texts is None else EncodedLabels(tuple(texts.tolist()), wide)
    return columns

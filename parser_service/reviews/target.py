"""What is analysed: the first answers of a run to one part of its split."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from annotations.language.corpus import Part
from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.models import TrainingRun
from parser_service.parsers import conditions

ROWS_AT_ONCE = 10_000
# The names that results use for the sources of examples; what people say is first.
SOURCES = {name: conditions.SOURCES[name] for name in ("para", "said", "model", "gen")}


@dataclass(frozen=True, eq=False, slots=True)
class FirstAnswers:
    """One entry an example in each: the key of the example, its texts, the first answer and its score.

    An example without an answer has an empty one, whose score means nothing.
    """

    examples: Ints
    utterances: list[str]
    labels: list[str]
    answers: list[str]
    scores: Floats
    is_right: Bools
    sources: Ints  # places in SOURCES

    def of_source(self, source: str) -> Bools:
        """Return which examples are of one of ``SOURCES``: [examples]."""
        is_of_it: Bools = self.sources == list(SOURCES).index(source)
        return is_of_it


class Target:
    """A run, a part of its split and, read when they are first needed, the answers."""

    def __init__(self, run: TrainingRun, part: str) -> None:
        self.run = run
        self.part = part

    @cached_property
    def answers(self) -> FirstAnswers:
        """The first answers, equal forms as one text, so that a million of them fit in memory."""
        rows = (
            self.run.predictions.best()
            .filter(example__part=self.part)
            .order_by("example_id")
            .values_list(
                *("example_id", "example__utterance", "example__logical_form", "logical_form"),
                *("score", "is_exact_match", "example__source"),
            )
        )
        forms: dict[str, str] = {}
        keys, utterances, labels, answers = [], [], [], []
        scores, right, sources = [], [], []
        places = {source: place for place, source in enumerate(SOURCES.values())}
        for key, utterance, label, answer, score, is_right, source in rows.iterator(ROWS_AT_ONCE):
            keys.append(key)
            utterances.append(utterance)
            labels.append(forms.setdefault(label, label))
            answers.append(forms.setdefault(answer, answer))
            scores.append(score)
            right.append(is_right)
            sources.append(places[source])
        return FirstAnswers(
            examples=np.array(keys, dtype=np.int64),
            utterances=utterances,
            labels=labels,
            answers=answers,
            scores=np.array(scores, dtype=np.float64),
            is_right=np.array(right, dtype=np.bool_),
            sources=np.array(sources, dtype=np.int64),
        )

    def forget_answers(self) -> None:
        """Free their memory; they are read again where they are needed."""
        self.__dict__.pop("answers", None)

    @property
    def sources(self) -> list[str]:
        """The sources that the part has examples of."""
        return [name for name in SOURCES if self.answers.of_source(name).any()]


def parts_of(run: TrainingRun) -> list[str]:
    """Return the parts that the run was tested on, validation first.

    What is probed is the first of them: errors are looked at on the validation part, so that the test
    part stays unseen.
    """
    tested = set(run.evaluations.values_list("part", flat=True))
    return [str(part) for part in (Part.VALIDATION, Part.TEST) if part in tested]

"""What is analysed: the first answers of a run to one part of its split."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from annotations.language.corpus import Part
from annotations.models.splits import Source
from parser_service.analysis.arrays import Bools, Floats, Ints
from parser_service.models import TrainingRun

ROWS_AT_ONCE = 10_000
# The names that results use for the sources of examples; paraphrases are what people say, so they are first.
SOURCES = {"para": Source.PARAPHRASED, "gen": Source.GENERATED}


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
    is_generated: Bools

    def of_source(self, source: str) -> Bools:
        """Return which examples are of a source, ``para`` or ``gen``: [examples]."""
        return self.is_generated if source == "gen" else ~self.is_generated


class Target:
    """A run, a part of its split and, read when they are first needed, the answers."""

    def __init__(self, run: TrainingRun, part: str) -> None:
        self.run = run
        self.part = part

    @cached_property
    def answers(self) -> FirstAnswers:
        """The answers, equal forms as one text, so that a million of them fit in memory."""
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
        scores, right, generated = [], [], []
        for key, utterance, label, answer, score, is_right, source in rows.iterator(ROWS_AT_ONCE):
            keys.append(key)
            utterances.append(utterance)
            labels.append(forms.setdefault(label, label))
            answers.append(forms.setdefault(answer, answer))
            scores.append(score)
            right.append(is_right)
            generated.append(source == Source.GENERATED)
        return FirstAnswers(
            examples=np.array(keys, dtype=np.int64),
            utterances=utterances,
            labels=labels,
            answers=answers,
            scores=np.array(scores, dtype=np.float64),
            is_right=np.array(right, dtype=np.bool_),
            is_generated=np.array(generated, dtype=np.bool_),
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

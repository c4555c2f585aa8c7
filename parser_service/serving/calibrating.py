"""What turns the evidence of an answer into a probability and a decision, as it was last measured in a world."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from annotations.models import World
from parser_service.analysis.sureness import (
    AnsweringPart,
    Calibration,
    Decision,
    OperatingPoint,
    operating_point,
)
from parser_service.models import AnswererEvaluation

# An answer as ``AnswererEvaluation.answers`` has it: probability, whether it has the same plan, decision.
MeasuredAnswer = Sequence[Any]
_ACTIONABLE = (Decision.ACT, Decision.CONFIRM)  # nothing else speaks against acting


@dataclass(frozen=True, slots=True)
class Calibrated:
    """A calibration and the operating point that was chosen with it."""

    calibration: Calibration = field(default_factory=Calibration)
    point: OperatingPoint = field(default_factory=OperatingPoint)

    @property
    def has_people(self) -> bool:
        """Whether enough utterances of people calibrated it to act on what a learned parser says."""
        return self.calibration.has_people(AnsweringPart.LEARNED)

    @property
    def has_people_of_last(self) -> bool:
        """The same for the last part, by the utterances that it answered itself."""
        return self.calibration.has_people(AnsweringPart.LAST)


def calibrated(
    world: World, run: int | None, order: str, allowed_wrong: float, last_run: int | None = None
) -> Calibrated:
    """Return the newest calibration of the answers that ``order`` and the learned parser of ``run`` give in ``world``.

    What was measured with another last part than ``last_run`` tells nothing of this one.
    The operating point follows ``allowed_wrong``, a fraction of 1, whatever was allowed when it was measured. Where
    nothing was measured it is the default. One query.
    """
    rows = AnswererEvaluation.objects.filter(world=world, run=run, order=order).calibrating()
    newest = list(rows.newest())
    if not newest:
        return Calibrated(Calibration(), operating_point([], [], allowed_wrong))
    answers = [answer for row in newest for answer in row.answers]
    point = point_of(answers, allowed_wrong)
    stored = newest[0].calibration
    calibration = Calibration.read(stored)
    if last_run is None or stored.get("last_run") != last_run:
        calibration = replace(calibration, last_examples=0)
    return Calibrated(calibration, point)


def point_of(answers: Iterable[MeasuredAnswer], allowed_wrong: float) -> OperatingPoint:
    """Return the operating point by the answers to what people say, of those that may be acted on at all."""
    chosen = [each for each in answers if each[2] in _ACTIONABLE]
    probabilities, is_right = [each[0] for each in chosen], [each[1] for each in chosen]
    return operating_point(probabilities, is_right, allowed_wrong)

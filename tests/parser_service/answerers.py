"""An answerer whose answers a test writes down."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from parser_service.analysis.sureness import AnsweredForm
from parser_service.models import TrainingRun

SILENT = AnsweredForm()


@dataclass
class WrittenAnswerer:
    """Gives ``answers``, by utterance; nothing to what is not among them. ``asked`` is what it heard."""

    answers: Mapping[str, AnsweredForm]
    run: TrainingRun | None = None
    order: str = "both"
    last_run: int | None = None
    asked: list[str] = field(default_factory=list)

    def answer(self, utterances: Sequence[str]) -> list[AnsweredForm]:
        self.asked += utterances
        return [self.answers.get(each, SILENT) for each in utterances]

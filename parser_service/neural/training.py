"""Training: epochs of gradient steps, the best weights so far, and when to stop."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from parser_service.neural.batches import Batch, Example, in_order, shuffled
from parser_service.neural.model import Seq2SeqModel
from parser_service.parsers.interface import Check
from parser_service.parsers.seq2seq_config import Seq2SeqConfig

VALIDATION_BATCH = 64


@dataclass(frozen=True, slots=True)
class Result:
    """What an epoch achieved on the validation pairs."""

    accuracy: float  # exact match, a fraction of 1
    loss: float  # nats a token

    def is_better_than(self, other: Result | None) -> bool:
        """More exact matches, or as many at a smaller loss: so that the epochs before the first
        exact match count as progress, and a tie goes to the surer weights."""
        return other is None or (self.accuracy, -self.loss) > (other.accuracy, -other.loss)


class Training:
    """Adam on the cross entropy, with everything that one epoch hands to the next."""

    def __init__(self, model: Seq2SeqModel, config: Seq2SeqConfig, generator: torch.Generator):
        self.model = model
        self.config = config
        self.generator = generator
        self.optimizer = torch.optim.Adam(model.parameters(), lr=config.learning_rate)
        self.epoch = 0
        self.best_epoch = 0
        self.best: Result | None = None
        self.best_weights: dict[str, Tensor] = {}

    def is_over(self) -> bool:
        """Whether all epochs are done, or the best lies ``patience`` epochs back."""
        waited = self.epoch - self.best_epoch
        return self.epoch >= self.config.epochs or waited >= self.config.patience

    def run_epoch(self, examples: Sequence[Example], check: Check) -> float:
        """One pass in a new random order; the mean loss in nats a token. Raises ValueError where
        the loss is no number any more."""
        self.model.train()
        losses = []
        for batch in shuffled(examples, self.config.batch_size, self.generator):
            check()
            losses.append(self._step(batch))
        self.epoch += 1
        mean = sum(losses) / len(losses)
        if not math.isfinite(mean):
            raise ValueError(
                f"Training diverged in epoch {self.epoch}: the loss is {mean}. "
                f"Try a learning rate below {self.config.learning_rate:g}."
            )
        return mean

    def record(self, result: Result | None) -> bool:
        """Keeps the weights if ``result`` is the best so far, and says so. Without validation pairs
        there is no result, and the newest weights are the best."""
        if result is not None and not result.is_better_than(self.best):
            return False
        self.best, self.best_epoch = result, self.epoch
        weights = self.model.state_dict()
        self.best_weights = {name: value.clone() for name, value in weights.items()}
        return True

    def finish(self) -> None:
        """Gives the model the best weights."""
        self.model.load_state_dict(self.best_weights)
        self.model.eval()

    def _step(self, batch: Batch) -> float:
        self.optimizer.zero_grad()
        loss = self.model.loss(batch)
        loss.backward()  # type: ignore[no-untyped-call]
        torch.nn.utils.clip_grad_norm_(self.model.parameters(), self.config.clip)
        self.optimizer.step()
        return loss.item()


@torch.no_grad()
def validation_loss(model: Seq2SeqModel, examples: Sequence[Example], check: Check) -> float:
    """The mean loss over batches, in nats a token, without dropout."""
    model.eval()
    losses = []
    for batch in in_order(examples, VALIDATION_BATCH):
        check()
        losses.append(model.loss(batch).item())
    return sum(losses) / len(losses)

"""The training: epochs of gradient steps, the best weights so far, and when to stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from parser_service.neural.seq2seq.batches import Batch, Example, in_order, shuffle
from parser_service.neural.seq2seq.model import Seq2SeqModel
from parser_service.neural.training import finite_mean
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig
from parser_service.parsers.interface import Check

VALIDATION_BATCH = 64


@dataclass(frozen=True, slots=True)
class Result:
    """The result of an epoch on the validation pairs."""

    accuracy: float  # exact match, a fraction of 1
    loss: float  # nats a token

    def is_better_than(self, other: Result | None) -> bool:
        """Return whether it has more exact matches, or as many at a smaller loss. So epochs before the first exact
        match count as progress, and a tie goes to the more confident weights."""
        return other is None or (self.accuracy, -self.loss) > (other.accuracy, -other.loss)


class Training:
    """Adam on the cross entropy, with everything that one epoch passes to the next."""

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
        """Return whether all epochs are done, or the best was ``patience`` epochs ago."""
        waited = self.epoch - self.best_epoch
        return self.epoch >= self.config.epochs or waited >= self.config.patience

    def run_epoch(self, examples: Sequence[Example], check: Check) -> float:
        """Train for one pass in a new random order; return the mean loss in nats per token. Raises
        ValueError where it is not finite."""
        self.model.train()
        losses = []
        for batch in shuffle(examples, self.config.batch_size, self.generator):
            check()
            losses.append(self._step(batch))
        self.epoch += 1
        return finite_mean(losses, self.epoch, self.config.learning_rate)

    def record(self, result: Result | None) -> bool:
        """Keep the weights if ``result`` is the best so far; return whether it is. Without validation pairs
        there is no result, and the newest weights count as the best."""
        if result is not None and not result.is_better_than(self.best):
            return False
        self.best, self.best_epoch = result, self.epoch
        weights = self.model.state_dict()
        self.best_weights = {name: value.clone() for name, value in weights.items()}
        return True

    def finish(self) -> None:
        """Give the model the best weights."""
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
    """Return the mean loss over batches, in nats per token, without dropout."""
    model.eval()
    losses = []
    for batch in in_order(examples, VALIDATION_BATCH):
        check()
        losses.append(model.loss(batch).item())
    return sum(losses) / len(losses)

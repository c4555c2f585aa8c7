"""The training: epochs of gradient steps, the best weights so far, when to stop, and its state on disk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import torch
from safetensors.torch import save_file
from torch import Tensor

from parser_service.neural.seq2seq.batches import NumberedPair, in_order, shuffle
from parser_service.neural.seq2seq.lstm import Seq2SeqModel
from parser_service.neural.training import (
    TENSORS,
    TRAINING,
    finite_mean,
    load_optimizer,
    optimizer_tensors,
    tensors_under,
)
from parser_service.neural.weights import WEIGHTS, load_tensors, load_weights
from parser_service.parsers.hyperparameters.seq2seq import Seq2SeqConfig
from parser_service.parsers.interface import Check
from parser_service.parsers.storage import read_json, write_json

VALIDATION_BATCH = 64
FILES = (TRAINING, TENSORS)


@dataclass(frozen=True, slots=True)
class ValidationResult:
    """The result of an epoch on the validation pairs."""

    accuracy: float  # exact match, a fraction of 1
    loss: float  # nats a token

    def is_better_than(self, other: ValidationResult | None) -> bool:
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
        self.best: ValidationResult | None = None
        self.best_weights: dict[str, Tensor] = {}

    def is_over(self) -> bool:
        """Return whether all epochs are done, or the best was ``patience`` epochs ago."""
        waited = self.epoch - self.best_epoch
        return self.epoch >= self.config.epochs or waited >= self.config.patience

    def run_epoch(self, examples: Sequence[NumberedPair], check: Check) -> float:
        """Train for one pass in a new random order; return the mean loss in nats per token. Raises
        Refusal where it is not finite."""
        self.model.train()
        losses = []
        for batch in shuffle(examples, self.config.batch_size, self.generator):
            check()
            self.optimizer.zero_grad()
            loss = self.model.loss(batch)
            loss.backward()  # type: ignore[no-untyped-call]
            torch.nn.utils.clip_grad_norm_(self.model.parameters(), self.config.clip)
            self.optimizer.step()
            losses.append(loss.item())
        self.epoch += 1
        return finite_mean(losses, self.epoch, self.config.learning_rate)

    def record(self, result: ValidationResult | None) -> bool:
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


@torch.no_grad()
def validation_loss(model: Seq2SeqModel, examples: Sequence[NumberedPair], check: Check) -> float:
    """Return the mean loss over batches, in nats per token, without dropout."""
    model.eval()
    losses = []
    for batch in in_order(examples, VALIDATION_BATCH):
        check()
        losses.append(model.loss(batch).item())
    return sum(losses) / len(losses)


def save_training(folder: Path, training: Training) -> None:
    """Write all that ``load_training`` needs beside the model's weights."""
    tensors = {"generator": training.generator.get_state()}
    for name, value in training.best_weights.items():
        tensors[f"best.{name}"] = value
    tensors |= optimizer_tensors(training.optimizer, training.model.named_parameters())
    save_file(tensors, folder / TENSORS)
    best = training.best and {"accuracy": training.best.accuracy, "loss": training.best.loss}
    about = {"epoch": training.epoch, "best_epoch": training.best_epoch, "best": best}
    write_json(folder / TRAINING, about)


def load_training(folder: Path, training: Training) -> int:
    """Put ``training`` into the state that ``save_training`` wrote, its model included; return its
    epoch."""
    tensors = load_tensors(folder / TENSORS)
    load_weights(folder / WEIGHTS, training.model)
    load_optimizer(training.optimizer, training.model.named_parameters(), tensors)
    training.best_weights = tensors_under("best.", tensors)
    training.generator.set_state(tensors["generator"])
    about = read_json(folder / TRAINING)
    training.epoch, training.best_epoch = about["epoch"], about["best_epoch"]
    training.best = ValidationResult(**about["best"]) if about["best"] else None
    return training.epoch

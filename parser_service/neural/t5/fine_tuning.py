"""The fine-tuning: steps of AdamW on the cross entropy of the forms' tokens."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from random import Random

import torch
from safetensors.torch import save_file
from torch import Tensor
from torch.nn.functional import cross_entropy

from parser_service.neural.device import denormals_flushed, has_bf16
from parser_service.neural.t5.config import EncoderDecoderConfig
from parser_service.neural.t5.network import EncoderDecoder, SourceTokens
from parser_service.neural.training import (
    TENSORS,
    TRAINING,
    finite_mean,
    load_optimizer,
    optimizer_tensors,
    random_state_kept,
)
from parser_service.neural.weights import WEIGHTS, load_tensors
from parser_service.parsers.interface import Check
from parser_service.parsers.storage import read_json, write_json

WEIGHT_DECAY = 0.01
POOL = 8  # batches sorted by length together: little padding, yet another mix each epoch
VALIDATION_BATCH = 32
FILES = (TRAINING, TENSORS)


@dataclass(frozen=True, slots=True)
class TokenizedPair:
    """One pair in tokens; the target ends with the token that ends a form."""

    source: SourceTokens
    target: list[int]


class FineTuning:
    """AdamW, with everything that one step passes to the next.

    Random choices (batches, dropout) depend on the seed and the number of the step alone. So weights,
    optimizer and the number of the step are all that a training needs to resume exactly, within an
    epoch too.
    """

    def __init__(
        self,
        network: EncoderDecoder,
        config: EncoderDecoderConfig,
        seed: int,
        examples: Sequence[TokenizedPair],
    ):
        self.network = network
        self.config = config
        self.seed = seed
        self.examples = examples
        self.optimizer = torch.optim.AdamW(
            network.model.parameters(),
            lr=config.learning_rate,
            weight_decay=WEIGHT_DECAY,
            fused=True,
        )
        self.batches = math.ceil(len(examples) / config.batch_size)  # an epoch
        self.step = 0
        self.seconds = 0.0  # of all steps
        self.losses: list[float] = []  # of the steps of this epoch, in nats per token
        self._shuffled: tuple[int, list[list[TokenizedPair]]] = (-1, [])

    @property
    def epoch(self) -> int:
        """Return the number of the epoch, from 1, that the last step was in."""
        return max(1, math.ceil(self.step / self.batches))

    def is_out_of_time(self) -> bool:
        return 0 < self.config.minutes <= self.seconds / 60

    def is_over(self) -> bool:
        return self.step >= self.config.steps or (self.step > 0 and self.is_out_of_time())

    def ends_epoch(self) -> bool:
        """Return whether the last step was the last of an epoch."""
        return self.step % self.batches == 0 or self.is_over()

    def is_due(self, times: int) -> bool:
        """Return whether an epoch that ends here is one of about ``times`` in a training that are looked
        at closely; the last one is."""
        steps = self.config.steps
        before = max(0, self.step - self.batches)
        return self.is_over() or self.step * times // steps > before * times // steps

    def progress(self) -> tuple[float, str]:
        """Return the share of the steps that is done, and how far that is in words."""
        left = (self.config.steps - self.step) * self.seconds / self.step / 60
        if self.config.minutes:
            left = min(left, max(0.0, self.config.minutes - self.seconds / 60))
        words = f"step {self.step} of {self.config.steps}, {left:.0f} minutes left"
        return self.step / self.config.steps, words

    def run_step(self, check: Check) -> None:
        """Train on one batch. Raises Refusal where its loss is not finite."""
        begin = time.monotonic()
        epoch, place = divmod(self.step, self.batches)
        if place == 0:
            self.losses = []
        if self._shuffled[0] != epoch:
            self._shuffled = epoch, list(self._shuffle(epoch))
        batch = self._shuffled[1][place]
        self.network.model.train()
        with random_state_kept(), denormals_flushed():
            torch.manual_seed(self.seed * 1_000_003 + self.step)
            loss = self._train_on(batch, check)
        self.network.model.eval()
        self.step += 1
        self.losses.append(finite_mean([loss], self.epoch, self.config.learning_rate))
        self.seconds += time.monotonic() - begin

    def _train_on(self, batch: Sequence[TokenizedPair], check: Check) -> float:
        self.optimizer.zero_grad()
        tokens = sum(len(example.target) for example in batch)
        at_once = math.ceil(len(batch) / self.config.accumulation)
        total = 0.0
        for begin in range(0, len(batch), at_once):
            check()
            part = batch[begin : begin + at_once]
            smoothing = self.config.label_smoothing
            with reduced_precision(self.network, self.config.precision):
                loss = summed_loss(self.network, part, smoothing) / tokens
            loss.backward()  # type: ignore[no-untyped-call]
            total += loss.item()
        torch.nn.utils.clip_grad_norm_(self.network.model.parameters(), self.config.clip)
        for group in self.optimizer.param_groups:
            group["lr"] = self.config.learning_rate * self.rate()
        self.optimizer.step()
        return total

    def rate(self) -> float:
        """Return the share of the learning rate at this step: linear growth, then linear decay."""
        steps = self.config.steps
        warm = int(self.config.warm_up * steps)
        if self.step < warm:
            return (self.step + 1) / warm
        return (steps - self.step) / (steps - warm)

    def _shuffle(self, epoch: int) -> Iterator[list[TokenizedPair]]:
        """Yield the batches of an epoch in random order, each of pairs of similar length."""
        random = Random(f"{self.seed} {epoch}")
        order = random.sample(self.examples, len(self.examples))
        size = self.config.batch_size
        batches: list[list[TokenizedPair]] = []
        for begin in range(0, len(order), size * POOL):
            pool = sorted(order[begin : begin + size * POOL], key=_length)
            batches += [pool[at : at + size] for at in range(0, len(pool), size)]
        yield from random.sample(batches, len(batches))


def summed_loss(
    network: EncoderDecoder, examples: Sequence[TokenizedPair], smoothing: float = 0.0
) -> Tensor:
    """Return the cross entropy of all tokens of the targets, in nats."""
    inputs = network.sources([example.source for example in examples])
    logits, labels = network.logits([example.target for example in examples], **inputs)
    return cross_entropy(
        logits.flatten(0, 1).float(), labels.flatten(), reduction="sum", label_smoothing=smoothing
    )


@torch.no_grad()
def validation_loss(
    network: EncoderDecoder, examples: Sequence[TokenizedPair], check: Check
) -> float:
    """Return the mean loss in nats per token, without dropout and smoothing."""
    in_order = sorted(examples, key=_length)
    total = 0.0
    for begin in range(0, len(in_order), VALIDATION_BATCH):
        check()
        total += summed_loss(network, in_order[begin : begin + VALIDATION_BATCH]).item()
    return total / sum(len(example.target) for example in examples)


def reduced_precision(network: EncoderDecoder, precision: str) -> AbstractContextManager[object]:
    """Compute in bf16 inside the block, where ``precision`` and the processor allow it."""
    device = network.model.device
    if precision != "auto" or not has_bf16(device):
        return nullcontext()
    return torch.autocast(device.type, torch.bfloat16)


def _length(example: TokenizedPair) -> int:
    return len(example.source.tokens)


def save_training(folder: Path, training: FineTuning) -> None:
    """Write all that ``load_training`` needs beside the network's weights."""
    weights = training.network.model.named_parameters()
    tensors = optimizer_tensors(training.optimizer, weights)
    save_file({name: value.contiguous() for name, value in tensors.items()}, folder / TENSORS)
    about = {"step": training.step, "seconds": training.seconds, "losses": training.losses}
    write_json(folder / TRAINING, about)


def load_training(folder: Path, training: FineTuning) -> int:
    """Put ``training`` into the state that ``save_training`` wrote, its network included; return its
    step. Raises Refusal."""
    training.network.load(load_tensors(folder / WEIGHTS), folder / WEIGHTS)
    weights = list(training.network.model.named_parameters())
    load_optimizer(training.optimizer, weights, load_tensors(folder / TENSORS))
    about = read_json(folder / TRAINING)
    training.step, training.seconds = about["step"], about["seconds"]
    training.losses = about["losses"]
    return training.step

"""The training of the form ranker: steps of AdamW on the sum of two cross entropies."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from random import Random
from typing import Any

import torch
from torch import Tensor
from torch.nn.functional import cross_entropy

from parser_service.neural.device import denormals_flushed, has_bf16
from parser_service.neural.ranker.averaging import Average
from parser_service.neural.ranker.model import RankerModel
from parser_service.neural.ranker.ranked_forms import RankedExample
from parser_service.neural.training import finite_mean
from parser_service.parsers.interface import Check
from parser_service.parsers.ranker_config import RankerConfig

WARM_UP = 0.06  # share of the steps over which the rate grows
LEAST_RATE = 0.02  # share of the rate that is left at the end
WEIGHT_DECAY = 0.01
CLIP = 5.0
REENCODE_EVERY = 16  # steps, for the glosses that carry no gradient
POOL = 8  # batches sorted by length together: little padding, yet another mix each epoch

Fill = Callable[[str, Random], str]


class RankerTraining:
    """AdamW and the average of the weights, with everything that one epoch passes to the next.

    Random choices (batches, dropout, the entities in generated commands) depend on the seed and the
    number of the step alone. So weights, average, optimizer and the number of the epoch are all that
    a training needs to resume exactly.
    """

    def __init__(
        self,
        model: RankerModel,
        config: RankerConfig,
        seed: int,
        examples: Sequence[RankedExample],
        pretrained_share: float = 0.0,
        fill: Fill | None = None,
    ):
        self.model = model
        self.config = config
        self.seed = seed
        self.examples = examples
        self.fill = fill
        kept = {name: pretrained_share for name, _ in model.encoder_weights()}
        self.average = Average(model.trained(), config.averaging, kept)
        self.optimizer = torch.optim.AdamW(self._groups(), weight_decay=WEIGHT_DECAY, fused=True)
        self.epoch = 0
        self.batches = math.ceil(len(examples) / config.batch_size)  # an epoch
        self.epochs = math.ceil(config.steps / self.batches)

    def is_over(self) -> bool:
        return self.epoch >= self.epochs

    def run_epoch(self, check: Check) -> float:
        """Train for one pass; return the mean loss in nats per example. Raises ValueError where it is not
        finite."""
        self.model.train()
        first = self.epoch * self.batches
        losses = []
        precision = reduced_precision(self.model, self.config.precision)
        with random_state_kept(), denormals_flushed(), precision:
            for step, batch in enumerate(self._shuffle(), first):
                check()
                losses.append(self._train_on(batch, step))
        self.model.eval()
        self.epoch += 1
        return finite_mean(losses, self.epoch, self.config.learning_rate)

    def _groups(self) -> list[dict[str, Any]]:
        """Return the groups of weights: the head learns faster than the pretrained encoder."""
        encoder = [weight for _, weight in self.model.encoder_weights()]
        return [
            {"params": encoder, "lr": self.config.learning_rate},
            {"params": [*self.model.prototypes.parameters()], "lr": self.config.head_learning_rate},
        ]

    def _shuffle(self) -> Iterator[list[RankedExample]]:
        """Yield the batches of this epoch in random order, each of utterances of similar length."""
        random = Random(f"{self.seed} {self.epoch}")
        order = random.sample(self.examples, len(self.examples))
        size = self.config.batch_size
        batches: list[list[RankedExample]] = []
        for begin in range(0, len(order), size * POOL):
            pool = order[begin : begin + size * POOL]
            pool.sort(key=lambda example: len(example.utterance))
            batches += [pool[at : at + size] for at in range(0, len(pool), size)]
        yield from random.sample(batches, len(batches))

    def _train_on(self, batch: Sequence[RankedExample], step: int) -> float:
        torch.manual_seed(self.seed * 1_000_003 + step)
        if step % self.batches % REENCODE_EVERY == 0:
            self.model.glosses.encode(self.model.encoder)
        loss = self._loss(batch, Random(f"{self.seed} step {step}"))
        self.optimizer.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        weights = [weight for group in self.optimizer.param_groups for weight in group["params"]]
        torch.nn.utils.clip_grad_norm_(weights, CLIP)
        self._set_rates(step)
        self.optimizer.step()
        self.average.update(step + 1)
        return loss.item()

    def _loss(self, batch: Sequence[RankedExample], random: Random) -> Tensor:
        texts = [self._text(example, random) for example in batch]
        meant = [example.form for example in batch]
        vectors, by_gloss = self.model.glosses.read(self.model.encoder, texts, meant)
        targets = torch.tensor(meant, device=vectors.device)
        smoothing = self.config.label_smoothing
        by_example = self.model.prototypes(vectors)  # [batch, forms with examples]
        return cross_entropy(by_example, targets, label_smoothing=smoothing) + cross_entropy(
            self.model.add_slots(by_gloss, texts), targets, label_smoothing=smoothing
        )

    def _text(self, example: RankedExample, random: Random) -> str:
        """Return the utterance, in a share of cases with other entities of the same classes: its form does
        not depend on which ones it names."""
        if self.fill and random.random() < self.config.grounding:
            return self.fill(example.pattern, random)
        return example.utterance

    def _set_rates(self, step: int) -> None:
        """Set the learning rates of ``step``: linear growth, then linear decay."""
        steps = self.epochs * self.batches
        warm = max(1, int(WARM_UP * steps))
        decay = 1 - (1 - LEAST_RATE) * (step - warm) / (steps - warm or 1)
        share = (step + 1) / warm if step < warm else decay
        rates = self.config.learning_rate, self.config.head_learning_rate
        for group, rate in zip(self.optimizer.param_groups, rates, strict=True):
            group["lr"] = rate * share


@contextmanager
def random_state_kept() -> Iterator[None]:
    """Leave torch's random state as it was, on every device."""
    devices = list(range(torch.cuda.device_count()))
    with torch.random.fork_rng(devices=devices):
        yield


@contextmanager
def reduced_precision(model: RankerModel, precision: str) -> Iterator[None]:
    """Let the encoder compute in bf16 inside the block, where ``precision`` and the processor allow it."""
    model.encoder.in_bf16 = precision == "auto" and has_bf16(model.encoder.device)
    try:
        yield
    finally:
        model.encoder.in_bf16 = False

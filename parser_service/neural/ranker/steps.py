"""The training of the form ranker: steps of AdamW on the sum of two cross entropies, and its state on disk."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import torch
from safetensors.torch import save_file
from torch import nn
from torch.nn.functional import cross_entropy

from parser_service.neural.device import denormals_flushed, has_bf16
from parser_service.neural.ranker.averaging import Average
from parser_service.neural.ranker.model import PrototypeHead, RankerModel
from parser_service.neural.ranker.ranked_forms import RankedExample
from parser_service.neural.training import (
    TENSORS,
    TRAINING,
    Clock,
    finite_mean,
    load_optimizer,
    optimizer_tensors,
    random_state_kept,
)
from parser_service.neural.weights import load_tensors
from parser_service.parsers.hyperparameters.ranker import RankerConfig
from parser_service.parsers.interface import Check
from parser_service.parsers.spreading import spread
from parser_service.parsers.storage import read_json, write_json

WARM_UP = 0.06  # share of the steps over which the rate grows
LEAST_RATE = 0.02  # share of the rate that is left at the end
WEIGHT_DECAY = 0.01
CLIP = 5.0
REENCODE_EVERY = 16  # steps, for the glosses that carry no gradient
MOST_AVERAGED = 4096  # examples that prototypes start from, or one of each form
POOL = 8  # batches sorted by length together: little padding, yet another mix each epoch
FILES = (TRAINING, TENSORS)
GLOSSES = "glosses"  # the name of their vectors in a checkpoint

Fill = Callable[[str, Random], str]


class StepSpan(NamedTuple):
    """The steps of a training, ``first`` to before ``end``, out of ``total`` in the whole schedule;
    ``a_pass`` of them are a pass over the pairs, or as much of one as there is time for."""

    first: int
    end: int
    total: int
    a_pass: int

    @property
    def passes(self) -> int:
        return math.ceil((self.end - self.first) / self.a_pass)


def plan(shares: Sequence[float], pairs: Sequence[int], config: RankerConfig) -> list[StepSpan]:
    """Return the steps of trainings that follow each other, on ``pairs`` many pairs each.

    ``shares`` of the steps are rounded up to whole passes; where one pass is longer, it is cut.
    """
    ends, lengths, end = [0], [], 0
    for share, number in zip(shares, pairs, strict=True):
        steps = max(1, round(share * config.steps))
        batches = math.ceil(number / config.batch_size)
        lengths.append(min(batches, steps))
        end += math.ceil(steps / lengths[-1]) * lengths[-1]
        ends.append(end)
    return [
        StepSpan(first, last, end, length)
        for first, last, length in zip(ends, ends[1:], lengths, strict=False)
    ]


def cut(spans: Sequence[StepSpan], step: int, steps: float) -> list[StepSpan]:
    """Return ``spans`` with about ``steps`` steps after ``step``: what is left of each shrinks by the same
    share, to one step at least. Those that are over stay."""
    share = steps / (spans[-1].end - step)
    firsts: list[int] = []
    ends: list[int] = []
    for span in spans:
        first = ends[-1] if ends else span.first
        done = max(0, min(step, span.end) - span.first)
        left = span.end - span.first - done
        firsts.append(first)
        ends.append(first + done + min(left, max(1, int(share * left))))
    return [
        StepSpan(first, end, ends[-1], span.a_pass)
        for first, end, span in zip(firsts, ends, spans, strict=True)
    ]


@dataclass
class RankerTraining:
    """AdamW and the average of the encoder's weights.

    In training, one prototype represents the examples of a form, because their vectors change with
    every step; afterwards the nearest example does.

    Random choices (batches, dropout, the entities in generated commands) depend on the seed and the
    number of the step alone. So the weights, the average, the optimizer, the vectors of the glosses and the
    losses of this pass are all that a training needs to resume exactly after any step.
    """

    model: RankerModel
    config: RankerConfig
    seed: int
    examples: Sequence[RankedExample]
    average: Average
    span: StepSpan
    fill: Fill | None = None
    clock: Clock = field(default_factory=Clock)
    losses: list[float] = field(default_factory=list)  # of this pass

    def __post_init__(self) -> None:
        self.step = self.span.first
        encoder = self.model.encoder
        self.prototypes = PrototypeHead(self.model.nearest.number, encoder.width)
        self.prototypes.to(encoder.device)
        # The head learns faster than the pretrained encoder.
        trained = [weight for _, weight in self.model.trained()]
        groups: list[dict[str, Any]] = [
            {"params": trained, "lr": self.config.learning_rate},
            {"params": [*self.prototypes.parameters()], "lr": self.config.head_learning_rate},
        ]
        self.optimizer = torch.optim.AdamW(groups, weight_decay=WEIGHT_DECAY, fused=True)

    def start(self, check: Check) -> int:
        """Give each prototype the mean of encoded examples, and encode the glosses; return how many texts that were.

        Of very many examples, some of each form are enough for a vector that training changes.
        """
        most = max(MOST_AVERAGED, self.model.nearest.number)
        some = spread(self.examples, most, lambda example: example.form)
        with reduced_precision(self.model, self.config.precision):
            vectors = self.model.encoder.vectors([example.utterance for example in some], check)
            self.prototypes.start_from(vectors, [example.form for example in some])
            self.model.glosses.encode(self.model.encoder, check)
        return len(some) + len(self.model.glosses.glosses)

    def continue_from(self, earlier: RankerTraining) -> None:
        """Let AdamW keep what it knows of the encoder that both train: without its moments, the first steps
        with all forms are as rough as those of a new training."""
        for _, weight in self.model.trained():
            self.optimizer.state[weight] = earlier.optimizer.state[weight]

    @property
    def passes(self) -> int:
        """The number of passes that are over."""
        done, a_pass = self.step - self.span.first, self.span.a_pass
        return math.ceil(done / a_pass) if self.is_over() else done // a_pass

    def is_over(self) -> bool:
        return self.step >= self.span.end

    def trained(self) -> Iterator[tuple[str, nn.Parameter]]:
        """Yield the weights that this changes, by name."""
        yield from self.model.trained()
        yield from self.prototypes.named_parameters("prototypes")

    def run_pass(self, check: Check, after_step: Callable[[], None] = lambda: None) -> float:
        """Train until the pass is over; return its mean loss in nats per example. ``after_step`` is called
        after each step but the last, and may end the span earlier. Raises Refusal where the loss is not finite."""
        self.model.train()
        number = self.passes
        precision = reduced_precision(self.model, self.config.precision)
        with random_state_kept(), denormals_flushed(), precision:
            for batch in self._shuffle()[len(self.losses) : self.span.a_pass]:
                check()
                with self.clock.step():
                    self.losses.append(self._train_on(batch, check))
                self.step += 1
                if len(self.losses) < self.span.a_pass and not self.is_over():
                    after_step()
                if self.is_over():
                    break
        self.model.eval()
        losses, self.losses = self.losses, []
        return finite_mean(losses, number + 1, self.config.learning_rate)

    def _shuffle(self) -> list[list[RankedExample]]:
        """Return the batches of this pass in random order, each of utterances of similar length."""
        random = Random(f"{self.seed} {self.span.first} {self.passes}")
        order = random.sample(self.examples, len(self.examples))
        size = self.config.batch_size
        batches: list[list[RankedExample]] = []
        for begin in range(0, len(order), size * POOL):
            pool = order[begin : begin + size * POOL]
            pool.sort(key=lambda example: len(example.utterance))
            batches += [pool[at : at + size] for at in range(0, len(pool), size)]
        return random.sample(batches, len(batches))

    def _train_on(self, batch: Sequence[RankedExample], check: Check) -> float:
        torch.manual_seed(self.seed * 1_000_003 + self.step)
        if self.step % REENCODE_EVERY == 0:
            turn = self.step // REENCODE_EVERY
            self.model.glosses.refresh(self.model.encoder, turn, check)
        random = Random(f"{self.seed} step {self.step}")
        texts = [self._text(example, random) for example in batch]
        meant = [example.form for example in batch]
        vectors, by_gloss = self.model.glosses.read(self.model.encoder, texts, meant)
        targets = torch.tensor(meant, device=vectors.device)
        smoothing = self.config.label_smoothing
        by_example = self.prototypes(vectors)  # [batch, forms with examples]
        loss = cross_entropy(by_example, targets, label_smoothing=smoothing) + cross_entropy(
            self.model.add_slots(by_gloss, texts), targets, label_smoothing=smoothing
        )
        self.optimizer.zero_grad()
        loss.backward()  # type: ignore[no-untyped-call]
        weights = [weight for group in self.optimizer.param_groups for weight in group["params"]]
        torch.nn.utils.clip_grad_norm_(weights, CLIP)
        self._set_rates()
        self.optimizer.step()
        self.average.update(self.step + 1)
        return loss.item()

    def _text(self, example: RankedExample, random: Random) -> str:
        """Return the utterance, in a share of cases with other entities of the same classes: its form does
        not depend on which ones it names."""
        if self.fill and random.random() < self.config.grounding:
            return self.fill(example.pattern, random)
        return example.utterance

    def _set_rates(self) -> None:
        """Set the learning rates of this step: linear growth, then linear decay."""
        steps = self.span.total
        warm = max(1, int(WARM_UP * steps))
        decay = 1 - (1 - LEAST_RATE) * (self.step - warm) / (steps - warm or 1)
        share = (self.step + 1) / warm if self.step < warm else decay
        rates = self.config.learning_rate, self.config.head_learning_rate
        for group, rate in zip(self.optimizer.param_groups, rates, strict=True):
            group["lr"] = rate * share


@contextmanager
def reduced_precision(model: RankerModel, precision: str) -> Iterator[None]:
    """Let the encoder compute in bf16 inside the block, where ``precision`` and the processor allow it."""
    model.encoder.in_bf16 = precision == "auto" and has_bf16(model.encoder.device)
    try:
        yield
    finally:
        model.encoder.in_bf16 = False


def save_training(folder: Path, training: RankerTraining, about: dict[str, Any]) -> None:
    """Write what ``load_training`` reads: the weights that training changes, their average, the state of
    the optimizer and the vectors of the glosses. ``about`` is stored beside them.

    Pretrained weights that training leaves alone are not among them.
    """
    tensors = optimizer_tensors(training.optimizer, training.trained())
    tensors |= {f"live.{name}": weight.detach() for name, weight in training.trained()}
    tensors |= {f"average.{name}": value for name, value in training.average.values.items()}
    tensors[GLOSSES] = training.model.glosses.vectors
    save_file({name: value.contiguous() for name, value in tensors.items()}, folder / TENSORS)
    state = {**about, "step": training.step, "losses": training.losses}
    write_json(folder / TRAINING, state)


@torch.no_grad()
def load_training(folder: Path, training: RankerTraining) -> None:
    """Put ``training`` into the state that ``save_training`` wrote. Raises Refusal."""
    tensors = load_tensors(folder / TENSORS)
    for name, weight in training.trained():
        weight.copy_(tensors[f"live.{name}"])
    for name, value in training.average.values.items():
        value.copy_(tensors[f"average.{name}"])
    training.model.glosses.vectors.copy_(tensors[GLOSSES])
    load_optimizer(training.optimizer, training.trained(), tensors)
    state = read_json(folder / TRAINING)
    training.step, training.losses = state["step"], state["losses"]

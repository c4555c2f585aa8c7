"""What the trainings of all networks share.

Their state on disk, resuming from it, the time that is left, random choices that stay inside, and the
refusal of a loss that has diverged.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import torch
from torch import Tensor, nn

from annotations.language.texts import Refusal
from parser_service.parsers.interface import Observer

TRAINING = "training.json"
TENSORS = "training.safetensors"
LATEST = 32  # steps, which tell how long the next ones take
LEAST_TIMED = 4  # steps

NamedWeights = Iterable[tuple[str, nn.Parameter]]


def optimizer_tensors(optimizer: torch.optim.Optimizer, weights: NamedWeights) -> dict[str, Tensor]:
    """Return what ``optimizer`` remembers of each of ``weights``, by names that begin with "adam."."""
    return {
        f"adam.{name}.{key}": value
        for name, weight in weights
        for key, value in optimizer.state[weight].items()
    }


def load_optimizer(
    optimizer: torch.optim.Optimizer, weights: NamedWeights, tensors: Mapping[str, Tensor]
) -> None:
    """Put ``optimizer`` into the state that ``optimizer_tensors`` returned."""
    names = {weight: name for name, weight in weights}
    groups = optimizer.state_dict()["param_groups"]  # they number the weights in this order
    in_order = [weight for group in optimizer.param_groups for weight in group["params"]]
    state = {
        number: tensors_under(f"adam.{names[weight]}.", tensors)
        for number, weight in enumerate(in_order)
    }
    optimizer.load_state_dict({"state": state, "param_groups": groups})


def tensors_under(prefix: str, tensors: Mapping[str, Tensor]) -> dict[str, Tensor]:
    """Return the tensors whose names begin with ``prefix``, by the rest of their names."""
    return {name.removeprefix(prefix): t for name, t in tensors.items() if name.startswith(prefix)}


def resume(
    observe: Observer,
    check: Callable[[Path], object],
    load: Callable[[Path], int],
    unit: str = "epoch",
) -> None:
    """Resume from the last checkpoint, or start from the beginning, to the same end, where there is
    none or it cannot be read.

    Args:
        observe: knows the checkpoint and takes a line for the log.
        check: raises Refusal where a folder is no checkpoint of this training.
        load: puts the training into the state in a folder; returns the number of the ``unit`` it was saved
            after.
    """
    folder = observe.last_checkpoint()
    if folder is None:
        return
    try:
        check(folder)
    except ValueError as error:
        why = error.message if isinstance(error, Refusal) else "Its files hold something else."
        observe.log(f"The last checkpoint is unreadable; training starts from the beginning. {why}")
        return
    observe.log(f"Resuming after {unit} {load(folder)}.")


class Clock:
    """Counts the seconds of a training from here. ``minutes`` is how many it may take; 0: as many as it takes.

    It goes by the processor's time on each of ``threads``: a machine that does something else as well lets a
    training wait, which is no reason to learn less. Whoever resumes a run that was stopped puts the seconds
    that it had spent into ``before``.
    """

    def __init__(self, minutes: float = 0.0, threads: int = 1):
        self.most = 60 * minutes or math.inf
        self.before = 0.0
        self._threads = threads
        self._steps: deque[float] = deque(maxlen=LATEST)
        self._began = self.now()

    def now(self) -> float:
        """Return seconds since some moment."""
        return time.process_time() / self._threads

    @property
    def spent(self) -> float:
        return self.before + self.now() - self._began

    @contextmanager
    def step(self) -> Iterator[None]:
        """Take the time of a step."""
        began = self.now()
        yield
        self._steps.append(self.now() - began)

    @property
    def a_step(self) -> float:
        """Return the seconds of a step, 0 where too few were timed."""
        timed = len(self._steps)
        return sum(self._steps) / timed if timed >= LEAST_TIMED else 0.0

    def steps_left(self, reserved: float) -> float:
        """Return for how many steps there is time, beside ``reserved`` seconds of other work; at least 1."""
        left = self.most - self.spent - reserved
        return max(1.0, left / self.a_step) if self.a_step else math.inf


def finite_mean(losses: Sequence[float], epoch: int, learning_rate: float) -> float:
    """Return the mean loss of ``epoch``. Raises Refusal where it is not finite."""
    mean = sum(losses) / len(losses)
    if not math.isfinite(mean):
        raise Refusal(
            f"Training diverged in epoch {epoch}: the loss is {mean}. "
            f"Try a learning rate below {learning_rate:g}.",
            "training_diverged",
        )
    return mean


@contextmanager
def random_state_kept() -> Iterator[None]:
    """Leave torch's random state as it was, on every device."""
    devices = list(range(torch.cuda.device_count()))
    with torch.random.fork_rng(devices=devices):
        yield

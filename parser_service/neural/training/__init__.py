"""What the trainings of all networks share: the state that a checkpoint keeps, resuming from it, random
choices that stay inside, how much time there is, and the refusal of a loss that has diverged."""

from parser_service.neural.training.checkpoints import (
    TENSORS,
    TRAINING,
    load_optimizer,
    optimizer_tensors,
    resume,
    tensors_under,
)
from parser_service.neural.training.clock import Clock
from parser_service.neural.training.losses import finite_mean
from parser_service.neural.training.randomness import random_state_kept

__all__ = [
    "TENSORS",
    "TRAINING",
    "Clock",
    "finite_mean",
    "load_optimizer",
    "optimizer_tensors",
    "random_state_kept",
    "resume",
    "tensors_under",
]

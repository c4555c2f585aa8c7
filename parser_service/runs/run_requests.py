"""Verb: request training runs. Identical runs are reused; what cannot be trained is refused."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from django.db import transaction

from annotations.background import wake
from annotations.language.corpus import Part
from annotations.language.texts import Refusal
from annotations.models import Split, User, World
from annotations.models.background import Status
from parser_service.models import TrainingRun
from parser_service.parsers import registry
from parser_service.parsers.conditions import (
    MODEL,
    PARAPHRASED,
    SAID,
    TRAIN_SOURCES,
    sources_of,
    written_sources,
)
from parser_service.parsers.hyperparameters.fields import refuse_unnamed
from parser_service.parsers.pretrained_files import refuse_missing_weights
from parser_service.runs.content_key import content_key

LARGEST_SEED = 2**32 - 1
LEAST_SHARE = 0.01  # of the training pairs
MOST_SEEDS = 10  # of one request


def request(
    world: World,
    split: Split,
    parser: str,
    config: Mapping[str, Any] | None = None,
    protocol: str = "strict",
    train_sources: str = "gen",
    seed: int = 0,
    by: User | None = None,
    send: bool = True,
    anywhere: bool = False,
    train_share: float = 1.0,
) -> tuple[TrainingRun, bool]:
    """Return a new queued run and True, or the run that has or will have the same result and False.

    ``train_share`` is the share of the training pairs to learn from, at least ``LEAST_SHARE``.
    With ``send`` a worker is woken once the transaction is over. Pretrained weights may be named by
    any path where ``anywhere`` is set, for who has the command line; else as in ``missing_weights``.
    Raises Refusal where the request cannot be trained.
    """
    made = registry.make_config(parser, config)
    refuse_missing_weights(made, anywhere)
    refuse_unnamed(made)
    _refuse_what_cannot_be_trained(world, split, parser, protocol, train_sources, seed)
    if not LEAST_SHARE <= train_share <= 1:
        raise Refusal(
            f"The share {train_share:g} of the training pairs has to lie between {LEAST_SHARE:g} and 1.",
            "share_out_of_range",
        )
    asked = {
        "split": split,
        "parser": parser,
        "config": registry.config_values(made),
        "protocol": protocol,
        "train_sources": train_sources,
        "seed": seed,
        "train_share": train_share,
    }
    run, created = _find_or_queue(world, asked, by)
    if created and send:
        wake(run)
    return run, created


def retrain(run: TrainingRun, split: Split, by: User | None = None) -> tuple[TrainingRun, bool]:
    """Request the same configuration on another split. Returns and raises as ``request`` does.

    ``run`` and what it was trained on stay as they are. The new run learns from ``sources_on`` the split.
    """
    return request(
        run.world,
        split,
        run.parser,
        run.config,
        run.protocol,
        sources_on(split, run),
        run.seed,
        by,
        anywhere=True,  # its weights were admitted when it was started
        train_share=run.train_share,
    )


def sources_on(split: Split, run: TrainingRun) -> str:
    """Return what a run like ``run`` learns from on ``split``.

    Where it learned from paraphrases, these are also the sources that its own split had no training pairs of: what
    people have labelled and models have written since.
    """
    learned = sources_of(run.train_sources)
    if PARAPHRASED not in learned:
        return run.train_sources
    before, now = (
        set(each.examples.of(Part.TRAIN).order_by().values_list("source", flat=True).distinct())
        for each in (run.split, split)
    )
    return written_sources({*learned, *((now - before) & {MODEL, SAID})})


def request_seeds(
    world: World, split: Split, parser: str, *, seeds: Sequence[int], **asked: Any
) -> list[tuple[TrainingRun, bool]]:
    """Request one run per seed, all or none. Return what ``request`` returns, in the order of ``seeds``.

    Raises Refusal as ``request`` does.
    """
    with transaction.atomic():
        return [request(world, split, parser, seed=seed, **asked) for seed in seeds]


def seeds_from(first: int, how_many: int) -> range:
    """Return ``how_many`` seeds, counting up from ``first``. Raises Refusal where one is out of range."""
    if not 1 <= how_many <= MOST_SEEDS:
        raise Refusal(
            f"{how_many} seeds were asked for; it has to be 1 to {MOST_SEEDS}.",
            "seeds_out_of_range",
        )
    last = first + how_many - 1
    if last > LARGEST_SEED:
        raise Refusal(
            f"The last seed would be {last}; the largest one is {LARGEST_SEED}.",
            "seeds_out_of_range",
        )
    return range(first, last + 1)


def _find_or_queue(
    world: World, asked: Mapping[str, Any], by: User | None
) -> tuple[TrainingRun, bool]:
    """Return the run of what is asked that has not failed, or a new one, and whether it is new."""
    entry = registry.entry(asked["parser"])
    made = {"parser_version": entry.version, "queue": entry.queue, "created_by": by}
    return TrainingRun.objects.get_or_create(
        world=world,
        content_key=content_key(**asked),
        status__in=[Status.QUEUED, Status.RUNNING, Status.SUCCEEDED],
        defaults={**asked, **made},
    )


def _refuse_what_cannot_be_trained(
    world: World, split: Split, parser: str, protocol: str, train_sources: str, seed: int
) -> None:
    entry = registry.entry(parser)
    if split.world_id != world.pk:
        raise Refusal(
            f"The split {split} belongs to another world than {world}.", "split_of_another_world"
        )
    if protocol not in entry.protocols:
        allowed = ", ".join(entry.protocols)
        raise Refusal(
            f"{parser} has no protocol {protocol!r}; it has: {allowed}.", "unknown_protocol"
        )
    if train_sources not in TRAIN_SOURCES:
        allowed = ", ".join(TRAIN_SOURCES)
        raise Refusal(
            f"No train sources are called {train_sources!r}; there are: {allowed}.",
            "unknown_train_sources",
        )
    if not 0 <= seed <= LARGEST_SEED:
        raise Refusal(
            f"The seed {seed} has to lie between 0 and {LARGEST_SEED}.", "seeds_out_of_range"
        )
    for source in sources_of(train_sources):
        if not split.examples.filter(part="train", source=source).exists():
            raise Refusal(
                f"The split {split} has no {source} examples to train on.", "no_training_examples"
            )

"""Verb: freeze a split, a copy of texts in which two parts share nothing of a kind."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from django.core.exceptions import ValidationError
from django.db import transaction

from annotations.language.errors import LanguageError
from annotations.language.splitting import (
    DEFAULT_PROPORTIONS,
    Criterion,
    FrozenExample,
    SplitItem,
    content_hash,
    split,
)
from annotations.models import Example, Split, User, World
from annotations.models.splits import Source
from annotations.rows import BATCH


def freeze_split(
    world: World,
    name: str,
    criterion: str = Criterion.COMMAND,
    seed: int = 0,
    proportions: Sequence[float] = DEFAULT_PROPORTIONS,
    by: User | None = None,
) -> Split:
    """Freezes the commands and accepted paraphrases of ``world`` as the split ``name``.

    Args:
        criterion: what two parts never share: a ``command``, ``source_command`` or
            ``logical_form``, over generated and paraphrased examples together.
        seed: the same world, criterion, proportions and seed give the same split.
        proportions: shares of train, validation and test that sum to 1.

    Returns:
        The split; the one that is there already where it holds just the same.

    Raises:
        LanguageError: there is nothing to split, the proportions are none, or the name is taken by
            a split with other examples.
    """
    examples = plan_split(world, criterion, seed, proportions)
    with transaction.atomic():
        World.objects.select_for_update().get(pk=world.pk)
        return store_split(world, name, criterion, examples, seed, by)[0]


def plan_split(
    world: World,
    criterion: str = Criterion.COMMAND,
    seed: int = 0,
    proportions: Sequence[float] = DEFAULT_PROPORTIONS,
) -> list[Example]:
    """The examples that ``freeze_split`` would store, each with its part and position. Raises likewise."""
    examples = list(_candidates(world))
    items = [
        SplitItem(each.source, each.utterance, each.source_command, each.logical_form)
        for each in examples
    ]
    parts = split(items, Criterion(criterion), proportions, seed)
    for example, part in zip(examples, parts, strict=True):
        example.part = str(part)
    _number(examples)
    return examples


def store_split(
    world: World,
    name: str,
    criterion: str,
    examples: Sequence[Example],
    seed: int | None = None,
    by: User | None = None,
) -> tuple[Split, bool]:
    """Stores examples (without a split so far) as a split; inside a transaction.

    Returns:
        The split and whether it is new; one of that name with the same texts is left alone.

    Raises:
        LanguageError: there is one of that name with other texts.
    """
    _require_split_name(name)
    ordered = sorted(examples, key=lambda each: (each.source, each.part, each.position))
    existing = world.splits.filter(name=name).first()
    if existing is not None:
        if existing.criterion == criterion and _texts(existing.examples.all()) == _texts(ordered):
            return existing, False
        raise LanguageError(
            f"there is a split {name} already, and it holds something else",
            hint="a frozen split never changes: choose another name",
        )
    created = Split.objects.create(
        world=world,
        name=name,
        criterion=criterion,
        seed=seed,
        content_hash=content_hash(map(_frozen, ordered)),
        created_by=by,
    )
    for example in ordered:
        example.split = created
    Example.objects.bulk_create(ordered, batch_size=BATCH)
    return created, True


def _require_split_name(name: str) -> None:
    try:
        Split(name=name).clean_fields(exclude={"world", "criterion", "content_hash"})
    except ValidationError as trouble:
        sentences = " ".join(trouble.messages)
        raise LanguageError(f"“{name}” cannot be the name of a split: {sentences}") from trouble


def _candidates(world: World) -> Iterator[Example]:
    """Every command and accepted paraphrase; a pair that occurs twice is taken once."""
    for command in world.commands.select_related("logical_form"):
        yield Example(
            source=Source.GENERATED,
            utterance=command.anonymized_text,
            source_command=command.anonymized_text,
            task_category=command.task_category,
            logical_form=command.logical_form.text,
        )
    seen: set[tuple[str, str]] = set()
    for said in world.paraphrases.accepted().select_related("command"):
        if (said.utterance, said.logical_form) in seen:
            continue
        seen.add((said.utterance, said.logical_form))
        yield Example(
            source=Source.PARAPHRASED,
            utterance=said.utterance,
            source_command=said.command.anonymized_text if said.command else said.prompt,
            task_category=said.command.task_category if said.command else "",
            logical_form=said.logical_form,
            grounded_form=said.grounded_form,
        )


def _number(examples: Sequence[Example]) -> None:
    """Positions in the order of pair files: by the number of characters of the utterance."""
    following: dict[tuple[str, str], int] = {}
    for example in sorted(examples, key=lambda each: len(each.utterance)):
        place = (example.source, example.part)
        example.position = following.get(place, 0)
        following[place] = example.position + 1


def _texts(examples: Sequence[Example]) -> list[tuple[object, ...]]:
    """What a pair file holds of each example, and where."""
    return [
        (
            each.source,
            each.part,
            each.position,
            each.utterance,
            each.logical_form,
            each.written_form,
        )
        for each in examples
    ]


def _frozen(example: Example) -> FrozenExample:
    return FrozenExample(
        example.part,
        example.source,
        example.utterance,
        example.source_command,
        example.task_category,
        example.logical_form,
        example.grounded_form,
    )
